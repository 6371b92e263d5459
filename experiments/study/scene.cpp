#include "experiments/study/scene.h"

#include <cmath>
#include <functional>
#include <numbers>

#include "forward/base/error.h"
#include "forward/base/random.h"
#include "forward/surface/slope_covariance.h"

namespace mezzotint {

namespace {

constexpr double turn = 2.0 * std::numbers::pi;

using Height = std::function<double(double, double)>;  ///< of a place in periods of the tile

Height gaussian() {
  struct Wave {
    double x, y, phase;
  };
  std::vector<Wave> waves;
  const RandomStream random(1, RandomPurpose::Test);
  for (std::uint64_t k = 0; k < 64; ++k) {
    const auto u = random.uniform4(k);
    const double count = 16.0 * std::pow(4.0, u[1]);
    waves.push_back(
        {std::round(count * std::cos(turn * u[0])), std::round(count * std::sin(turn * u[0])), turn * u[2]});
  }
  return [waves](double x, double y) {
    double sum = 0.0;
    // Each wave has the same slope, so that no octave is much rougher than the others.
    for (const Wave& wave : waves)
      sum += std::sin(turn * (wave.x * x + wave.y * y) + wave.phase) / std::hypot(wave.x, wave.y);
    return sum;
  };
}

Height height_of(const std::string& family) {
  constexpr double periods = 16.0;
  if (family == "gaussian") return gaussian();
  if (family == "sinusoid")
    return [](double x, double y) { return std::sin(turn * periods * x) * std::sin(turn * periods * y); };
  require(family == "ridges", "a study knows the reliefs gaussian, sinusoid and ridges, not \"" + family + "\"");
  return [](double x, double) { return std::abs(2.0 * (periods * x - std::floor(periods * x)) - 1.0); };
}

}  // namespace

const std::vector<std::string>& study_families() {
  static const std::vector<std::string> names = {"gaussian", "sinusoid", "ridges"};
  return names;
}

StudyRelief make_study_relief(const std::string& family, double gradient, std::size_t cells) {
  require(gradient > 0.0 && gradient <= 4.0 && cells >= 64 && cells <= 8192,
          "a study needs an RMS gradient in (0, 4] and 64 to 8192 cells a side");
  const Height height = height_of(family);
  HeightField field({cells, cells, Length::from_um(1.0), Length::from_um(1.0)}, Continuation::Periodic);
  for (std::size_t row = 0; row < cells; ++row) {
    for (std::size_t column = 0; column < cells; ++column) {
      field.at(column, row) = static_cast<float>(height(static_cast<double>(column) / static_cast<double>(cells),
                                                        static_cast<double>(row) / static_cast<double>(cells)));
    }
  }
  const SlopeCovariance slopes = slope_covariance(field);
  const auto scale = static_cast<float>(gradient / std::sqrt(slopes.xx + slopes.yy));
  for (float& z : field.heights_um()) z *= scale;
  return {family, gradient, std::move(field)};
}

HeightField coarser(const HeightField& field) {
  const Grid& grid = field.grid();
  HeightField half({grid.columns / 2, grid.rows / 2, grid.pitch_x + grid.pitch_x, grid.pitch_y + grid.pitch_y},
                   field.continuation());
  for (std::size_t row = 0; row < half.rows(); ++row)
    for (std::size_t column = 0; column < half.columns(); ++column)
      half.at(column, row) = field.at(2 * column, 2 * row);
  return half;
}

}  // namespace mezzotint
