#include "forward/scattering/incident_light.h"

#include <cmath>

#include "forward/base/error.h"

namespace mezzotint {

namespace {

// First rays start this far (cells) above the highest point.
constexpr double start_clearance = 1e-2;

}  // namespace

IncidentLight::IncidentLight(const PeriodicTile& tile, const PathTracingOptions& options, std::uint32_t strata_bits)
    : tile_(tile),
      strata_bits_(strata_bits),
      strata_(strata_bits),
      to_light_(to_direction(options.incidence)),
      positions_(options.seed, RandomPurpose::RayPosition),
      directions_(options.seed, RandomPurpose::IncidentDirection) {
  if (!options.spread_incidence_over_bin) return;
  const std::size_t bin = options.grid.bin_of(to_light_.x(), to_light_.y());
  const double width = 2.0 / static_cast<double>(options.grid.width);
  const double height = 2.0 / static_cast<double>(options.grid.height);
  // Directions are drawn from the pixel until one lies in the disc; a sliver would take for ever.
  require(projected_solid_angles(options.grid)[bin] > 1e-3 * width * height,
          "the bin of the incidence lies outside of the disc but for a sliver; choose an incidence farther from 90°");
  pixel_ = Pixel{static_cast<double>(bin % options.grid.width) * width - 1.0,
                 static_cast<double>(bin / options.grid.width) * height - 1.0, width, height};
}

Direction IncidentLight::direction_in_pixel(std::uint64_t index) const {
  for (std::uint32_t draw = 0;; ++draw) {
    const auto random = directions_.uniform4(index, draw);
    const double x = pixel_->left + random[0] * pixel_->width;
    const double y = pixel_->bottom + random[1] * pixel_->height;
    const double z_squared = 1.0 - x * x - y * y;
    if (z_squared > 0.0) return {x, y, std::sqrt(z_squared)};
  }
}

Ray IncidentLight::ray(std::uint32_t batch, std::uint64_t stratum) const {
  const std::uint64_t index = ray_index(batch, stratum);
  const auto jitter = positions_.uniform4(index);
  const auto [u, v] = strata_.point(stratum, jitter[0], jitter[1]);
  const Eigen::Vector3d aim(u * tile_.original_length_x() - 0.5 * tile_.length_x(),
                            v * tile_.original_length_y() - 0.5 * tile_.length_y(), tile_.mean());
  const Direction to_light = pixel_ ? direction_in_pixel(index) : to_light_;
  const double way_back = (tile_.highest() + start_clearance - tile_.mean()) / to_light.z();
  return {aim + way_back * to_light, -to_light, Side::Outside, no_triangle};
}

}  // namespace mezzotint
