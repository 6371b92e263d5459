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

/// A measure and what it comes to.
struct MeasuredDistance {
  Measure measure = Measure::SlopeCovariance;
  double value = 0.0;
};

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
  /// Every measure that the goal has.
  [[nodiscard]] std::vector<MeasuredDistance> all(const SlopeModel::Shown& shown) const;

private:
  Target target_;
  std::optional<LobeTarget> lobes_;
  bool by_light_;
};

/// What noise alone gives each measure of the mean of some draws: a quarter of the distance of one half of them from
/// the other, since the mean of all has a quarter of the variance of their difference. Empty with fewer than two draws.
[[nodiscard]] std::vector<MeasuredDistance> noise_floors(const DesignGoal& goal,
                                                         const std::vector<SlopeModel::Shown>& draws);

}  // namespace mezzotint
