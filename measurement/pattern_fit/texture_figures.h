#pragma once

#include <cstddef>
#include <vector>

#include "measurement/pattern_fit/whittle.h"

/// Inside of measurement/pattern_fit.

namespace mezzotint {

/// Figures by which a texture is compared with draws of a pattern, each about normal.
struct TextureFigures {
  std::vector<double> spectrum;    ///< of rings of the spectrum: ln (power seen / power of the fit)
  std::vector<double> directions;  ///< of sectors: the same, of means over ratios
  std::vector<double> shape;       ///< skewness and kurtosis of heights, and of differences along x and y
  std::vector<double> evenness;    ///< scatter of ln(mean square) over 4 × 4 parts, of heights and of differences
};

/// Takes the same figures of a scan and of draws. Rings are ellipses, stretched as the pattern is.
class FigureTaker {
public:
  /// @param used  the blocks of the fit; sectors are taken of them alone
  FigureTaker(const FitView& view, const NoiseFit& fit, const std::vector<double>& density_um4,
              const std::vector<std::size_t>& used);

  /// @param field    as the view sees it
  /// @param numbers  the fit to this very field
  [[nodiscard]] TextureFigures figures(const HeightField& field, const std::vector<double>& density_um4,
                                       const NoiseNumbers& numbers) const;

private:
  void share_out_rings(const std::vector<CellFrequency>& places, const std::vector<double>& density_um4,
                       const std::vector<double>& expected);

  const FitView& view_;
  NoiseModel model_;
  std::size_t lag_x_ = 1, lag_y_ = 1;
  std::size_t rings_ = 0;
  std::vector<std::size_t> ring_, sector_;  // of each block; beyond the last: none
};

/// How probable figures as far from those of the draws are: the sum of squared deviations, in units of the draws' own
/// scatter, against the same sum of each draw against the others (by a gamma distribution of its mean and variance).
[[nodiscard]] double probability_among(const std::vector<double>& seen, const std::vector<std::vector<double>>& drawn);

}  // namespace mezzotint
