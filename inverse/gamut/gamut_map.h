#pragma once

#include <string>
#include <vector>

#include "inverse/gamut/gamut.h"

namespace mezzotint {

struct GamutMapOptions {
  std::vector<std::string> kinds = gamut_kind_names();
  GamutBounds bounds;
  Length wavelength = Length::from_nm(550.0);
  /// Times the profile's blur: the blur is the least known of what decides the gamut.
  std::vector<double> blur_factors = {1.0, 0.7, 1.3};
  std::size_t rays = 13;         ///< ratios of the pattern's two slopes along which the border is sought, 2…200
  std::size_t edge_heights = 8;  ///< points of the most stretched prints, from flat to steep, 2…200
  SlopePatch patch{128, 3, 3, 1};
};

/// A point of the border, really printed.
struct BorderPoint {
  AlphaPair alpha;
  /// Relative, of both α's: standard error over draws, what the last steps of the search still gained, the influence
  /// of the direction (1.5 %), in quadrature.
  double tolerance = 0.0;
  std::vector<double> values;  ///< of the kind's free numbers
};

/// What one kind reaches with one blur: the part of the chart of α_x ≥ α_y between the floor, the most stretched
/// prints, the steepest prints and the diagonal.
struct GamutRegion {
  std::string kind;
  double blur_factor = 1.0;
  double floor_alpha = 0.0;
  std::vector<BorderPoint> stretched;  ///< the smallest α_y for rising α_x
  std::vector<BorderPoint> steepest;   ///< the largest α_x for rising α_y/α_x; one point for a kind of one slope

  /// The border as a closed line, from the floor on.
  [[nodiscard]] std::vector<AlphaPair> outline() const;
  [[nodiscard]] double largest_tolerance() const;
};

struct GamutMap {
  GamutMapOptions options;
  GamutFormula formula;
  std::vector<GamutRegion> regions;  ///< kind by kind, blur by blur
};

/// The map is made of tasks that know nothing of each other, so that they may run anywhere: their number; one of them
/// (0.1–2 s); and the map from all results, in the order of the tasks.
/// @throws InvalidInput for options that make no sense.
[[nodiscard]] std::size_t gamut_task_count(const GamutMapOptions& options);
[[nodiscard]] std::vector<double> run_gamut_task(const GamutMapOptions& options, const PrinterProfile& printer,
                                                 std::size_t index);
[[nodiscard]] GamutMap assemble_gamut(const GamutMapOptions& options, const PrinterProfile& printer,
                                      const std::vector<std::vector<double>>& results);

/// "sinusoid, steepest at α_y/α_x of 4 of 13": for progress.
[[nodiscard]] std::string gamut_task_name(const GamutMapOptions& options, std::size_t index);

}  // namespace mezzotint
