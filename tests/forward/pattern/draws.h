#pragma once

#include <cmath>
#include <cstdint>
#include <functional>
#include <vector>

#include <gtest/gtest.h>

#include "forward/pattern/pattern.h"
#include "forward/surface/slope_covariance.h"

namespace mezzotint::test {

inline double mean_height(const HeightField& field) {
  double sum = 0.0;
  for (const float z : field.heights_um()) sum += static_cast<double>(z);
  return sum / static_cast<double>(field.heights_um().size());
}
inline double mean_square_about(const HeightField& field, double centre) {
  double sum = 0.0;
  for (const float z : field.heights_um()) sum += (z - centre) * (z - centre);
  return sum / static_cast<double>(field.heights_um().size());
}

inline Grid square_grid(std::size_t side, double pitch_um) {
  return {side, side, Length::from_um(pitch_um), Length::from_um(pitch_um)};
}

/// A figure over independent draws of a pattern: its mean, and the standard error of that from their scatter.
struct DrawnFigure {
  double mean = 0.0;
  double error = 0.0;
};

/// Several figures of each draw.
inline std::vector<DrawnFigure> over_draws(const Pattern& pattern, const Grid& grid, std::uint64_t draws,
                                           const std::function<std::vector<double>(const HeightField&)>& figures) {
  std::vector<double> sums, squares;
  for (std::uint64_t seed = 1; seed <= draws; ++seed) {
    const PatternInstance drawn = draw_instance(pattern, seed);
    const std::vector<double> values = figures(synthesize(drawn.pattern, grid, drawn.origin));
    sums.resize(values.size());
    squares.resize(values.size());
    for (std::size_t i = 0; i < values.size(); ++i) {
      sums[i] += values[i];
      squares[i] += values[i] * values[i];
    }
  }
  const auto n = static_cast<double>(draws);
  std::vector<DrawnFigure> result;
  for (std::size_t i = 0; i < sums.size(); ++i) {
    const double mean = sums[i] / n;
    result.push_back({mean, std::sqrt(std::max(0.0, squares[i] / n - mean * mean) / (n - 1.0))});
  }
  return result;
}

/// Four standard errors (with 11 degrees of freedom a false alarm in 500), and `bias` of the expected value for what
/// the grid and the cut to [0, height] change.
inline void expect_drawn(const DrawnFigure& drawn, double expected, double bias, const std::string& what) {
  EXPECT_NEAR(drawn.mean, expected, 4.0 * drawn.error + bias * std::abs(expected)) << what;
  EXPECT_LT(drawn.error, 0.05 * std::abs(expected) + 1e-12) << what << ": too few draws to say anything";
}

}  // namespace mezzotint::test
