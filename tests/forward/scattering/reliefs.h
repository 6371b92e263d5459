#pragma once

#include <cmath>
#include <cstddef>
#include <functional>
#include <numbers>
#include <vector>

#include "forward/base/random.h"
#include "forward/surface/height_field.h"
#include "forward/surface/slope_covariance.h"

namespace mezzotint::test {

/// Heights in cells (µm, with a pitch of 1 µm along x) by a function of the sample.
inline HeightField relief(std::size_t columns, std::size_t rows, Continuation continuation,
                          const std::function<double(double, double)>& height, double pitch_y_um = 1.0) {
  HeightField field({columns, rows, Length::from_um(1.0), Length::from_um(pitch_y_um)}, continuation);
  for (std::size_t r = 0; r < rows; ++r) {
    for (std::size_t c = 0; c < columns; ++c) {
      field.at(c, r) = static_cast<float>(height(static_cast<double>(c), static_cast<double>(r)));
    }
  }
  return field;
}

/// RMS gradient √E|∇h|² over the facets of a relief without tilt.
inline double rms_gradient(const HeightField& field) {
  const SlopeCovariance covariance = slope_covariance(field);
  return std::sqrt(covariance.xx + covariance.yy);
}

/// A periodic relief of isotropic, nearly Gaussian slopes: 96 plane waves with random directions, lengths
/// of about size/8 and random phases, scaled to the RMS gradient that is asked for.
inline HeightField random_relief(std::size_t size, double gradient, std::uint64_t seed = 1) {
  struct Wave {
    double x, y, phase;
  };
  std::vector<Wave> waves;
  const RandomStream random(seed, RandomPurpose::Test);
  for (std::uint64_t k = 0; waves.size() < 96; ++k) {
    const auto n = random.normal4(k);
    const Wave wave{std::round(7.0 * n[0]), std::round(7.0 * n[1]), 3.0 * n[2] + 5.0 * n[3]};
    if (wave.x != 0.0 || wave.y != 0.0) waves.push_back(wave);
  }
  const double unit = 2.0 * std::numbers::pi / static_cast<double>(size);
  HeightField field = relief(size, size, Continuation::Periodic, [&](double c, double r) {
    double z = 0.0;
    for (const Wave& wave : waves) z += std::cos(unit * (wave.x * c + wave.y * r) + wave.phase);
    return z;
  });
  const double scale = gradient / rms_gradient(field);
  for (float& z : field.heights_um()) z = static_cast<float>(z * scale);
  return field;
}

}  // namespace mezzotint::test
