#include "measurement/correction/step_lines.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "forward/base/error.h"

namespace mezzotint {

namespace {

constexpr std::size_t around = 3;  // rows to either side of a running median
constexpr double robust = 1.4826;  // a Gaussian's deviation over its median absolute deviation
constexpr double limit = 3.0;

// Of at least one value; of an even number the upper of the two in the middle.
double median(std::vector<double>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

double median_difference(const HeightField& field, std::size_t row) {
  std::vector<double> differences;
  for (std::size_t column = 0; column < field.columns(); ++column) {
    const double difference =
        static_cast<double>(field.at(column, row + 1)) - static_cast<double>(field.at(column, row));
    if (!std::isnan(difference)) differences.push_back(difference);
  }
  return differences.empty() ? std::nan("") : median(differences);
}

// What is left of each difference after the running median of those around it; NaN stays NaN.
std::vector<double> against_neighbours(const std::vector<double>& differences) {
  std::vector<double> rest(differences.size(), std::nan(""));
  for (std::size_t k = 0; k < differences.size(); ++k) {
    if (std::isnan(differences[k])) continue;
    std::vector<double> near;
    for (std::size_t i = k < around ? 0 : k - around; i <= std::min(k + around, differences.size() - 1); ++i)
      if (!std::isnan(differences[i])) near.push_back(differences[i]);
    rest[k] = differences[k] - median(near);
  }
  return rest;
}

double robust_deviation(const std::vector<double>& values) {
  std::vector<double> sizes;
  for (const double value : values)
    if (!std::isnan(value)) sizes.push_back(std::abs(value));
  return sizes.empty() ? 0.0 : robust * median(sizes);
}

std::string warning_of(const StepLineResult& result) {
  constexpr double much = 0.3;
  double offset = 0.0, sum = 0.0, squares = 0.0, steps = 0.0;
  for (const double step : result.steps_um) {
    offset += step;
    sum += offset;
    squares += offset * offset;
    steps += step != 0.0 ? 1.0 : 0.0;
  }
  const auto count = static_cast<double>(result.steps_um.size());
  const double moved = std::sqrt(std::max(0.0, squares / count - sum * sum / (count * count)));
  const double left = root_mean_square_height(result.field).um();
  if (!(moved > much * left)) return "";
  return fmt::format(
      "{:.0f} steps between rows were taken out, {:.3g} um (rms) of height, where {:.3g} um are left: steps of the "
      "surface itself that run along the rows look the same. Measure it turned by 90 degrees to tell them apart",
      steps, moved, left);
}

}  // namespace

StepLineResult correct_step_lines(const HeightField& field) {
  require(field.rows() >= 2, "steps between rows need two rows at least");
  std::vector<double> differences(field.rows() - 1);
  for (std::size_t row = 0; row + 1 < field.rows(); ++row) differences[row] = median_difference(field, row);
  const std::vector<double> rest = against_neighbours(differences);
  const double least = limit * robust_deviation(rest);
  StepLineResult result{field, std::vector<double>(rest.size(), 0.0)};
  double offset = 0.0;
  for (std::size_t row = 1; row < field.rows(); ++row) {
    const double step = rest[row - 1];
    if (std::abs(step) > least) result.steps_um[row - 1] = step;
    offset += result.steps_um[row - 1];
    for (std::size_t column = 0; column < field.columns(); ++column)
      result.field.at(column, row) = static_cast<float>(static_cast<double>(field.at(column, row)) - offset);
  }
  result.warning = warning_of(result);
  return result;
}

}  // namespace mezzotint
