#include "inverse/design/design_goal.h"

#include <algorithm>
#include <string>

#include "forward/base/error.h"
#include "inverse/design/expected_covariance.h"
#include "inverse/target/implied_slopes.h"

namespace mezzotint {

namespace {

Target with_implied_slopes(Target target, const LobeTarget& lobes) {
  target.slopes = principal_axes(implied_slopes(lobes, lobes.maps).covariance);
  return target;
}

}  // namespace

std::optional<LobeDistance> lobe_distance_of(Measure measure) {
  switch (measure) {
    case Measure::L2:
      return LobeDistance::L2;
    case Measure::CubeRoot:
      return LobeDistance::CubeRoot;
    case Measure::Logarithm:
      return LobeDistance::Logarithm;
    case Measure::Wasserstein:
      return LobeDistance::Wasserstein;
    case Measure::Moments:
      return LobeDistance::Moments;
    case Measure::SlopeCovariance:
      break;
  }
  return {};
}

std::string_view name_of(Measure measure) {
  const auto lobe = lobe_distance_of(measure);
  return lobe ? name_of(*lobe) : "slope_covariance";
}

Measure measure_named(std::string_view name) {
  for (const Measure measure : all_measures) {
    if (name_of(measure) == name) return measure;
  }
  throw InvalidInput("no measure is called \"" + std::string(name) + "\"");
}

DesignGoal::DesignGoal(const Target& target, const std::optional<LobeTarget>& lobes, bool by_light)
    : target_(target), lobes_(lobes), by_light_(by_light) {
  require(!by_light || lobes, "a goal by its light needs lobes");
  if (by_light) target_ = with_implied_slopes(target, *lobes);
}

SlopeCovariance DesignGoal::covariance(const SlopeModel::Shown& shown) const {
  return by_light_ ? through(shown.to_all_draws, implied_slopes(*lobes_, shown.maps).covariance) : shown.covariance;
}

double DesignGoal::distance(Measure measure, const SlopeModel::Shown& shown) const {
  const auto lobe = lobe_distance_of(measure);
  if (!lobe) return covariance_distance(covariance(shown), target_);
  require(lobes_.has_value(), "a goal of slopes alone has no distance between lobes");
  double sum = 0.0;
  for (std::size_t light = 0; light < lobes_->maps.size(); ++light)
    sum += lobe_distance(*lobe, lobes_->grid, shown.maps[light], lobes_->maps[light]).value;
  return sum / static_cast<double>(lobes_->maps.size());
}

double DesignGoal::distance(const MeasureSum& sum, const SlopeModel::Shown& shown) const {
  double total = 0.0;
  for (const WeightedMeasure& term : sum) total += term.weight * distance(term.measure, shown);
  return total;
}

bool DesignGoal::has_slopes(const MeasureSum& sum) const {
  return std::ranges::all_of(
      sum, [this](const WeightedMeasure& term) { return lobe_distance_of(term.measure).has_value() || !by_light_; });
}

double DesignGoal::distance_with_slopes(const MeasureSum& sum, const SlopeModel::Shown& shown,
                                        SlopeModel::Shown& slopes) const {
  require(has_slopes(sum), "the covariance that light implies has no slopes here; moments have");
  slopes = {{}, {}};
  for (const DirectionMap& map : shown.maps) slopes.maps.emplace_back(map.size(), 0.0);
  double total = 0.0;
  for (const WeightedMeasure& term : sum) {
    const auto lobe = lobe_distance_of(term.measure);
    if (!lobe) {
      const CovarianceDistance found = covariance_distance_with_slopes(shown.covariance, target_);
      total += term.weight * found.value;
      slopes.covariance.xx += term.weight * found.slopes.xx;
      slopes.covariance.yy += term.weight * found.slopes.yy;
      slopes.covariance.xy += term.weight * found.slopes.xy;
      continue;
    }
    const double share = term.weight / static_cast<double>(lobes_->maps.size());
    for (std::size_t light = 0; light < lobes_->maps.size(); ++light) {
      const DistanceWithSlopes found = lobe_distance(*lobe, lobes_->grid, shown.maps[light], lobes_->maps[light]);
      total += share * found.value;
      for (std::size_t k = 0; k < found.slopes.size(); ++k) slopes.maps[light][k] += share * found.slopes[k];
    }
  }
  return total;
}

}  // namespace mezzotint
