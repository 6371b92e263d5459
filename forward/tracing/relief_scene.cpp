#include "forward/tracing/relief_scene.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "forward/tracing/embree_support.h"

namespace mezzotint {

namespace {

constexpr std::uint32_t no_triangle = std::numeric_limits<std::uint32_t>::max();

// One ray in the frame and units of PeriodicTile.
struct Ray {
  Eigen::Vector3d origin;
  Direction direction;
  Side side = Side::Outside;
  std::uint32_t left_triangle = no_triangle;  // the one that it has just left; a plane is not met twice
};

struct SurfaceHit {
  std::uint32_t triangle = no_triangle;
  double u = 0.0;  // weights of the triangle's second and third corner
  double v = 0.0;
};

// A ray starts this far (in cells, or four times the rounding of its origin to single precision) behind its
// origin, since the next facet may begin right there. What lies behind is not met by mistake: the facet
// that the ray left is excluded, and faces that look away do not count.
constexpr double least_start_behind = 1e-4;
constexpr double rounding_start_behind = 0x1p-22;
// Above the highest and below the lowest point by this much (cells) a ray is out.
constexpr double clearance = 1e-2;
// A ray turns back this far (cells) inside of the border, where rounding cannot reach its end.
constexpr double border_margin = 1.0;
// Nobody waits for a ray that crosses more tiles than this; at 89.99° a relief of 20 cells takes 250 of 512.
constexpr int most_tiles = 100000;

// Cells repeated on either side of `count`: a few, and enough that a small tile is not crossed in tiny steps.
std::uint32_t border_cells(std::uint32_t count) {
  constexpr std::uint32_t least = 4, smallest_scene = 64;
  return count + 2 * least >= smallest_scene ? least : (smallest_scene - count + 1) / 2;
}

// `index` − `border` brought back into 0 … count − 1.
std::uint32_t wrap_index(std::uint32_t index, std::uint32_t border, std::uint32_t count) {
  return (index + count - border % count) % count;
}

double wrap_position(double x, double length) { return x - length * std::floor(x / length + 0.5); }

struct Border {
  std::uint32_t x;
  std::uint32_t y;
};

/// Embree's context, with what the filter needs to know; Embree hands it back by address.
struct FilterContext {
  RTCIntersectContext embree;
  std::uint32_t excluded;
  Side side;
  std::uint32_t best;
  float best_distance;
};

// Embree calls this for every triangle that the ray meets no farther than the best so far.
void accept_facing_triangle(const RTCFilterFunctionNArguments* arguments) {
  auto* context = reinterpret_cast<FilterContext*>(arguments->context);
  RTCHitN* hit = arguments->hit;
  RTCRayN* ray = arguments->ray;
  const unsigned int triangle = RTCHitN_primID(hit, 1, 0);
  const float facing = RTCRayN_dir_x(ray, 1, 0) * RTCHitN_Ng_x(hit, 1, 0) +
                       RTCRayN_dir_y(ray, 1, 0) * RTCHitN_Ng_y(hit, 1, 0) +
                       RTCRayN_dir_z(ray, 1, 0) * RTCHitN_Ng_z(hit, 1, 0);
  const bool looks_at_ray = context->side == Side::Outside ? facing < 0.0F : facing > 0.0F;
  const float distance = RTCRayN_tfar(ray, 1, 0);
  // Two facets at the same distance (an edge): Embree's order depends on how its tree was built.
  const bool later_twin = distance == context->best_distance && triangle > context->best;
  if (!looks_at_ray || triangle == context->excluded || later_twin) {
    arguments->valid[0] = 0;
    return;
  }
  context->best = triangle;
  context->best_distance = distance;
}

}  // namespace

struct ReliefScene::Handles : EmbreeScene {
  void attach(const PeriodicTile& tile);
  void fill_vertices(const PeriodicTile& tile, float* vertex) const;
  void fill_triangles(std::uint32_t* corner) const;

  // Triangles are numbered alike in the tile and in the scene, but the scene has a border around.
  [[nodiscard]] std::uint32_t scene_triangle(std::uint32_t triangle, const PeriodicTile& tile) const {
    const std::uint32_t cell = triangle / 2, row = cell / tile.columns(), column = cell - row * tile.columns();
    return 2 * ((row + border.y) * columns + column + border.x) + triangle % 2;
  }
  [[nodiscard]] std::uint32_t tile_triangle(std::uint32_t triangle, const PeriodicTile& tile) const {
    const std::uint32_t cell = triangle / 2, row = cell / columns, column = cell - row * columns;
    return 2 * (wrap_index(row, border.y, tile.rows()) * tile.columns() +
                wrap_index(column, border.x, tile.columns())) +
           triangle % 2;
  }

