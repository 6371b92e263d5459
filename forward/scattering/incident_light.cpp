#include "forward/scattering/incident_light.h"

#include <array>
#include <cmath>

#include "forward/base/error.h"

namespace mezzotint {

namespace {

// Without a front rays start this far (cells) above the highest point.
constexpr double start_clearance = 1e-2;
constexpr std::size_t slice = 256;

// Rounds down; the baseline of x86-64 has no instruction for it, and a call a coordinate is a tenth of all tracing.
std::int64_t floor_of(double x) {
  const auto whole = static_cast<std::int64_t>(x);
  return whole - (x < static_cast<double>(whole) ? 1 : 0);
}

std::int32_t wrap(std::int64_t cell, std::int64_t count) {
  if (cell >= 0 && cell < count) return static_cast<std::int32_t>(cell);
  const std::int64_t rest = cell % count;
  return static_cast<std::int32_t>(rest < 0 ? rest + count : rest);
}

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

float IncidentLight::start_height(double aim_x, double aim_y) const {
  if (front_ == nullptr || pixel_) return static_cast<float>(frame_.highest + start_clearance);
  return front_->height(static_cast<std::int32_t>(aim_x), static_cast<std::int32_t>(aim_y));
}

void IncidentLight::fill(const SampleStrata& strata, std::uint64_t first, std::uint64_t first_index, std::size_t count,
                         AimedRays& aimed) const {
  RayBatch& rays = aimed.rays;
  std::array<double, slice> u{}, v{};
  Direction light = to_light_;
  double shift_x = light.x() / light.z(), shift_y = light.y() / (light.z() * frame_.cell_y);
  const bool wraps = frame_.ends != SceneEnds::Open;
  for (std::size_t begin = 0; begin < count; begin += slice) {
    const std::size_t here = std::min(slice, count - begin);
    strata.points(first + begin, std::span(u).first(here), std::span(v).first(here));
    for (std::size_t k = 0; k < here; ++k) {
      const std::size_t at = begin + k;
      if (pixel_) {
        light = direction_in_pixel(first_index + at);
        shift_x = light.x() / light.z();
        shift_y = light.y() / (light.z() * frame_.cell_y);
      }
      const double aim_x = frame_.aimed_x + u[k] * frame_.aimed_columns;
      const double aim_y = frame_.aimed_y + v[k] * frame_.aimed_rows;
      aimed.aim_x[at] = aim_x;
      aimed.aim_y[at] = aim_y;
      const float z = start_height(aim_x, aim_y);
      const double rise = double{z} - frame_.mean;
      const double x = aim_x + rise * shift_x, y = aim_y + rise * shift_y;
      const std::int64_t cell_x = floor_of(x), cell_y = floor_of(y);
      rays.x[at] = static_cast<float>(x - static_cast<double>(cell_x));
      rays.y[at] = static_cast<float>(y - static_cast<double>(cell_y));
      rays.z[at] = z;
      rays.cell_x[at] = wraps ? wrap(cell_x, frame_.columns) : static_cast<std::int32_t>(cell_x);
      rays.cell_y[at] = wraps ? wrap(cell_y, frame_.rows) : static_cast<std::int32_t>(cell_y);
      rays.dx[at] = static_cast<float>(-light.x());
      rays.dy[at] = static_cast<float>(-light.y());
      rays.dz[at] = static_cast<float>(-light.z());
      rays.side[at] = Side::Outside;
      rays.left[at] = no_half;
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
