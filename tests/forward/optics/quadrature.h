#pragma once

#include <cmath>
#include <cstddef>
#include <functional>
#include <numbers>
#include <vector>

#include "forward/optics/direction.h"

namespace mezzotint::test {

struct QuadratureNode {
  double at;
  double weight;
};

/// Gauss–Legendre on [0, 1]: zeros of the Legendre polynomial by Newton's method.
inline std::vector<QuadratureNode> gauss_legendre(std::size_t count) {
  std::vector<QuadratureNode> nodes(count);
  const double n = static_cast<double>(count);
  for (std::size_t i = 0; i < count; ++i) {
    double x = std::cos(std::numbers::pi * (static_cast<double>(i) + 0.75) / (n + 0.5)), slope = 1.0;
    for (int step = 0; step < 20; ++step) {
      double before = 0.0, value = 1.0;
      for (double k = 1.0; k <= n; k += 1.0) {
        const double next = ((2.0 * k - 1.0) * x * value - (k - 1.0) * before) / k;
        before = value;
        value = next;
      }
      slope = n * (x * value - before) / (x * x - 1.0);
      x -= value / slope;
    }
    nodes[i] = {0.5 * (1.0 + x), 1.0 / ((1.0 - x * x) * slope * slope)};
  }
  return nodes;
}

inline double integrate(const std::vector<QuadratureNode>& rule, const std::function<double(double)>& function) {
  double sum = 0.0;
  for (const auto& [at, weight] : rule) sum += weight * function(at);
  return sum;
}

/// ∫ f(ω) cosθ dω over the upper hemisphere: Gauss in cosθ, equal steps (which converge as fast for a
/// periodic function) in φ.
inline double integrate_hemisphere(std::size_t count, const std::function<double(const Direction&)>& function) {
  double sum = 0.0;
  for (const auto& [z, weight] : gauss_legendre(count)) {
    const double across = std::sqrt(1.0 - z * z);
    for (std::size_t k = 0; k < count; ++k) {
      const double phi = 2.0 * std::numbers::pi * (static_cast<double>(k) + 0.5) / static_cast<double>(count);
      sum += weight * z * function({across * std::cos(phi), across * std::sin(phi), z});
    }
  }
  return sum * 2.0 * std::numbers::pi / static_cast<double>(count);
}

}  // namespace mezzotint::test