  Border border{};
  std::uint32_t columns = 0;  // cells, border included
  std::uint32_t rows = 0;
  double half_x = 0.0;  // rays turn back at these sides
  double half_y = 0.0;
  double start_behind = least_start_behind;
};

void ReliefScene::Handles::fill_vertices(const PeriodicTile& tile, float* vertex) const {
  for (std::uint32_t row = 0; row <= rows; ++row) {
    for (std::uint32_t column = 0; column <= columns; ++column) {
      const double x = column - double{1} * border.x - 0.5 * tile.length_x();
      const double y = (row - double{1} * border.y) * tile.cell_y() - 0.5 * tile.length_y();
      *vertex++ = static_cast<float>(x);
      *vertex++ = static_cast<float>(y);
      *vertex++ = tile.height(wrap_index(column, border.x, tile.columns()), wrap_index(row, border.y, tile.rows()));
    }
  }
}

void ReliefScene::Handles::fill_triangles(std::uint32_t* corner) const {
  for (std::uint32_t row = 0; row < rows; ++row) {
    for (std::uint32_t column = 0; column < columns; ++column) {
      const std::uint32_t first = row * (columns + 1) + column, above = first + columns + 1;
      for (const std::uint32_t vertex : {first, first + 1, above + 1, first, above + 1, above}) *corner++ = vertex;
    }
  }
}

void ReliefScene::Handles::attach(const PeriodicTile& tile) {
  border = {border_cells(tile.columns()), border_cells(tile.rows())};
  columns = tile.columns() + 2 * border.x;
  rows = tile.rows() + 2 * border.y;
  half_x = 0.5 * tile.length_x() + border.x - border_margin;
  half_y = 0.5 * tile.length_y() + (border.y - border_margin) * tile.cell_y();
  start_behind = std::max(least_start_behind, rounding_start_behind * std::max(half_x, half_y));
  RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
  const std::size_t vertices = std::size_t{columns + 1} * (rows + 1), triangles = std::size_t{2} * columns * rows;
  void* vertex = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 12, vertices);
  void* corner = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 12, triangles);
  if (vertex != nullptr && corner != nullptr) {
    fill_vertices(tile, static_cast<float*>(vertex));
    fill_triangles(static_cast<std::uint32_t*>(corner));
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene, geometry);
  }
  rtcReleaseGeometry(geometry);
  if (vertex == nullptr || corner == nullptr) fail_embree(rtcGetDeviceError(device), "taking memory for the relief");
  commit(scene);
}

ReliefScene::ReliefScene(const PeriodicTile& tile) : tile_(tile), handles_(std::make_unique<Handles>()) {
  handles_->attach(tile);
}

ReliefScene::~ReliefScene() = default;

namespace {

// How far a ray can go before it leaves the box ±half (x, y), seen from `x` with speed `dx`.
double way_to_side(double x, double dx, double half) {
  if (dx == 0.0) return std::numeric_limits<double>::infinity();
  return ((dx > 0.0 ? half : -half) - x) / dx;
}

RTCRayHit make_query(const Eigen::Vector3d& origin, const Direction& direction, double length, double start_behind) {
  RTCRayHit query{};
  const Eigen::Vector3d start = origin - start_behind * direction;
  query.ray.org_x = static_cast<float>(start.x());
  query.ray.org_y = static_cast<float>(start.y());
  query.ray.org_z = static_cast<float>(start.z());
  query.ray.dir_x = static_cast<float>(direction.x());
  query.ray.dir_y = static_cast<float>(direction.y());
  query.ray.dir_z = static_cast<float>(direction.z());
  query.ray.tnear = 0.0F;
  query.ray.tfar = static_cast<float>(length + start_behind);
  query.ray.mask = ~0U;
  query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  return query;
}

// The next stretch of a ray: out of the scene, or to its side, where it turns back into the tile.
struct Stretch {
  double length = 0.0;
  bool leaves = false;
};

}  // namespace

struct ReliefScene::Walk {
  const PeriodicTile& tile;
  const Handles& handles;
  Eigen::Vector3d origin;
  Direction direction;
  FilterContext context{};

  Walk(const PeriodicTile& walked_tile, const Handles& scene_handles, const Ray& ray)
      : tile(walked_tile), handles(scene_handles), origin(ray.origin), direction(ray.direction) {
    rtcInitIntersectContext(&context.embree);
    context.embree.filter = accept_facing_triangle;
    context.side = ray.side;
    context.excluded = ray.left_triangle == no_triangle ? no_triangle : handles.scene_triangle(ray.left_triangle, tile);
  }

