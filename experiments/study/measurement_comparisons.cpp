#include "experiments/study/measurement_comparisons.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "forward/base/random.h"
#include "forward/surface/resample.h"
#include "measurement/correction/gaussian_filter.h"
#include "measurement/correction/plane.h"

namespace mezzotint {

namespace {

std::vector<std::size_t> missing_samples(const HeightField& field) {
  std::vector<std::size_t> missing;
  for (std::size_t i = 0; i < field.grid().size(); ++i)
    if (std::isnan(field.heights_um()[i])) missing.push_back(i);
  return missing;
}

// Mean of the neighbours that there are.
float mean_around(const HeightField& field, std::size_t index) {
  const std::size_t column = index % field.columns(), row = index / field.columns();
  float sum = 0.0F, count = 0.0F;
  const auto add = [&](std::size_t c, std::size_t r) {
    sum += field.at(c, r);
    count += 1.0F;
  };
  if (column > 0) add(column - 1, row);
  if (column + 1 < field.columns()) add(column + 1, row);
  if (row > 0) add(column, row - 1);
  if (row + 1 < field.rows()) add(column, row + 1);
  return sum / count;
}

// Along rows, samples `stride` apart; the sums of a line at a time.
void smooth_line(std::vector<double>& line, const std::vector<double>& weights, std::vector<double>& result) {
  const auto count = static_cast<std::ptrdiff_t>(line.size()), reach = static_cast<std::ptrdiff_t>(weights.size()) - 1;
  for (std::ptrdiff_t i = 0; i < count; ++i) {
    double sum = 0.0, total = 0.0;
    for (std::ptrdiff_t j = std::max<std::ptrdiff_t>(0, i - reach); j <= std::min(count - 1, i + reach); ++j) {
      const double weight = weights[static_cast<std::size_t>(std::abs(j - i))];
      sum += weight * line[static_cast<std::size_t>(j)];
      total += weight;
    }
    result[static_cast<std::size_t>(i)] = sum / total;
  }
}

std::vector<double> gaussian_weights(double cutoff_in_samples, double reach_in_cutoffs) {
  const double alpha = std::sqrt(std::numbers::ln2 / std::numbers::pi);
  std::vector<double> weights(static_cast<std::size_t>(std::ceil(reach_in_cutoffs * cutoff_in_samples)) + 1);
  for (std::size_t k = 0; k < weights.size(); ++k)
    weights[k] = std::exp(-std::numbers::pi * std::pow(static_cast<double>(k) / (alpha * cutoff_in_samples), 2));
  return weights;
}

/// Root mean square about the mean, of one height after the other.
class RootMeanSquare {
public:
  void add(double z) {
    sum_ += z;
    squares_ += z * z;
    count_ += 1.0;
  }
  [[nodiscard]] double value() const {
    return std::sqrt(std::max(0.0, squares_ / count_ - sum_ * sum_ / (count_ * count_)));
  }

private:
  double sum_ = 0.0, squares_ = 0.0, count_ = 0.0;
};

}  // namespace

HeightField fill_by_plane(const HeightField& field) {
  const Plane plane = fit_plane(field);
  const FieldPoint middle = middle_of(field.grid());
  HeightField filled = field;
  for (const std::size_t i : missing_samples(field)) {
    const std::size_t column = i % field.columns(), row = i / field.columns();
    const double x = static_cast<double>(column) * field.grid().pitch_x.um() - middle.x_um;
    const double y = static_cast<double>(row) * field.grid().pitch_y.um() - middle.y_um;
    filled.heights_um()[i] = static_cast<float>(plane.offset.um() + plane.slope_x * x + plane.slope_y * y);
  }
  return filled;
}

HeightField fill_by_relaxation(const HeightField& field, int sweeps) {
  const std::vector<std::size_t> missing = missing_samples(field);
  HeightField filled = fill_by_plane(field);
  for (int sweep = 0; sweep < sweeps; ++sweep)
    for (const std::size_t i : missing) filled.heights_um()[i] = mean_around(filled, i);
  return filled;
}

HeightField smooth_by_sums(const HeightField& field, Length cutoff, double reach_in_cutoffs) {
  HeightField result = field;
  const auto along = [&](std::size_t lines, std::size_t length, Length pitch, const auto& at) {
    const std::vector<double> weights = gaussian_weights(cutoff / pitch, reach_in_cutoffs);
    std::vector<double> line(length), smooth(length);
    for (std::size_t k = 0; k < lines; ++k) {
      for (std::size_t i = 0; i < length; ++i) line[i] = double{at(k, i)};
      smooth_line(line, weights, smooth);
      for (std::size_t i = 0; i < length; ++i) at(k, i) = static_cast<float>(smooth[i]);
    }
  };
  along(field.rows(), field.columns(), field.grid().pitch_x,
        [&](std::size_t row, std::size_t column) -> float& { return result.at(column, row); });
  along(field.columns(), field.rows(), field.grid().pitch_y,
        [&](std::size_t column, std::size_t row) -> float& { return result.at(column, row); });
  return result;
}

HeightField smooth_wrapped(const HeightField& field, Length cutoff) {
  const HeightField period(field.grid(), Continuation::Periodic,
                           {field.heights_um().begin(), field.heights_um().end()});
  return s_filter(period, cutoff);
}

double sq_of_every(const HeightField& field, std::size_t step) {
  RootMeanSquare rms;
  for (std::size_t row = step / 2; row < field.rows(); row += step)
    for (std::size_t column = step / 2; column < field.columns(); column += step)
      rms.add(double{field.at(column, row)});
  return rms.value();
}

double sq_of_random(const HeightField& field, std::size_t count, std::uint64_t seed) {
  const RandomStream random(seed, RandomPurpose::StudySample);
  const auto size = static_cast<double>(field.grid().size());
  RootMeanSquare rms;
  for (std::size_t k = 0; k < count; k += 4)
    for (const double place : random.uniform4(k / 4))
      rms.add(double{field.heights_um()[static_cast<std::size_t>(place * size)]});
  return rms.value();
}

double sq_of_rows(const HeightField& field, std::size_t rows) {
  RootMeanSquare rms;
  for (const float z : field.heights_um().first(rows * field.columns())) rms.add(double{z});
  return rms.value();
}

}  // namespace mezzotint
