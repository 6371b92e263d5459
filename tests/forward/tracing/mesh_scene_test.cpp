#include "forward/tracing/mesh_scene.h"

#include <cmath>
#include <numbers>
#include <optional>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include "forward/base/error.h"
#include "forward/base/random.h"
#include "forward/tracing/height_field_tracer.h"
#include "tests/forward/scattering/reliefs.h"
#include "tests/forward/tracing/meshes.h"
#include "tests/forward/tracing/tracers.h"

namespace mezzotint {
namespace {

using namespace literals;

constexpr double period_x = 16.0, period_y = 12.0;
const MeshPeriod period = {Length::from_um(period_x), Length::from_um(period_y)};

// A rough floor, blobs over it, and crests that lean over the ends of the tile.
TriangleMesh rough_mesh() {
  const RandomStream random(5, RandomPurpose::Test);
  TriangleMesh mesh = to_closed_mesh(test::relief(16, 12, Continuation::Periodic, [&](double c, double r) {
    return 2.5 * random.uniform4(static_cast<std::uint64_t>(100.0 * c + r))[0];
  }));
  test::bend(mesh, [](const test::Point& p) { return test::Point{p[0] + 0.8 * p[2], p[1] - 0.5 * p[2], p[2]}; });
  for (std::uint64_t blob = 0; blob < 6; ++blob) {
    const auto at = random.uniform4(10000 + blob);
    const double x = 2.0 + 12.0 * at[0], y = 2.0 + 8.0 * at[1], z = 4.0 + 2.0 * at[2];
    const test::Point top{x, y, z + 1.0}, bottom{x, y, z - 1.0};
    const std::array<test::Point, 4> waist = {
        test::Point{x + 1.0, y, z}, {x, y + 1.0, z}, {x - 1.0, y, z}, {x, y - 1.0, z}};
    for (std::size_t k = 0; k < 4; ++k) {
      test::add_triangle(mesh, waist[k], waist[(k + 1) % 4], top);
      test::add_triangle(mesh, waist[(k + 1) % 4], waist[k], bottom);
    }
  }
  return mesh;
}

struct Found {
  double way;
  std::uint32_t triangle;
};

/// The mesh in its own frame, in micrometres and double: every triangle of every near copy is tried (Möller and
/// Trumbore).
class TryingAll {
public:
  TryingAll(const TriangleMesh& mesh, const SceneFrame& frame) : mesh_(mesh) {
    Eigen::Vector3d low = place(0), high = low;
    for (std::uint32_t k = 1; k < mesh.vertices_um.size(); ++k) {
      low = low.cwiseMin(place(k));
      high = high.cwiseMax(place(k));
    }
    corner_ = 0.5 * (low + high) - Eigen::Vector3d(0.5 * frame.columns * frame.unit_um,
                                                   0.5 * frame.rows * frame.cell_y * frame.unit_um, 0.0);
    unit_ = frame.unit_um;
    cell_y_ = frame.cell_y;
  }

  [[nodiscard]] Eigen::Vector3d origin(const RayBatch& rays, std::size_t k) const {
    if (rays.left[k] != no_half) return point(static_cast<std::uint32_t>(rays.cell_x[k]), rays.x[k], rays.y[k]);
    return corner_ + unit_ * Eigen::Vector3d(rays.cell_x[k] + double{rays.x[k]},
                                             (rays.cell_y[k] + double{rays.y[k]}) * cell_y_, double{rays.z[k]});
  }
  [[nodiscard]] Eigen::Vector3d point(std::uint32_t triangle, float u, float v) const {
    const auto& [a, b, c] = mesh_.triangles[triangle];
    return place(a) + double{u} * (place(b) - place(a)) + double{v} * (place(c) - place(a));
  }
  [[nodiscard]] std::optional<Found> closest(const RayBatch& rays, std::size_t k) const {
    const Eigen::Vector3d from = origin(rays, k), way(rays.dx[k], rays.dy[k], rays.dz[k]);
    std::optional<Found> best;
    for (int y = -5; y <= 5; ++y) {
      for (int x = -5; x <= 5; ++x) {
        const Eigen::Vector3d shifted = from - Eigen::Vector3d(x * period_x, y * period_y, 0.0);
        for (std::uint32_t triangle = 0; triangle < mesh_.triangles.size(); ++triangle) {
          const bool left =
              rays.left[k] != no_half && static_cast<std::uint32_t>(rays.cell_x[k]) == triangle && x == 0 && y == 0;
          if (!left) meet(triangle, shifted, way, rays.side[k], best);
        }
      }
    }
    return best;
  }

private:
  [[nodiscard]] Eigen::Vector3d place(std::uint32_t vertex) const {
    const auto& p = mesh_.vertices_um[vertex];
    return {double{p[0]}, double{p[1]}, double{p[2]}};
  }
  void meet(std::uint32_t triangle, const Eigen::Vector3d& from, const Eigen::Vector3d& way, Side side,
            std::optional<Found>& best) const {
    const auto& [a, b, c] = mesh_.triangles[triangle];
    const Eigen::Vector3d e1 = place(b) - place(a), e2 = place(c) - place(a), p = way.cross(e2);
    const double determinant = e1.dot(p);
    if (side == Side::Outside ? determinant <= 0.0 : determinant >= 0.0) return;
    const Eigen::Vector3d s = from - place(a), q = s.cross(e1);
    const double u = s.dot(p) / determinant, v = way.dot(q) / determinant, t = e2.dot(q) / determinant;
    if (u < 0.0 || v < 0.0 || u + v > 1.0 || t < -1e-6) return;
    if (!best || t < best->way) best = Found{t, triangle};
  }