  // Only what lies well outside comes back, so that a ray starts in the copy of the triangle that it has left.
  void wrap() {
    constexpr double slack = 0.5;
    if (std::abs(origin.x()) > 0.5 * tile.length_x() + slack) origin.x() = wrap_position(origin.x(), tile.length_x());
    if (std::abs(origin.y()) > 0.5 * tile.length_y() + slack * tile.cell_y()) {
      origin.y() = wrap_position(origin.y(), tile.length_y());
    }
  }

  [[nodiscard]] Stretch next_stretch() const {
    const double exit_height = direction.z() > 0.0 ? tile.highest() + clearance : tile.lowest() - clearance;
    const double infinity = std::numeric_limits<double>::infinity();
    const double way_out = direction.z() == 0.0 ? infinity : (exit_height - origin.z()) / direction.z();
    const double way_aside = std::min(way_to_side(origin.x(), direction.x(), handles.half_x),
                                      way_to_side(origin.y(), direction.y(), handles.half_y));
    return {std::min(way_out, way_aside), way_out <= way_aside};
  }

  [[nodiscard]] bool meets_triangle(double length, SurfaceHit& hit) {
    RTCRayHit query = make_query(origin, direction, length, handles.start_behind);
    context.best = no_triangle;
    context.best_distance = -1.0F;
    rtcIntersect1(handles.scene, &context.embree, &query);
    if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return false;
    hit.triangle = handles.tile_triangle(query.hit.primID, tile);
    hit.u = std::clamp(double{query.hit.u}, 0.0, 1.0);
    hit.v = std::clamp(double{query.hit.v}, 0.0, 1.0 - hit.u);
    return true;
  }

  void advance(double length) {
    origin += length * direction;
    context.excluded = no_triangle;
  }
};

namespace {

Ray ray_of(const PeriodicTile& tile, const RayBatch& rays, std::size_t k) {
  const double x = rays.cell_x[k] + double{rays.x[k]} - 0.5 * tile.length_x();
  const double y = (rays.cell_y[k] + double{rays.y[k]}) * tile.cell_y() - 0.5 * tile.length_y();
  const auto cell =
      static_cast<std::uint32_t>(rays.cell_y[k]) * tile.columns() + static_cast<std::uint32_t>(rays.cell_x[k]);
  const std::uint32_t left = rays.left[k] == no_half ? no_triangle : 2 * cell + rays.left[k];
  return {{x, y, double{rays.z[k]}}, {rays.dx[k], rays.dy[k], rays.dz[k]}, rays.side[k], left};
}

void store(const PeriodicTile& tile, const SurfaceHit& hit, std::size_t k, HitBatch& hits) {
  const std::uint32_t cell = hit.triangle / 2, row = cell / tile.columns(), column = cell - row * tile.columns();
  const bool lower = hit.triangle % 2 == 0;
  const Direction normal = tile.geometric_normal(hit.triangle);
  hits.cell_x[k] = static_cast<std::int32_t>(column);
  hits.cell_y[k] = static_cast<std::int32_t>(row);
  hits.triangle[k] = lower ? 0 : 1;
  // Corners (0, 0), (1, 0), (1, 1) below the diagonal; (0, 0), (1, 1), (0, 1) above.
  hits.x[k] = static_cast<float>(lower ? hit.u + hit.v : hit.u);
  hits.y[k] = static_cast<float>(lower ? hit.v : hit.u + hit.v);
  hits.z[k] = static_cast<float>(tile.point(hit.triangle, hit.u, hit.v).z());
  hits.slope_x[k] = static_cast<float>(-normal.x() / normal.z());
  hits.slope_y[k] = static_cast<float>(-normal.y() / normal.z());
}

}  // namespace

void ReliefScene::closest_hits(const RayBatch& rays, std::size_t count, HitBatch& hits) const {
  for (std::size_t k = 0; k < count; ++k) {
    const Ray ray = ray_of(tile_, rays, k);
    const RayEnd out = ray.direction.z() > 0.0 ? RayEnd::Above : RayEnd::Below;
    Walk walk(tile_, *handles_, ray);
    hits.end[k] = RayEnd::Lost;
    for (int tiles = 0; tiles < most_tiles && hits.end[k] == RayEnd::Lost; ++tiles) {
      walk.wrap();
      const Stretch stretch = walk.next_stretch();
      SurfaceHit hit;
      if (stretch.length <= 0.0) {
        hits.end[k] = out;
      } else if (walk.meets_triangle(stretch.length, hit)) {
        hits.end[k] = RayEnd::Surface;
        store(tile_, hit, k, hits);
      } else if (stretch.leaves) {
        hits.end[k] = out;
      } else {
        walk.advance(stretch.length);
      }
    }
  }
}

}  // namespace mezzotint
