#include "forward/scattering/incident_light.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "forward/base/error.h"
#include "forward/scattering/beam_rays.h"

namespace mezzotint {

namespace {

// Without a front rays start this far (cells) above the highest point.
constexpr double start_clearance = 1e-2;
constexpr std::size_t slice = 256;

}  // namespace

IncidentLight::IncidentLight(const SceneFrame& frame, const PathTracingOptions& options, const BeamFront* front)
    : frame_(frame),
      front_(front),
      to_light_(to_direction(options.incidence)),
      directions_(options.seed, RandomPurpose::IncidentDirection) {
  if (!options.spread_incidence_over_bin) return;
  const std::size_t bin = options.grid.bin_of(to_light_.x(), to_light_.y());
  const double width = 2.0 / static_cast<double>(options.grid.width);
  const double height = 2.0 / static_cast<double>(options.grid.height);
  // Directions are drawn from the pixel until one lies in the disc; a sliver would take for ever.
  require(projected_solid_angles(options.grid)[bin] > 1e-3 * width * height,
          "the bin of the incidence lies outside of the disc but for a sliver; choose an incidence farther from 90°");
  const std::size_t column = bin % options.grid.width, row = bin / options.grid.width;
  pixel_ = Pixel{static_cast<double>(column) * width - 1.0, static_cast<double>(row) * height - 1.0, width, height};
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

void IncidentLight::fill(const SampleStrata& strata, std::uint64_t first, std::uint64_t first_index, std::size_t count,
                         AimedRays& aimed) const {
  for (std::size_t begin = 0; begin < count; begin += slice) {
    const std::size_t here = std::min(slice, count - begin);
    const auto x = std::span(aimed.aim_x).subspan(begin, here), y = std::span(aimed.aim_y).subspan(begin, here);
    strata.points(first + begin, x, y);
    for (std::size_t k = 0; k < here; ++k) {
      x[k] = frame_.aimed_x + x[k] * frame_.aimed_columns;
      y[k] = frame_.aimed_y + y[k] * frame_.aimed_rows;
    }
    Beam beam{to_light_, frame_.mean, pixel_ ? nullptr : front_, static_cast<float>(frame_.highest + start_clearance)};
    if (!pixel_) {
      aim_beam(frame_, beam, x, y, begin, aimed);
      continue;
    }
    for (std::size_t k = 0; k < here; ++k) {
      beam.to_light = direction_in_pixel(first_index + begin + k);
      aim_beam(frame_, beam, x.subspan(k, 1), y.subspan(k, 1), begin + k, aimed);
    }
  }
}

bool IncidentLight::missed(const AimedRays& rays, const HitBatch& hits, std::size_t k) const {
  const RayEnd end = hits.end[k];
  if (frame_.ends == SceneEnds::Open) return end == RayEnd::Sideways || end == RayEnd::Below;
  return frame_.ends == SceneEnds::Mirrored && end == RayEnd::Surface && met_a_copy(rays, hits, k);
}

// Told by the way that its ray went.
bool IncidentLight::met_a_copy(const AimedRays& rays, const HitBatch& hits, std::size_t k) const {
  // Where the ray is at the height of the hit, in as many tiles as it took.
  const double fall = (double{hits.z[k]} - frame_.mean) / double{rays.rays.dz[k]};
  const double x = rays.aim_x[k] + fall * double{rays.rays.dx[k]};
  const double y = rays.aim_y[k] + fall * double{rays.rays.dy[k]} / frame_.cell_y;
  return x < 0.0 || y < 0.0 || x > frame_.aimed_columns || y > frame_.aimed_rows;
}

}  // namespace mezzotint
