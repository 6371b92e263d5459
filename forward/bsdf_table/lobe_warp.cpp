#include "forward/bsdf_table/lobe_warp.h"

#include <algorithm>
#include <cmath>

namespace mezzotint {

namespace {

Eigen::Vector2d within_disc(const Eigen::Vector2d& point) {
  const double squared = point.squaredNorm();
  return squared > 1.0 ? Eigen::Vector2d(point / std::sqrt(squared)) : point;
}

}  // namespace

LobeChart LobeChart::of_reflection(const Direction& to_light) {
  constexpr double least_cosine = 1e-9;  // a light at the horizon sees no slope at all
  LobeChart chart;
  chart.centre_ = -to_light.head<2>();
  chart.cosine_ = std::max(least_cosine, to_light.z());
  return chart;
}

LobeChart LobeChart::of_transmission(const Direction& to_light, double relative_index) {
  LobeChart chart;
  chart.centre_ = -to_light.head<2>() / relative_index;
  chart.cosine_ = std::sqrt(std::max(0.0, 1.0 - chart.centre_.squaredNorm()));
  chart.scale_ = chart.cosine_ - to_light.z() / relative_index;
  chart.ends_flat_ = false;
  return chart;
}

double LobeChart::slope_at(const Eigen::Vector2d& point) const {
  const double across = (point - centre_).norm();
  if (!ends_flat_) return across / scale_;
  return across / (cosine_ + std::sqrt(std::max(0.0, 1.0 - point.squaredNorm())));
}

double LobeChart::reach(const Eigen::Vector2d& toward) const {
  const double along = centre_.dot(toward);
  // The positive root of c μ² + 2 along μ − c = 0, and of |centre + r toward| = 1; neither subtracts likes.
  if (ends_flat_) {
    const double root = std::hypot(along, cosine_);
    return along > 0.0 ? cosine_ / (along + root) : (root - along) / cosine_;
  }
  const double root = std::sqrt(along * along + cosine_ * cosine_);
  const double rim = along > 0.0 ? cosine_ * cosine_ / (along + root) : root - along;
  return rim / scale_;
}

double LobeChart::distance(double slope, const Eigen::Vector2d& toward) const {
  if (!ends_flat_) return slope * scale_;
  return 2.0 * slope * (cosine_ - centre_.dot(toward) * slope) / (1.0 + slope * slope);
}

double LobeChart::density_without_gap(double slope, double reach, const Eigen::Vector2d& toward) const {
  if (!ends_flat_) return scale_ * scale_;
  const double stretch = 1.0 + slope * slope;
  const double facing = cosine_ - centre_.dot(toward) * slope;
  return 4.0 * cosine_ * facing * (slope + 1.0 / reach) / (stretch * stretch * stretch);
}

LobeWarp::Image LobeWarp::operator()(const Eigen::Vector2d& point) const {
  const Eigen::Vector2d offset = point - from_.centre();
  const double across = offset.norm();
  const Eigen::Vector2d toward = across > 0.0 ? Eigen::Vector2d(offset / across) : Eigen::Vector2d::UnitX();
  const double reach_from = from_.reach(toward), reach_to = to_.reach(toward);
  const double slope = std::min(from_.slope_at(point), reach_from);
  const double share = slope / reach_from;
  const double ratio = slope / reach_to;
  const double squeezed = (1.0 - share) * (1.0 + share) + ratio * ratio;  // (slope / slope')²
  const double root = std::sqrt(squeezed);
  const double moved = std::min(slope / root, reach_to);
  double jacobian = to_.density_without_gap(moved, reach_to, toward) /
                    (from_.density_without_gap(slope, reach_from, toward) * squeezed * squeezed);
  if (from_.ends_flat()) {
    // Gap to gap, with what vanishes at the rim divided out of both.
    jacobian *= reach_to / reach_from * (1.0 + share) / (1.0 + moved / reach_to) / squeezed;
  }
  return {within_disc(to_.centre() + to_.distance(moved, toward) * toward), jacobian};
}

}  // namespace mezzotint
