#include "inverse/design/design_goal.h"

#include <string>

#include "forward/base/error.h"
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
  return by_light_ ? implied_slopes(*lobes_, shown.maps).covariance : shown.covariance;
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

std::vector<MeasuredDistance> DesignGoal::all(const SlopeModel::Shown& shown) const {
  std::vector<MeasuredDistance> found;
  for (const Measure measure : all_measures) {
    if (lobes_ || measure == Measure::SlopeCovariance) found.push_back({measure, distance(measure, shown)});
  }
  return found;
}

std::vector<MeasuredDistance> noise_floors(const DesignGoal& goal, const std::vector<SlopeModel::Shown>& draws) {
  if (draws.size() < 2) return {};
  const auto middle = draws.begin() + static_cast<std::ptrdiff_t>(draws.size() / 2);
  const SlopeModel::Shown first = mean_of(std::vector(draws.begin(), middle)),
                          second = mean_of(std::vector(middle, draws.end()));
  Target target = goal.target();
  target.slopes = principal_axes(first.covariance);
  std::optional<LobeTarget> lobes = goal.lobes();
  if (lobes) lobes->maps = first.maps;
  std::vector<MeasuredDistance> floors = DesignGoal(target, lobes, goal.by_light()).all(second);
  for (MeasuredDistance& floor : floors) floor.value *= 0.25;
  return floors;
}

}  // namespace mezzotint
