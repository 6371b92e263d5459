#include "forward/tracing/mesh_scene.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "forward/tracing/embree_support.h"
#include "forward/tracing/placed_mesh.h"

namespace mezzotint {

namespace {

constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();
constexpr double infinity = std::numeric_limits<double>::infinity();

// As for ReliefScene: a ray starts this far (cells, or so many times the rounding of its origin) behind its origin.
constexpr double least_start_behind = 1e-4;
constexpr double rounding_start_behind = 0x1p-22;
// Above the highest and below the lowest point by this much (cells) a ray is out.
constexpr double clearance = 1e-2;
// A ray turns back this share of a period outside of the tile, where rounding cannot reach the tile's end.
constexpr double margin = 0.25;
constexpr int most_tiles = 100000;

/// Embree's context, with what the filter needs to know; Embree hands it back by address.
struct FilterContext {
  RTCIntersectContext embree;
  Side side;
  std::uint32_t left_triangle, left_copy;
  std::array<float, 3> left_normal;  // zero for a ray that has left none
  float window;                      // what lies nearer than this may be the facet's own neighbourhood
  std::uint64_t best;
  float best_distance;
  float nearest_back;
};

// The other side of a sheet without thickness, right where a ray left it outwards. One inside has to cross it.
bool is_own_back(const FilterContext& context, float distance, float x, float y, float z) {
  constexpr float nearly_opposite = 0.98F;  // cos² of 8°
  if (distance >= context.window || context.side == Side::Inside) return false;
  const float along = x * context.left_normal[0] + y * context.left_normal[1] + z * context.left_normal[2];
  return along < 0.0F && along * along > nearly_opposite * (x * x + y * y + z * z);
}

// Embree calls this for every triangle that the ray meets no farther than the best so far.
void accept_facing_triangle(const RTCFilterFunctionNArguments* arguments) {
  auto& context = *reinterpret_cast<FilterContext*>(arguments->context);
  RTCHitN* hit = arguments->hit;
  RTCRayN* ray = arguments->ray;
  const unsigned int triangle = RTCHitN_primID(hit, 1, 0), copy = RTCHitN_instID(hit, 1, 0, 0);
  const float x = RTCHitN_Ng_x(hit, 1, 0), y = RTCHitN_Ng_y(hit, 1, 0), z = RTCHitN_Ng_z(hit, 1, 0);
  const float along = RTCRayN_dir_x(ray, 1, 0) * x + RTCRayN_dir_y(ray, 1, 0) * y + RTCRayN_dir_z(ray, 1, 0) * z;
  const float distance = RTCRayN_tfar(ray, 1, 0);
  const bool has_left = triangle == context.left_triangle && copy == context.left_copy;
  const bool looks_at_ray = context.side == Side::Outside ? along < 0.0F : along > 0.0F;
  if (!looks_at_ray && !has_left && distance > context.window)
    context.nearest_back = std::min(context.nearest_back, distance);
  // Two facets at the same distance (an edge): Embree's order depends on how its tree was built.
  const std::uint64_t number = (std::uint64_t{copy} << 32U) | triangle;
  const bool later_twin = distance == context.best_distance && number > context.best;
  if (!looks_at_ray || has_left || later_twin || is_own_back(context, distance, x, y, z)) {
    arguments->valid[0] = 0;
    return;
  }
  context.best = number;
  context.best_distance = distance;
}

struct Copy {
  std::int32_t x, y;
};

// Copies that reach into the tile or its margin.
std::vector<Copy> copies_of(const PlacedMesh& mesh) {
  if (mesh.frame.ends == SceneEnds::Open) return {{0, 0}};
  std::vector<Copy> copies;
  const auto reaches = [](int shift, double reach, double half) {
    return std::abs(2.0 * shift * half) - reach < half * (1.0 + 2.0 * margin) + 1.0;
  };
  for (std::int32_t y = -3; y <= 3; ++y)
    for (std::int32_t x = -3; x <= 3; ++x)
      if (reaches(x, mesh.reach_x, mesh.half_x) && reaches(y, mesh.reach_y, mesh.half_y)) copies.push_back({x, y});
  return copies;
}

}  // namespace

struct MeshScene::Parts : EmbreeScene {
  Parts(const TriangleMesh& given, const std::optional<MeshPeriod>& period);
  ~Parts() {
    if (one_copy != nullptr) rtcReleaseScene(one_copy);
  }
  Parts(const Parts&) = delete;
  Parts& operator=(const Parts&) = delete;

