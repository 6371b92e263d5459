#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "forward/base/random.h"
#include "forward/scattering/path_tracing.h"
#include "forward/scattering/sample_strata.h"
#include "forward/tracing/beam_front.h"
#include "forward/tracing/ray_batch.h"
#include "forward/tracing/scene_frame.h"

namespace mezzotint {

/// First rays, and the points of the macrosurface (in cells of the tile) at which they aim.
struct AimedRays {
  explicit AimedRays(std::size_t capacity) : rays(capacity), aim_x(capacity), aim_y(capacity) {}
  RayBatch rays;
  std::vector<double> aim_x, aim_y;
};

/// The first rays: aimed at points of the measured part of the macrosurface (the plane of the mean height), so that
/// each carries the same share of the light.
class IncidentLight {
public:
  /// @param front  where the rays of one parallel beam may start; nullptr: above the highest point.
  /// @throws InvalidInput where the bin over which light is to be spread hardly meets the disc.
  IncidentLight(const SceneFrame& frame, const PathTracingOptions& options, const BeamFront* front);

  /// The rays of strata first … first + count − 1 into `rays`; `first_index` is the number of the first among all
  /// rays of the run (for light that is spread over a bin).
  void fill(const SampleStrata& strata, std::uint64_t first, std::uint64_t first_index, std::size_t count,
            AimedRays& rays) const;
  /// Whether a first ray missed what was measured: met a mirrored copy, or went past an open patch.
  [[nodiscard]] bool missed(const AimedRays& rays, const HitBatch& hits, std::size_t k) const;
  [[nodiscard]] const Direction& to_light() const { return to_light_; }

private:
  struct Pixel {
    double left, bottom, width, height;
  };
  [[nodiscard]] Direction direction_in_pixel(std::uint64_t index) const;
  [[nodiscard]] bool met_a_copy(const AimedRays& rays, const HitBatch& hits, std::size_t k) const;

  SceneFrame frame_;
  const BeamFront* front_;
  Direction to_light_;
  std::optional<Pixel> pixel_;
  RandomStream directions_;
};

}  // namespace mezzotint