  const TriangleMesh& mesh_;
  Eigen::Vector3d corner_;
  double unit_ = 1.0, cell_y_ = 1.0;
};

RayBatch beam_at(const SceneFrame& frame, std::size_t count, double theta_deg, Side side) {
  RayBatch rays(count);
  const RandomStream random(7, RandomPurpose::Test);
  const double theta = theta_deg * std::numbers::pi / 180.0;
  for (std::size_t k = 0; k < count; ++k) {
    const auto u = random.uniform4(k);
    const double phi = 2.0 * std::numbers::pi * u[2], x = u[0] * frame.columns, y = u[1] * frame.rows;
    rays.cell_x[k] = static_cast<std::int32_t>(x);
    rays.cell_y[k] = static_cast<std::int32_t>(y);
    rays.x[k] = static_cast<float>(x - rays.cell_x[k]);
    rays.y[k] = static_cast<float>(y - rays.cell_y[k]);
    rays.z[k] = static_cast<float>(side == Side::Outside ? frame.highest + 0.01 : frame.lowest - 0.01);
    rays.dx[k] = static_cast<float>(std::sin(theta) * std::cos(phi));
    rays.dy[k] = static_cast<float>(std::sin(theta) * std::sin(phi));
    rays.dz[k] = static_cast<float>((side == Side::Outside ? -1.0 : 1.0) * std::cos(theta));
    rays.side[k] = side;
    rays.left[k] = no_half;
  }
  return rays;
}

RayBatch mirrored_at(const RayBatch& rays, const HitBatch& hits) {
  RayBatch next(rays.size());
  std::size_t count = 0;
  for (std::size_t k = 0; k < rays.size(); ++k) {
    if (hits.end[k] != RayEnd::Surface) continue;
    const Direction normal(-hits.slope_x[k], -hits.slope_y[k], hits.rise[k]), way(rays.dx[k], rays.dy[k], rays.dz[k]);
    const Direction on = way - 2.0 * way.dot(normal) * normal;
    next.cell_x[count] = hits.cell_x[k];
    next.cell_y[count] = hits.cell_y[k];
    next.x[count] = hits.x[k];
    next.y[count] = hits.y[k];
    next.z[count] = hits.z[k];
    next.dx[count] = static_cast<float>(on.x());
    next.dy[count] = static_cast<float>(on.y());
    next.dz[count] = static_cast<float>(on.z());
    next.side[count] = rays.side[k];
    next.left[count++] = hits.triangle[k];
  }
  next.resize(count);
  return next;
}

TEST(MeshScene, FindsTheTriangleThatTryingAllOfThemFinds) {
  const TriangleMesh mesh = rough_mesh();
  const MeshScene scene(mesh, period);
  const TryingAll all(mesh, scene.frame());
  std::size_t met = 0, other = 0, compared = 0;
  for (const Side side : {Side::Outside, Side::Inside}) {
    RayBatch rays = beam_at(scene.frame(), 150, 60.0, side);
    for (int order = 0; order < 3; ++order) {
      HitBatch hits(rays.size());
      scene.closest_hits(rays, rays.size(), hits);
      for (std::size_t k = 0; k < rays.size(); ++k) {
        const std::optional<Found> expected = all.closest(rays, k);
        // From inside, blobs are met on their backs: such rays have gone wrong before, and are told apart.
        if (hits.end[k] == RayEnd::Behind) continue;
        ++compared;
        ASSERT_EQ(hits.end[k] == RayEnd::Surface, expected.has_value()) << "order " << order << ", ray " << k;
        if (!expected) continue;
        ++met;
        const double unit = scene.frame().unit_um;
        // Single precision over some tens of µm, at grazing incidence.
        EXPECT_NEAR(double{hits.way[k]} * unit, expected->way, 2e-4) << "order " << order << ", ray " << k;
        other += static_cast<std::uint32_t>(hits.cell_x[k]) != expected->triangle ? 1 : 0;
      }
      rays = mirrored_at(rays, hits);
    }
  }
  EXPECT_GT(met, 400U);
  EXPECT_GT(compared, 500U);
  EXPECT_LE(other, 2U);  // a ray through an edge may be given either of its triangles
}

TEST(MeshScene, MeetsAReliefRayByRayAsTheHeightFieldTracerDoes) {
  const HeightField field = test::random_relief(64, 0.8);
  const PeriodicTile tile(field);
  const HeightFieldTracer relief(tile);
  const MeshScene scene(to_closed_mesh(field), MeshPeriod{64.0_um, 64.0_um});
  for (const double theta_deg : {0.0, 45.0, 80.0}) {
    RayBatch rays = test::beam(tile, 4000, theta_deg, Side::Outside), mesh_rays = rays;
    const double scale = scene.frame().columns / 64.0;  // cells of the mesh's tile for one of the relief's
    for (std::size_t k = 0; k < rays.size(); ++k) {
      const double x = (rays.cell_x[k] + double{rays.x[k]}) * scale, y = (rays.cell_y[k] + double{rays.y[k]}) * scale;
      mesh_rays.cell_x[k] = static_cast<std::int32_t>(x);
      mesh_rays.cell_y[k] = static_cast<std::int32_t>(y);
      mesh_rays.x[k] = static_cast<float>(x - mesh_rays.cell_x[k]);
      mesh_rays.y[k] = static_cast<float>(y - mesh_rays.cell_y[k]);
      mesh_rays.z[k] = static_cast<float>(double{rays.z[k]} * scale);
    }
    std::size_t other = 0;
    for (int order = 0; order < 3; ++order) {
      HitBatch hits(rays.size()), mesh_hits(rays.size());
      relief.closest_hits(rays, rays.size(), hits);
      scene.closest_hits(mesh_rays, rays.size(), mesh_hits);
      RayBatch next(rays.size()), mesh_next(rays.size());
      std::size_t count = 0;
      const RayBatch reflected = test::reflected(rays, hits);
      for (std::size_t k = 0; k < rays.size(); ++k) {
        // The triangle, by its number in to_mesh.
        const bool same_end = hits.end[k] == mesh_hits.end[k];
        const std::int32_t triangle = 2 * (64 * hits.cell_y[k] + hits.cell_x[k]) + hits.triangle[k];
        if (!same_end || (hits.end[k] == RayEnd::Surface && triangle != mesh_hits.cell_x[k])) {
          ++other;
          continue;
        }
        if (hits.end[k] != RayEnd::Surface) continue;
        EXPECT_NEAR(double{mesh_hits.z[k]} / scale, double{hits.z[k]}, 1e-3);
        EXPECT_NEAR(double{hits.slope_x[k]}, double{mesh_hits.slope_x[k]} / double{mesh_hits.rise[k]}, 1e-5);
        EXPECT_NEAR(double{hits.slope_y[k]}, double{mesh_hits.slope_y[k]} / double{mesh_hits.rise[k]}, 1e-5);
        for (auto [from, to] : {std::pair{&reflected, &next}, {&reflected, &mesh_next}}) {
          to->dx[count] = from->dx[k];
          to->dy[count] = from->dy[k];
          to->dz[count] = from->dz[k];
          to->side[count] = Side::Outside;
        }
        const auto put = [&](RayBatch& to, const HitBatch& hit) {
          to.cell_x[count] = hit.cell_x[k];
          to.cell_y[count] = hit.cell_y[k];
          to.x[count] = hit.x[k];
          to.y[count] = hit.y[k];
          to.z[count] = hit.z[k];
          to.left[count] = hit.triangle[k];
        };
        put(next, hits);
        put(mesh_next, mesh_hits);
        ++count;
      }
      next.resize(count);
      mesh_next.resize(count);
      rays = next;
      mesh_rays = mesh_next;
      if (order == 0) {
        EXPECT_GT(count, 3990U);
      }
    }
    // Rays through an edge, or past a crest by less than single precision tells.
    EXPECT_LE(other, 12U) << theta_deg;
  }
}

TEST(MeshScene, TellsWhatMissesAPatchFromWhatPassesThroughAHole) {
  TriangleMesh frame;
  test::add_level(frame, 0.0, 0.0, 3.0, 10.0, 0.0);
  test::add_level(frame, 7.0, 0.0, 10.0, 10.0, 0.0);
  const MeshScene scene(frame);
  const double cell = 10.0 / scene.frame().columns;
  RayBatch rays(4);
  const auto set = [&](std::size_t k, double x, Side side, const Direction& way) {
    rays.cell_x[k] = static_cast<std::int32_t>(std::floor(x / cell));
    rays.x[k] = static_cast<float>(x / cell - rays.cell_x[k]);
    rays.cell_y[k] = 500;
    rays.y[k] = 0.3F;
    rays.z[k] = static_cast<float>(way.z() < 0.0 ? 1.0 : -1.0);
    rays.dx[k] = static_cast<float>(way.x());
    rays.dy[k] = static_cast<float>(way.y());
    rays.dz[k] = static_cast<float>(way.z());
    rays.side[k] = side;
  };
  set(0, 5.0, Side::Outside, {0.0, 0.0, -1.0});
  set(1, 11.0, Side::Outside, {0.0, 0.0, -1.0});
  set(2, 1.0, Side::Outside, {0.0, 0.0, -1.0});
  set(3, 1.0, Side::Outside, {0.0, 0.0, 1.0});  // from below, on its back
  HitBatch hits(4);
  scene.closest_hits(rays, 4, hits);
  EXPECT_EQ(hits.end[0], RayEnd::Below);
  EXPECT_EQ(hits.end[1], RayEnd::Sideways);
  EXPECT_EQ(hits.end[2], RayEnd::Surface);
  EXPECT_EQ(hits.end[3], RayEnd::Behind);
}

TEST(MeshScene, AimsAtTheMeanHeightSeenFromAbove) {
  TriangleMesh step;  // a plate of 10 × 10 with a third raised by 3, and a block floating over it that has a bottom
  test::add_level(step, 0.0, 0.0, 10.0, 10.0, 0.0);
  test::add_level(step, 0.0, 0.0, 5.0, 10.0, 8.0);
  test::add_level(step, 0.0, 0.0, 5.0, 10.0, 7.0, false);
  const SceneFrame frame = MeshScene(step).frame();
  // ∫z dA_z = 0 + 50·8 − 50·7 over 100; z = 0 is half-way between 0 and 8.
  EXPECT_NEAR(frame.mean * frame.unit_um, 0.5 - 4.0, 1e-6);
  EXPECT_NEAR(frame.highest * frame.unit_um, 4.0, 1e-6);
  EXPECT_EQ(frame.ends, SceneEnds::Open);
}

TEST(MeshScene, RefusesWhatIsNoPatchOrNoPeriod) {
  const auto message = [](const TriangleMesh& mesh, const std::optional<MeshPeriod>& with) -> std::string {
    try {
      const MeshScene scene(mesh, with);
      return "taken";
    } catch (const InvalidInput& error) {
      return error.what();
    }
  };
  const auto has = [&](const TriangleMesh& mesh, const std::optional<MeshPeriod>& with, const char* words) {
    const std::string text = message(mesh, with);
    EXPECT_NE(text.find(words), std::string::npos) << text;
  };
  TriangleMesh plate;
  test::add_level(plate, 0.0, 0.0, 10.0, 10.0, 0.0);
  has({}, {}, "no triangle");
  has(test::drawn_out({{0.0, 0.0}, {0.0, 5.0}}, 10.0), {}, "no extent");
  has(test::turned_round(plate), {}, "oriented outwards");
  has(plate, MeshPeriod{10.0_um, 11.0_um}, "covers 90.91 % of its period");
  has(plate, MeshPeriod{10.0_um, 40.0_um}, "does not fit a period");
  has(plate, MeshPeriod{10.0_um, -1.0_um}, "positive");
  TriangleMesh needle = plate;
  test::add_triangle(needle, {0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, {0.0, 0.0, 1e5});
  has(needle, {}, "no patch");
  EXPECT_EQ(message(plate, MeshPeriod{10.0_um, 10.0_um}), "taken");
}

}  // namespace
}  // namespace mezzotint
