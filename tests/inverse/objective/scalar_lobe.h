#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include "forward/optics/direction.h"
#include "forward/optics/material.h"
#include "inverse/objective/smooth_grid.h"

namespace mezzotint::test {

/// What SmoothLobe does, point by point as its formulas are written: to compare with, in values and in time.
class ScalarLobe {
public:
  ScalarLobe(const SmoothGrid& grid, const Material& material, const DirectionAngles& to_light)
      : grid_(grid), to_light_(to_direction(to_light)), nodes_(steps + 3) {
    for (std::size_t i = 0; i <= steps; ++i)
      nodes_[i + 1] = reflectance(material, static_cast<double>(i) / static_cast<double>(steps));
    nodes_.front() = 3.0 * (nodes_[1] - nodes_[2]) + nodes_[3];
    nodes_.back() = 3.0 * (nodes_[steps + 1] - nodes_[steps]) + nodes_[steps - 1];
  }

  [[nodiscard]] DirectionMap map(std::span<const float> slopes_x, std::span<const float> slopes_y) const {
    const DirectionGrid& bins = grid_.grid();
    DirectionMap map(bins.size(), 0.0);
    for (std::size_t point = 0; point < slopes_x.size(); ++point) {
      const Sent s = sent(slopes_x[point], slopes_y[point]);
      if (s.weight == 0.0) continue;
      const SoftBins u = soft_bins(half(bins.width) * (s.x + 1.0), bins.width);
      const SoftBins v = soft_bins(half(bins.height) * (s.y + 1.0), bins.height);
      for (std::size_t j = 0; j < 3; ++j) {
        double* const line = map.data() + v.bin[j] * bins.width;
        for (std::size_t i = 0; i < 3; ++i) line[u.bin[i]] += s.weight * v.share[j] * u.share[i];
      }
    }
    for (std::size_t k = 0; k < map.size(); ++k)
      map[k] = grid_.areas()[k] > 0.0 ? map[k] / (static_cast<double>(slopes_x.size()) * grid_.areas()[k]) : 0.0;
    return map;
  }

  void add_slope_derivatives(std::span<const float> slopes_x, std::span<const float> slopes_y,
                             std::span<const double> map_derivatives, double share, std::span<float> toward_x,
                             std::span<float> toward_y) const {
    const DirectionGrid& bins = grid_.grid();
    std::vector<double> values(bins.size(), 0.0);
    for (std::size_t k = 0; k < bins.size(); ++k) {
      if (grid_.areas()[k] > 0.0)
        values[k] = share * map_derivatives[k] / (static_cast<double>(slopes_x.size()) * grid_.areas()[k]);
    }
    for (std::size_t point = 0; point < slopes_x.size(); ++point) {
      const Sent s = sent(slopes_x[point], slopes_y[point]);
      if (s.weight == 0.0) continue;
      const SoftBins u = soft_bins(half(bins.width) * (s.x + 1.0), bins.width);
      const SoftBins v = soft_bins(half(bins.height) * (s.y + 1.0), bins.height);
      double value = 0.0, toward_u = 0.0, toward_v = 0.0;
      for (std::size_t j = 0; j < 3; ++j) {
        for (std::size_t i = 0; i < 3; ++i) {
          const double there = values[v.bin[j] * bins.width + u.bin[i]];
          value += v.share[j] * u.share[i] * there;
          toward_u += s.weight * half(bins.width) * v.share[j] * u.slope[i] * there;
          toward_v += s.weight * half(bins.height) * v.slope[j] * u.share[i] * there;
        }
      }
      toward_x[point] += static_cast<float>(s.weight_p * value + toward_u * s.x_p + toward_v * s.y_p);
      toward_y[point] += static_cast<float>(s.weight_q * value + toward_u * s.x_q + toward_v * s.y_q);
    }
  }

private:
  static constexpr std::size_t steps = 2048;
  static double half(std::size_t bins) { return 0.5 * static_cast<double>(bins); }

  // What a facet of a slope sends where, with the slopes of all three toward its own two.
  struct Sent {
    double weight = 0.0, x = 0.0, y = 0.0;
    double weight_p = 0.0, weight_q = 0.0, x_p = 0.0, x_q = 0.0, y_p = 0.0, y_q = 0.0;
  };
  struct CurvePoint {
    double value, slope;
  };

  // Catmull and Rom's cubic.
  [[nodiscard]] CurvePoint fresnel_at(double cosine) const {
    const double at = cosine * static_cast<double>(steps);
    const auto cell = std::min(static_cast<std::size_t>(at), steps - 1);
    const double t = at - static_cast<double>(cell);
    const double p0 = nodes_[cell], p1 = nodes_[cell + 1], p2 = nodes_[cell + 2], p3 = nodes_[cell + 3];
    const double a = 0.5 * (3.0 * (p1 - p2) + p3 - p0), b = p0 - 2.5 * p1 + 2.0 * p2 - 0.5 * p3, c = 0.5 * (p2 - p0);
    return {((a * t + b) * t + c) * t + p1, ((3.0 * a * t + 2.0 * b) * t + c) * static_cast<double>(steps)};
  }

  // With slopes p, q: m = (−p, −q, 1)/n, s = n·(ω_i·m), ω_o = 2 s/n² (−p, −q, 1) − ω_i, weight F(s/n)·s/cosθ_i.
  // Out of line, so that the time of a map is that with all of it.
  [[nodiscard, gnu::noinline]] Sent sent(double p, double q) const {
    const double ix = to_light_.x(), iy = to_light_.y(), iz = to_light_.z();
    const double square = 1.0 + p * p + q * q, s = iz - p * ix - q * iy;
    if (s <= 0.0 || 2.0 * s / square <= iz) return {};  // turned away from the light, or sent downward
    const double n = std::sqrt(square), cosine = std::min(1.0, s / n);
    const CurvePoint fresnel = fresnel_at(cosine);
    const double k = 2.0 * s / square, k2 = 2.0 * k / square;
    const double cosine_p = -ix / n - s * p / (n * square), cosine_q = -iy / n - s * q / (n * square);
    Sent out;
    out.weight = fresnel.value * s / iz;
    out.weight_p = (fresnel.slope * cosine_p * s - fresnel.value * ix) / iz;
    out.weight_q = (fresnel.slope * cosine_q * s - fresnel.value * iy) / iz;
    out.x = -k * p - ix;
    out.y = -k * q - iy;
    out.x_p = 2.0 * ix * p / square - k + k2 * p * p;
    out.x_q = 2.0 * iy * p / square + k2 * p * q;
    out.y_p = 2.0 * ix * q / square + k2 * p * q;
    out.y_q = 2.0 * iy * q / square - k + k2 * q * q;
    return out;
  }

  SmoothGrid grid_;
  Direction to_light_;
  std::vector<double> nodes_;
};

}  // namespace mezzotint::test
