#pragma once

#include <span>

#include <Eigen/Core>

#include "inverse/objective/lobe_distance.h"

namespace mezzotint {

/// The light of a lobe in the plane of directions (x, y): how much, where, and how wide.
struct LightMoments {
  double light = 0.0;  ///< ∫ f cosθ dω
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();
};

[[nodiscard]] LightMoments light_moments(const SmoothGrid& grid, std::span<const double> lobe);

/// The middle of a bin in the plane of directions.
[[nodiscard]] Eigen::Vector2d bin_middle(const DirectionGrid& grid, std::size_t bin);

/// LobeDistance::Moments.
[[nodiscard]] DistanceWithSlopes moment_distance(const SmoothGrid& grid, std::span<const double> f,
                                                 std::span<const double> g);

}  // namespace mezzotint
