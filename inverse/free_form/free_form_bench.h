#pragma once

#include <vector>

#include "inverse/free_form/free_form.h"
#include "inverse/objective/smooth_lobe.h"

/// Inside of inverse/free_form: the model that a search lowers.

namespace mezzotint {

/// Where the relief is sampled.
struct Places {
  std::size_t subsamples = 1;  ///< a pixel and axis
  double x = 0.5, y = 0.5;     ///< within a sub-pixel
};

/// Wanted heights in µm, one a pixel, and the gray values that ask for them: gray = γ + e^((h − α)/β) also below
/// the threshold, where h is negative and nothing cures.
struct WantedHeights {
  double low_um = 0.0, high_um = 0.0;
};
[[nodiscard]] WantedHeights wanted_range(const PrinterProfile& printer);
[[nodiscard]] GrayImage gray_of_heights(const std::vector<double>& heights_um, std::size_t pixels,
                                        const PrinterProfile& printer);

/// The bins of a model: three times as fine as a goal's (less where that would be more than 512 a side). Made once.
[[nodiscard]] SmoothGrid model_bins(const LobeTarget& goal);

/// The printer and the light at one set of places.
class FreeFormBench {
public:
  FreeFormBench(const LobeTarget& goal, const SmoothGrid& fine, const PrinterProfile& printer,
                const FreeFormOptions& options, const Places& places);

  /// The lobes of a print in the goal's bins, one a direction of the light.
  [[nodiscard]] std::vector<DirectionMap> lobes(const GrayImage& gray) const;

  /// Weighted sum of distances, mean over the directions of the light, with its slope toward every gray value.
  /// @param beyond  added to the model's lobes, one a direction, or none; where the sum is below 0 it is dark
  double distance(const std::vector<WeightedDistance>& objective, const std::vector<DirectionMap>& beyond,
                  const GrayImage& gray, std::vector<float>& gray_slopes) const;

private:
  [[nodiscard]] DirectionMap to_goal(const DirectionMap& fine, std::size_t light) const;
  [[nodiscard]] std::vector<double> from_goal(std::vector<double> slopes, std::size_t light) const;

  const LobeTarget& goal_;
  PrintProcess process_;
  const SmoothGrid& fine_;
  std::vector<SmoothLobe> lobes_;
  std::vector<double> variances_;
};

}  // namespace mezzotint
