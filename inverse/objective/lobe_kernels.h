#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

/// Inside of inverse/objective: the loops of SmoothLobe over many facets, on vectors (lobe_kernels.cpp).

namespace mezzotint {

/// A curve over [0, 1] by one cubic on each of even steps, for look-ups; and one more from 1 on.
struct CurveCells {
  std::size_t steps = 0;
  std::vector<double> terms;  ///< four a step, of t³, t², t and 1, with t from 0 to 1 within it
};

/// The light, the facets' reflectance by the cosine, and the bins.
struct LobePlan {
  double to_light_x = 0.0, to_light_y = 0.0, to_light_z = 1.0;
  CurveCells reflectance;
  std::size_t bins_x = 0, bins_y = 0;

  /// Bins with one more round them, so that the three by three that a direction falls into are always there.
  [[nodiscard]] std::size_t framed_stride() const { return bins_x + 2; }
  [[nodiscard]] std::size_t framed_size() const { return framed_stride() * (bins_y + 2); }
};

/// The slopes of facets, one a point in both.
struct FacetSlopes {
  const float* x = nullptr;
  const float* y = nullptr;
  std::size_t count = 0;
};

[[nodiscard]] bool all_finite(std::span<const float> values);

/// Adds F(ω_i·m)·max(0, ω_i·m)/(m_z cosθ_i), shared over the framed soft bins, in the order of the points.
/// The same bits with every width of vector.
void add_facet_light(const LobePlan& plan, const FacetSlopes& slopes, double* framed_light);

/// Adds the slopes of Σ (value in framed bins)·(light there) toward the slopes of each facet.
void add_facet_derivatives(const LobePlan& plan, const FacetSlopes& slopes, const double* framed_values,
                           float* toward_x, float* toward_y);

}  // namespace mezzotint
