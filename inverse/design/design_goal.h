#pragma once

#include <array>
#include <optional>
#include <string_view>
#include <vector>

#include "inverse/design/slope_model.h"
#include "inverse/objective/lobe_distance.h"
#include "inverse/target/lobe_target.h"
#include "inverse/target/target.h"

namespace mezzotint {

/// What a search can lower: the distance of the slope covariances (covariance_distance), or one of the lobes'
/// (LobeDistance), mean over the directions of the light. All are squares, 0 where the target is met.
enum class Measure { SlopeCovariance, L2, CubeRoot, Logarithm, Wasserstein, Moments };

inline constexpr std::array all_measures = {Measure::SlopeCovariance, Measure::L2,          Measure::CubeRoot,
                                            Measure::Logarithm,       Measure::Wasserstein, Measure::Moments};

/// "slope_covariance", "l2", "cube_root", "log", "sliced_wasserstein", "moments".
[[nodiscard]] std::string_view name_of(Measure measure);
/// @throws InvalidInput for a name that no measure has.
[[nodiscard]] Measure measure_named(std::string_view name);
/// None for SlopeCovariance, which is no distance of lobes.
[[nodiscard]] std::optional<LobeDistance> lobe_distance_of(Measure measure);

/// A sum of measures, each with a weight.
struct WeightedMeasure {
  Measure measure = Measure::SlopeCovariance;
  double weight = 1.0;
};
using MeasureSum = std::vector<WeightedMeasure>;

/// What a search is for: slopes, lobes, or both. Where the lobes are what the user gave (`by_light`), slopes are those
/// that the lobes imply, on both sides.
class DesignGoal {
public:
  /// @throws InvalidInput for `by_light` without lobes.
  DesignGoal(const Target& target, const std::optional<LobeTarget>& lobes, bool by_light);

  /// The wanted slopes.
  [[nodiscard]] const Target& target() const { return target_; }
  [[nodiscard]] const std::optional<LobeTarget>& lobes() const { return lobes_; }
  [[nodiscard]] bool by_light() const { return by_light_; }

  /// The slopes that are compared.
  [[nodiscard]] SlopeCovariance covariance(const SlopeModel::Shown& shown) const;
  [[nodiscard]] double distance(Measure measure, const SlopeModel::Shown& shown) const;
  [[nodiscard]] double distance(const MeasureSum& sum, const SlopeModel::Shown& shown) const;

  /// Whether a sum has slopes toward what is shown: all have, but for the covariance that light implies.
  [[nodiscard]] bool has_slopes(const MeasureSum& sum) const;
  /// The same distance, which also sets its slopes (in the order and shape of `shown`).
  [[nodiscard]] double distance_with_slopes(const MeasureSum& sum, const SlopeModel::Shown& shown,
                                            SlopeModel::Shown& slopes) const;

private:
  Target target_;
  std::optional<LobeTarget> lobes_;
  bool by_light_;
};

}  // namespace mezzotint
