#pragma once

#include <cstdint>
#include <optional>

#include "forward/base/random.h"
#include "forward/scattering/path_tracing.h"
#include "forward/scattering/periodic_tile.h"
#include "forward/scattering/relief_tracer.h"
#include "forward/scattering/sample_strata.h"

namespace mezzotint {

/// The first rays: aimed at stratified points of the measured part of the macrosurface (the plane of the mean
/// height), so that each carries the same share of the light.
class IncidentLight {
public:
  /// @param strata_bits  every batch has 2^strata_bits rays, one a stratum.
  /// @throws InvalidInput where the bin over which light is to be spread hardly meets the disc.
  IncidentLight(const PeriodicTile& tile, const PathTracingOptions& options, std::uint32_t strata_bits);

  [[nodiscard]] std::uint64_t rays_per_batch() const { return std::uint64_t{1} << strata_bits_; }
  /// The ray of one stratum of a batch; it starts above the relief, maybe many tiles away.
  [[nodiscard]] Ray ray(std::uint32_t batch, std::uint64_t stratum) const;
  /// The number of a ray among all of them, for the random numbers along its path.
  [[nodiscard]] std::uint64_t ray_index(std::uint32_t batch, std::uint64_t stratum) const {
    return batch * rays_per_batch() + stratum;
  }

private:
  struct Pixel {
    double left, bottom, width, height;
  };
  [[nodiscard]] Direction direction_in_pixel(std::uint64_t index) const;

  const PeriodicTile& tile_;
  std::uint32_t strata_bits_;
  SampleStrata strata_;
  Direction to_light_;
  std::optional<Pixel> pixel_;
  RandomStream positions_;
  RandomStream directions_;
};

}  // namespace mezzotint
