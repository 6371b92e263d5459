#include "inverse/design/moments_start.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "forward/base/random.h"
#include "inverse/design/design_variables.h"
#include "inverse/design/expected_covariance.h"
#include "inverse/design/printed_moments.h"

namespace mezzotint {

namespace {

// Weight of the square distance from where one came, the range of a variable being 1: far below what is asked of the
// slopes (1e-3 of a variance is 1e-6), far above rounding.
constexpr double pull = 1e-5;

double square(double value) { return value * value; }

double share_of_range(const Variable& variable, double from, double to) {
  if (variable.logarithmic) return std::log(to / from) / std::log(variable.high / variable.low);
  return (to - from) / (variable.high - variable.low);
}

double from_share(const Variable& variable, double share) {
  if (variable.logarithmic) return variable.low * std::pow(variable.high / variable.low, share);
  return variable.low + share * (variable.high - variable.low);
}

}  // namespace

bool MomentsModel::exists() const { return printed_moments(pattern_, printer_, wavelength_).has_value(); }

SlopeCovariance MomentsModel::covariance(const std::vector<double>& values) const {
  return printed_moments(with_values(pattern_, variables_, values), printer_, wavelength_).value();
}

std::vector<double> MomentsModel::solve(const Target& wanted, const std::vector<double>& from) const {
  std::vector<Variable> variables = variables_;
  for (std::size_t i = 0; i < variables.size(); ++i)
    variables[i].start = std::clamp(from[i], variables[i].low, variables[i].high);
  const auto objective = [&](const std::vector<double>& values) {
    double moved = 0.0;
    for (std::size_t i = 0; i < values.size(); ++i) moved += square(share_of_range(variables[i], from[i], values[i]));
    return covariance_distance(covariance(values), wanted) + pull * moved;
  };
  MinimizeOptions options{.max_evaluations = 300, .relative_tolerance = 1e-5, .initial_step = 0.05};
  return minimize(variables, objective, options).best.values;
}

SlopeCovariance mapped(const SlopeCovariance& moments, const SlopeCovariance& shown, const SlopeCovariance& wanted) {
  return through(symmetric_factor(shown, moments), wanted);
}

std::vector<std::vector<double>> spread_points(const std::vector<Variable>& variables, std::size_t count,
                                               std::uint64_t seed) {
  const RandomStream stream(seed, RandomPurpose::SearchStart);
  std::vector<std::vector<double>> points(count, std::vector<double>(variables.size()));
  for (std::size_t axis = 0; axis < variables.size(); ++axis) {
    std::vector<std::pair<double, std::size_t>> order;
    for (std::size_t i = 0; i < count; ++i) order.emplace_back(stream.uniform4(axis * count + i)[0], i);
    std::ranges::sort(order);
    for (std::size_t place = 0; place < count; ++place) {
      const std::size_t i = order[place].second;
      const double within = stream.uniform4(axis * count + i)[1];
      points[i][axis] = from_share(variables[axis], (static_cast<double>(place) + within) / static_cast<double>(count));
    }
  }
  return points;
}

}  // namespace mezzotint