  void attach_triangles();
  void attach_copy(const Copy& copy);
  [[nodiscard]] std::uint32_t copy_number(const Copy& copy) const {
    const auto found = std::find_if(copies.begin(), copies.end(),
                                    [&](const Copy& other) { return other.x == copy.x && other.y == copy.y; });
    return found == copies.end() ? none : static_cast<std::uint32_t>(found - copies.begin());
  }

  PlacedMesh mesh;
  std::vector<Copy> copies;
  RTCScene one_copy = nullptr;
  double start_behind = least_start_behind;
};

MeshScene::Parts::Parts(const TriangleMesh& given, const std::optional<MeshPeriod>& period)
    : mesh(place_mesh(given, period)), copies(copies_of(mesh)), one_copy(make_scene()) {
  const double extent = std::max({mesh.reach_x, mesh.reach_y, mesh.half_x, mesh.half_y, mesh.frame.highest});
  start_behind = std::max(least_start_behind, rounding_start_behind * extent);
  attach_triangles();
  for (const Copy& copy : copies) attach_copy(copy);
  commit(scene);
}

void MeshScene::Parts::attach_triangles() {
  RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
  rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, mesh.vertices.data(), 0, 12,
                             mesh.vertices.size() - 1);
  rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, mesh.triangles.data(), 0, 12,
                             mesh.triangles.size());
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(one_copy, geometry);
  rtcReleaseGeometry(geometry);
  commit(one_copy);
}

void MeshScene::Parts::attach_copy(const Copy& copy) {
  const auto x = static_cast<float>(2.0 * copy.x * mesh.half_x), y = static_cast<float>(2.0 * copy.y * mesh.half_y);
  const std::array<float, 12> columns = {1, 0, 0, 0, 1, 0, 0, 0, 1, x, y, 0};
  RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_INSTANCE);
  rtcSetGeometryInstancedScene(geometry, one_copy);
  rtcSetGeometryTimeStepCount(geometry, 1);
  rtcSetGeometryTransform(geometry, 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, columns.data());
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(scene, geometry);
  rtcReleaseGeometry(geometry);
}

/// One ray on its way from tile to tile.
struct MeshScene::Walk {
  const Parts& parts;
  Eigen::Vector3d origin;
  Direction direction;
  double walked = 0.0;
  Copy left_copy{0, 0};
  FilterContext context{};
  RTCRayHit query{};

  Walk(const Parts& scene_parts, const RayBatch& rays, std::size_t k)
      : parts(scene_parts), direction(double{rays.dx[k]}, double{rays.dy[k]}, double{rays.dz[k]}) {
    const PlacedMesh& mesh = parts.mesh;
    rtcInitIntersectContext(&context.embree);
    context.embree.filter = accept_facing_triangle;
    context.side = rays.side[k];
    context.window = static_cast<float>(2.0 * parts.start_behind);
    context.left_triangle = none;
    if (rays.left[k] == no_half) {
      origin = {rays.cell_x[k] + double{rays.x[k]} - mesh.half_x,
                (rays.cell_y[k] + double{rays.y[k]}) * mesh.frame.cell_y - mesh.half_y, double{rays.z[k]}};
      return;
    }
    context.left_triangle = static_cast<std::uint32_t>(rays.cell_x[k]);
    origin = mesh.point(context.left_triangle, double{rays.x[k]}, double{rays.y[k]});
    const Direction normal = mesh.normal(context.left_triangle);
    context.left_normal = {static_cast<float>(normal.x()), static_cast<float>(normal.y()),
                           static_cast<float>(normal.z())};
  }

  [[nodiscard]] bool open() const { return parts.mesh.frame.ends == SceneEnds::Open; }

  // What lies well outside of the tile comes back, and the facet that was left with it.
  void wrap() {
    const auto back = [](double& at, double half) {
      const double slack = 0.5 * margin * 2.0 * half;
      const double tiles = std::abs(at) > half + slack ? std::floor(at / (2.0 * half) + 0.5) : 0.0;
      at -= 2.0 * half * tiles;
      return static_cast<std::int32_t>(tiles);
    };
    left_copy.x -= back(origin.x(), parts.mesh.half_x);
    left_copy.y -= back(origin.y(), parts.mesh.half_y);
    context.left_copy = parts.copy_number(left_copy);
  }

