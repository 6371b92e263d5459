#pragma once

#include <optional>
#include <string>
#include <vector>

#include "inverse/gamut/gamut_kind.h"
#include "inverse/gamut/slope_print.h"
#include "inverse/target/target.h"

namespace mezzotint {

/// What a printer's profile says before anything is printed. α = √2 · RMS slope along an axis of the printed relief.
struct GamutFormula {
  double floor_alpha = 0.0;     ///< √2 · RMS slope of the ground's geometric octaves: no print is smoother
  double coherent_share = 1.0;  ///< light that the other octaves leave unscattered
  double largest_alpha = 0.0;   ///< √2·π/2 · height/λ · transfer² of a sinusoid on both axes, without ground
  Length at_wavelength;         ///< where that is largest
  double largest_alpha_one_axis = 0.0;  ///< √2·π/√2 · height/λ · transfer of a wave along one axis
  Length at_wavelength_one_axis;

  /// Largest α_x/α_y of a print with this α_x: the ground alone gives α_y.
  [[nodiscard]] double largest_ratio(double alpha_x) const { return floor_alpha > 0.0 ? alpha_x / floor_alpha : 1e9; }
};
[[nodiscard]] GamutFormula gamut_formula(const PrinterProfile& printer, Length wavelength,
                                         const GamutBounds& bounds = {});
/// "α ≥ 0.013 (the ground's slopes); α_x/α_y ≤ α_x/0.013; …", one line.
[[nodiscard]] std::string in_words(const GamutFormula& formula);

enum class GamutPlace { Inside, Edge, Outside };
[[nodiscard]] std::string to_string(GamutPlace place);

/// α_x ≥ α_y of a print, ground included.
struct AlphaPair {
  double x = 0.0;
  double y = 0.0;
};
[[nodiscard]] AlphaPair alphas_of(const SlopeAxes& slopes);

/// Whether a kind of pattern reaches a target on a printer, why not, and what is nearest.
struct GamutVerdict {
  std::string kind;
  GamutPlace place = GamutPlace::Inside;
  std::string why;  ///< one sentence, of use to who wants the target
  AlphaPair wanted;
  AlphaPair nearest;                     ///< what the pattern below prints: the wanted one where it is reached
  double nearest_error = 0.0;            ///< standard error of its α's, relative; 0 where nothing was printed
  double distance = 0.0;                 ///< √covariance_distance from wanted to nearest
  Pattern pattern;                       ///< turned to the target's direction
  AxisSquares correction{1.0, 1.0};      ///< of the closed form's squares, where something was printed
  bool by_formula = false;               ///< the ground alone decides: no pattern reaches it
  int prints = 0;                        ///< 0: far enough from every edge for the closed form
  std::vector<std::string> other_kinds;  ///< those that reach it, where this one does not
};

struct GamutOptions {
  GamutBounds bounds;
  Length wavelength = Length::from_nm(550.0);  ///< decides which octaves of the ground are geometry
  /// Half the width of the edge, relative in α: what is nearer to the border than that is neither in nor out. It holds
  /// the errors of the print (1–2 %), of the search, and of the direction's influence.
  double tolerance = 0.03;
  bool ask_other_kinds = true;
  SlopePatch patch;
};

/// Judges a target. In some tens of milliseconds: far inside by closed form, else with up to 8 prints.
/// @throws InvalidInput for a kind that gamut_kind does not know, or a printer or bounds that make no sense.
[[nodiscard]] GamutVerdict judge(const Target& target, const PrinterProfile& printer, const std::string& kind,
                                 const GamutOptions& options = {});
/// With bounds of one's own.
[[nodiscard]] GamutVerdict judge(const Target& target, const PrinterProfile& printer, const GamutKind& kind,
                                 const GamutOptions& options = {});

}  // namespace mezzotint
