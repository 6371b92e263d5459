#include "tests/benchmark/embree_rival.h"

#include <algorithm>
#include <array>
#include <limits>

#include "forward/base/error.h"
#include "tests/benchmark/measure.h"

namespace mezzotint::benchmark {

namespace {

constexpr std::size_t packet = 16, stream = 256;
// Cells; from 1e-4 on no ray of a relief of this size meets the facet that it has left.
constexpr float near = 1e-3F;

}  // namespace

EmbreeRival::EmbreeRival(const PeriodicTile& tile, Mesh mesh)
    : tile_(tile), device_(rtcNewDevice(nullptr)), singles_(rays_per_call), packets_(rays_per_call / packet) {
  if (device_ == nullptr) throw DeviceError("Embree does not start");
  scene_ = rtcNewScene(device_);
  rtcSetSceneBuildQuality(scene_, RTC_BUILD_QUALITY_HIGH);
  const std::size_t columns = tile.columns() + 1, rows = tile.rows() + 1;
  const bool grid = mesh == Mesh::Grid;
  RTCGeometry geometry = rtcNewGeometry(device_, grid ? RTC_GEOMETRY_TYPE_GRID : RTC_GEOMETRY_TYPE_TRIANGLE);
  fill_vertices(static_cast<float*>(
      rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 12, columns * rows)));
  if (grid) {
    auto* whole = static_cast<RTCGrid*>(
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_GRID, 0, RTC_FORMAT_GRID, sizeof(RTCGrid), 1));
    *whole = {0, static_cast<unsigned>(columns), static_cast<unsigned short>(columns),
              static_cast<unsigned short>(rows)};
  } else {
    fill_triangles(static_cast<unsigned*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                                                  12, 2 * (columns - 1) * (rows - 1))));
  }
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(scene_, geometry);
  rtcReleaseGeometry(geometry);
  rtcCommitScene(scene_);
  if (rtcGetDeviceError(device_) != RTC_ERROR_NONE) throw DeviceError("Embree cannot build the relief");
}

EmbreeRival::~EmbreeRival() {
  rtcReleaseScene(scene_);
  rtcReleaseDevice(device_);
}

// From the right to the left, so that Embree's grid splits its cells along the same diagonal as ours.
void EmbreeRival::fill_vertices(float* vertex) const {
  for (std::uint32_t row = 0; row <= tile_.rows(); ++row) {
    for (std::uint32_t from_right = 0; from_right <= tile_.columns(); ++from_right) {
      const std::uint32_t column = tile_.columns() - from_right;
      *vertex++ = static_cast<float>(column - 0.5 * tile_.length_x());
      *vertex++ = static_cast<float>(row * tile_.cell_y() - 0.5 * tile_.length_y());
      *vertex++ = tile_.height(column % tile_.columns(), row % tile_.rows());
    }
  }
}

void EmbreeRival::fill_triangles(unsigned* corner) const {
  const unsigned line = tile_.columns() + 1;
  for (unsigned row = 0; row < tile_.rows(); ++row) {
    for (unsigned from_right = 0; from_right < tile_.columns(); ++from_right) {
      const unsigned right = row * line + from_right, left = right + 1;
      for (const unsigned vertex : {left, right, right + line, left, right + line, left + line}) *corner++ = vertex;
    }
  }
  // The diagonal of ours goes from the left below to the right above: corners (left, right, right + line).
}

RTCRayHit EmbreeRival::query(const RayBatch& rays, std::size_t k) const {
  RTCRayHit result{};
  result.ray.org_x = static_cast<float>(rays.cell_x[k] + double{rays.x[k]} - 0.5 * tile_.length_x());
  result.ray.org_y = static_cast<float>((rays.cell_y[k] + double{rays.y[k]}) * tile_.cell_y() - 0.5 * tile_.length_y());
  result.ray.org_z = rays.z[k];
  result.ray.tnear = near;
  result.ray.dir_x = rays.dx[k];
  result.ray.dir_y = rays.dy[k];
  result.ray.dir_z = rays.dz[k];
  result.ray.tfar = std::numeric_limits<float>::infinity();
  result.ray.mask = ~0U;
  result.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  result.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  return result;
}

void EmbreeRival::convert(const RayBatch& rays, Call call) {
  for (std::size_t k = 0; k < rays.size(); ++k) {
    const RTCRayHit one = singles_[k] = query(rays, k);
    if (call != Call::Packet) continue;
    RTCRayHit16& group = packets_[k / packet];
    const std::size_t lane = k % packet;
    group.ray.org_x[lane] = one.ray.org_x;
    group.ray.org_y[lane] = one.ray.org_y;
    group.ray.org_z[lane] = one.ray.org_z;
    group.ray.tnear[lane] = one.ray.tnear;
    group.ray.dir_x[lane] = one.ray.dir_x;
    group.ray.dir_y[lane] = one.ray.dir_y;
    group.ray.dir_z[lane] = one.ray.dir_z;
    group.ray.time[lane] = 0.0F;
    group.ray.tfar[lane] = one.ray.tfar;
    group.ray.mask[lane] = one.ray.mask;
    group.ray.flags[lane] = 0;
    group.hit.geomID[lane] = RTC_INVALID_GEOMETRY_ID;
    group.hit.instID[0][lane] = RTC_INVALID_GEOMETRY_ID;
  }
}

void EmbreeRival::trace(std::size_t count, Call call, RTCIntersectContext& context) {
  if (call == Call::One) {
    for (std::size_t k = 0; k < count; ++k) rtcIntersect1(scene_, &context, &singles_[k]);
  } else if (call == Call::Stream) {
    for (std::size_t first = 0; first < count; first += stream) {
      const auto here = static_cast<unsigned>(std::min(stream, count - first));
      rtcIntersect1M(scene_, &context, &singles_[first], here, sizeof(RTCRayHit));
    }
  } else {
    for (std::size_t first = 0; first < count; first += packet) {
      alignas(64) std::array<int, packet> valid;
      for (std::size_t lane = 0; lane < packet; ++lane) valid[lane] = first + lane < count ? -1 : 0;
      rtcIntersect16(valid.data(), scene_, &context, &packets_[first / packet]);
    }
  }
}

double EmbreeRival::seconds(const RaySet& rays, Call call, bool coherent, std::vector<float>* distances) {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = coherent ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
  double sum = 0.0;
  for (const RayBatch& batch : rays.calls) {
    convert(batch, call);
    const double before = thread_seconds();
    trace(batch.size(), call, context);
    sum += thread_seconds() - before;
    if (distances == nullptr) continue;
    for (std::size_t k = 0; k < batch.size(); ++k)
      distances->push_back(call == Call::Packet ? packets_[k / packet].ray.tfar[k % packet] : singles_[k].ray.tfar);
  }
  return sum;
}

}  // namespace mezzotint::benchmark