  [[nodiscard]] double way_out() const {
    const SceneFrame& frame = parts.mesh.frame;
    const double exit_height = direction.z() > 0.0 ? frame.highest + clearance : frame.lowest - clearance;
    return direction.z() == 0.0 ? infinity : std::max(0.0, (exit_height - origin.z()) / direction.z());
  }
  [[nodiscard]] double way_aside() const {
    if (open()) return infinity;
    const auto way = [](double at, double speed, double half) {
      return speed == 0.0 ? infinity : ((speed > 0.0 ? 1.0 : -1.0) * half * (1.0 + 2.0 * margin) - at) / speed;
    };
    return std::min(way(origin.x(), direction.x(), parts.mesh.half_x),
                    way(origin.y(), direction.y(), parts.mesh.half_y));
  }

  // Whether there is a triangle within `length`, from its front or its back.
  [[nodiscard]] RayEnd look(double length) {
    const Eigen::Vector3d start = origin - parts.start_behind * direction;
    query = {};
    query.ray.org_x = static_cast<float>(start.x());
    query.ray.org_y = static_cast<float>(start.y());
    query.ray.org_z = static_cast<float>(start.z());
    query.ray.dir_x = static_cast<float>(direction.x());
    query.ray.dir_y = static_cast<float>(direction.y());
    query.ray.dir_z = static_cast<float>(direction.z());
    query.ray.tfar = static_cast<float>(length + parts.start_behind);
    query.ray.mask = ~0U;
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    context.best_distance = -1.0F;
    context.nearest_back = std::numeric_limits<float>::infinity();
    rtcIntersect1(parts.scene, &context.embree, &query);
    const bool hit = query.hit.geomID != RTC_INVALID_GEOMETRY_ID;
    const float front = hit ? query.ray.tfar : std::numeric_limits<float>::infinity();
    if (context.nearest_back < front - context.window) return RayEnd::Behind;
    return hit ? RayEnd::Surface : RayEnd::Lost;
  }

  [[nodiscard]] RayEnd end_outside(double length) const {
    const Eigen::Vector3d exit = origin + length * direction;
    const bool beside =
        open() && (!(std::abs(exit.x()) <= parts.mesh.half_x) || !(std::abs(exit.y()) <= parts.mesh.half_y));
    if (beside) return RayEnd::Sideways;
    return direction.z() > 0.0 ? RayEnd::Above : RayEnd::Below;
  }

  [[nodiscard]] RayEnd go() {
    for (int tiles = 0; tiles < most_tiles; ++tiles) {
      if (!open()) wrap();
      const double out = way_out(), aside = way_aside(), length = std::min(out, aside);
      const RayEnd found = look(length);
      if (found != RayEnd::Lost) return found;
      if (out <= aside) return end_outside(out);
      origin += length * direction;
      walked += length;
      context.left_triangle = none;
      context.left_normal = {};
    }
    return RayEnd::Lost;
  }

  void store(std::size_t k, HitBatch& hits) const {
    const std::uint32_t triangle = query.hit.primID;
    const double u = std::clamp(double{query.hit.u}, 0.0, 1.0), v = std::clamp(double{query.hit.v}, 0.0, 1.0 - u);
    const Direction normal = parts.mesh.normal(triangle);
    hits.cell_x[k] = static_cast<std::int32_t>(triangle);
    hits.cell_y[k] = 0;
    hits.triangle[k] = 0;
    hits.x[k] = static_cast<float>(u);
    hits.y[k] = static_cast<float>(v);
    hits.z[k] = static_cast<float>(parts.mesh.point(triangle, u, v).z());
    hits.slope_x[k] = static_cast<float>(-normal.x());
    hits.slope_y[k] = static_cast<float>(-normal.y());
    hits.rise[k] = static_cast<float>(normal.z());
    hits.way[k] = static_cast<float>(std::max(0.0, walked + double{query.ray.tfar} - parts.start_behind));
  }
};

MeshScene::MeshScene(const TriangleMesh& mesh, const std::optional<MeshPeriod>& period)
    : parts_(std::make_unique<Parts>(mesh, period)) {}

MeshScene::~MeshScene() = default;

const SceneFrame& MeshScene::frame() const { return parts_->mesh.frame; }

void MeshScene::closest_hits(const RayBatch& rays, std::size_t count, HitBatch& hits) const {
  hits.with_mesh_arrays();
  for (std::size_t k = 0; k < count; ++k) {
    Walk walk(*parts_, rays, k);
    hits.end[k] = walk.go();
    if (hits.end[k] == RayEnd::Surface) walk.store(k, hits);
  }
}

}  // namespace mezzotint
