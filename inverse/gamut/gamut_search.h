#pragma once

#include <functional>
#include <vector>

#include "inverse/gamut/gamut_kind.h"
#include "inverse/gamut/slope_print.h"

/// Inside of inverse/gamut: how the real process is searched with few prints.

namespace mezzotint {

/// What is minimised: a figure of the squares along the pattern's axes, without ground.
using SquaresFigure = std::function<double(const AxisSquares&)>;

/// The closed form, corrected along both axes by what a print was found to be.
struct SlopeModel {
  const GamutKind& kind;
  const PrinterProfile& printer;
  AxisSquares correction{1.0, 1.0};

  [[nodiscard]] AxisSquares squares(const std::vector<double>& values) const;
};

/// Values of the free numbers with a low figure by the model: a coarse draw of the whole room, then BOBYQA from the
/// best few. In milliseconds; the same with any number of threads.
/// @param hints  further values to begin from
[[nodiscard]] std::vector<double> lowest_by_model(const SlopeModel& model, const SquaresFigure& figure,
                                                  const std::vector<std::vector<double>>& hints = {});

/// Values, and how they print.
struct PrintedPoint {
  std::vector<double> values;
  PrintedSquares squares;
  double figure = 0.0;
};

/// What a search with the real process found, and the correction of the closed form there.
struct PrintedSearch {
  PrintedPoint best;
  AxisSquares correction{1.0, 1.0};
  int prints = 0;
};

/// Minimises the figure of prints by minimising the corrected closed form, printing there, and correcting anew: the
/// correction changes slowly, so a few prints suffice.
/// @param good_enough  a figure at which to stop
[[nodiscard]] PrintedSearch lowest_by_print(const GamutKind& kind, const SlopePrint& print, const SquaresFigure& figure,
                                            double good_enough, int most_prints);

}  // namespace mezzotint
