#include "forward/scattering/mesh_tracing.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "forward/base/error.h"
#include "tests/forward/scattering/reliefs.h"
#include "tests/forward/tracing/meshes.h"
#include "tests/test_data.h"

namespace mezzotint {
namespace {

using namespace literals;

PathTracingOptions options_at(double theta_deg, double phi_deg, const Material& material) {
  PathTracingOptions options;
  options.incidence = {Angle::from_degrees(theta_deg), Angle::from_degrees(phi_deg)};
  options.material = material;
  options.samples = 1U << 16;
  options.grid = {32, 32};
  return options;
}

double sum_of(const EnergyAudit& e) {
  return e.reflected.value + e.transmitted.value + e.absorbed.value + e.left_sideways.value + e.cut_off.value;
}

// Both branches of the first interaction are weighted in single precision: 2^-24, where all paths round alike.
constexpr double rounding = 6e-8;

double number(const Bsdf& bsdf, const char* key) { return std::stod(bsdf.provenance.at(key)); }

struct Setting {
  double theta_deg, gradient;
  Material material;
};
class MeshAndRelief : public testing::TestWithParam<Setting> {};

TEST_P(MeshAndRelief, HaveTheSameBsdf) {
  const auto& [theta_deg, gradient, material] = GetParam();
  const HeightField field = test::random_relief(64, gradient);
  PathTracingOptions options = options_at(theta_deg, 20.0, material);
  options.samples = 1U << 18;
  options.batches = 32;
  const Bsdf relief = trace_bsdf(field, options);
  options.seed = 99;
  options.samples = 1U << 17;
  const Bsdf mesh = MeshPathTracer(to_closed_mesh(field), MeshPeriod{64.0_um, 64.0_um}).trace(options);
  // χ² over the bins that hold something, as in control_variate_test: 5 standard deviations of χ²/n, and the 7 % by
  // which the error of an error from 32 batches widens it: 1 false alarm in 10^6.
  double chi_square = 0.0, bins = 0.0;
  for (std::size_t k = 0; k < options.grid.size(); ++k) {
    if (!(mesh.reflection.mean[k] > 3.0 * mesh.reflection.standard_error[k])) continue;
    const double error = std::hypot(relief.reflection.standard_error[k], mesh.reflection.standard_error[k]);
    chi_square += std::pow((relief.reflection.mean[k] - mesh.reflection.mean[k]) / error, 2);
    bins += 1.0;
  }
  ASSERT_GT(bins, 20.0);
  EXPECT_LT(chi_square / bins, 1.07 + 5.0 * std::sqrt(2.0 / bins));
  const auto near = [](const Estimate& a, const Estimate& b) {
    return std::abs(a.value - b.value) < 4.5 * std::hypot(a.standard_error, b.standard_error) + 1e-7;
  };
  EXPECT_TRUE(near(relief.energy.reflected, mesh.energy.reflected));
  EXPECT_TRUE(near(relief.energy.transmitted, mesh.energy.transmitted));
  EXPECT_TRUE(near(relief.energy.absorbed, mesh.energy.absorbed));
  EXPECT_NEAR(sum_of(mesh.energy), 1.0, rounding);
  EXPECT_LT(number(mesh, "leaked_share"), 1e-4);
}

INSTANTIATE_TEST_SUITE_P(Reliefs, MeshAndRelief,
                         testing::Values(Setting{0.0, 0.8, Dielectric{1.5}}, Setting{60.0, 0.5, Mirror{}},
                                         Setting{75.0, 0.3, Conductor{0.2, 3.0}},
                                         Setting{30.0, 0.5, Dielectric{1.5, 0.05}}));

// A mirror plate with a level sheet of no thickness over it: everything reflects by the mirror's law, but some of the
// light goes to and fro between the two. Order by order the shares are overlaps of the sheet with itself, shifted by
// 2d, 4d …, d = h·tanθ along the light's way; on a torus they are products of overlaps along x and y.
class SheetOverPlate : public testing::Test {
protected:
  static constexpr double period = 20.0, side = 8.0, gap = 3.0;

  static TriangleMesh mesh() {
    TriangleMesh mesh;
    test::add_level(mesh, 0.0, 0.0, period, period, 0.0);
    for (const bool up : {true, false}) test::add_level(mesh, 5.0, 6.0, 5.0 + side, 6.0 + side, gap, up);
    return mesh;
  }
  // How much of a stretch of length `side` lies in all of its copies shifted by 0, s and, if asked for, 2s.
  static double overlap(double s, int copies) {
    const double shift = std::abs(std::remainder(s, period)), twice = std::abs(std::remainder(2.0 * s, period));
    if (copies == 1) return side;
    if (copies == 2) return std::max(0.0, side - shift);
    return std::max(0.0, side - std::max(shift, twice));
  }
  static double share(double shift_x, double shift_y, int copies) {
    return overlap(shift_x, copies) * overlap(shift_y, copies) / (period * period);
  }
  /// Shares of the light that leave after 1, 3 and more reflections.
  static std::array<double, 3> shares(double theta_deg, double phi_deg) {
    const double theta = theta_deg * std::numbers::pi / 180.0, phi = phi_deg * std::numbers::pi / 180.0;
    const double way = 2.0 * gap * std::tan(theta), x = way * std::cos(phi), y = way * std::sin(phi);
    const double one = share(x, y, 1), two = share(x, y, 2), three = share(x, y, 3);
    const double first = one + (1.0 - 2.0 * one + two), third = one - 2.0 * two + three;
    return {first, third, 1.0 - first - third};
  }
};

TEST_F(SheetOverPlate, SendsLightBackAfterAsManyReflectionsAsItsShadowSays) {
  for (const auto& [theta_deg, phi_deg] : {std::pair{0.0, 0.0}, {40.0, 25.0}, {60.0, 110.0}}) {
    PathTracingOptions options = options_at(theta_deg, phi_deg, Mirror{});
    options.bounce_orders = 4;
    const Bsdf bsdf = MeshPathTracer(mesh(), MeshPeriod{20.0_um, 20.0_um}).trace(options);
    const std::vector<double> areas = projected_solid_angles(options.grid);
    const auto expected = shares(theta_deg, phi_deg);
    std::array<Estimate, 4> found{};
    for (std::size_t order = 0; order < 4; ++order) {
      for (std::size_t k = 0; k < areas.size(); ++k) {
        found[order].value += areas[k] * bsdf.reflection_orders[order].mean[k];
        found[order].standard_error =
            std::hypot(found[order].standard_error, areas[k] * bsdf.reflection_orders[order].standard_error[k]);
      }
    }
    SCOPED_TRACE(theta_deg);
    // Errors from 8 batches: 8 of them leave 1 false alarm in 10^4 (Student's t with 7 degrees of freedom).
    EXPECT_NEAR(found[0].value, expected[0], 8.0 * found[0].standard_error + 1e-12);
    EXPECT_EQ(found[1].value, 0.0);
    EXPECT_NEAR(found[2].value, expected[1], 8.0 * found[2].standard_error + 1e-12);
    EXPECT_NEAR(found[3].value, expected[2], 8.0 * found[3].standard_error + 1e-12);
    EXPECT_EQ(number(bsdf, "leaked_share"), 0.0);
    EXPECT_EQ(number(bsdf, "from_behind_share"), 0.0);
    // The error is that of the strata that an edge cuts: small enough to tell the orders apart.
    EXPECT_LT(found[0].standard_error, 2e-3);
  }
}

TEST_F(SheetOverPlate, IsDarkerAsAConductorByThePowersOfItsReflectance) {
  const Conductor metal{1.5, 2.0};
  const Bsdf bsdf = MeshPathTracer(mesh(), MeshPeriod{20.0_um, 20.0_um}).trace(options_at(60.0, 110.0, metal));
  const double r = reflectance(Material{metal}, 0.5);
  const auto orders = shares(60.0, 110.0);
  // What leaves after five or more is a bound here: r^5 and less of it.
  const double low = r * orders[0] + r * r * r * orders[1], high = low + std::pow(r, 5.0) * orders[2];
  EXPECT_GT(bsdf.energy.reflected.value, low - 8.0 * bsdf.energy.reflected.standard_error);
  EXPECT_LT(bsdf.energy.reflected.value, high + 8.0 * bsdf.energy.reflected.standard_error);
  EXPECT_LT(high - low, 0.01);
}

// Upright walls, which no height field has. Unfolded at its walls, the light in a groove of width w and depth D travels
// 2D·tanθ along x; after an odd number of walls it goes back the way it came, else on.
TEST(UprightGrooves, SendLightBackAsUnfoldingSays) {
  constexpr double period = 10.0, width = 4.0, depth = 7.0;
  const TriangleMesh mesh = test::drawn_out(
      {{0.0, 0.0}, {3.0, 0.0}, {3.0, -depth}, {3.0 + width, -depth}, {3.0 + width, 0.0}, {period, 0.0}}, 10.0);
  for (const double theta_deg : {20.0, 35.0, 55.0}) {
    PathTracingOptions options = options_at(theta_deg, 0.0, Mirror{});
    const Bsdf bsdf = MeshPathTracer(mesh, MeshPeriod{10.0_um, 10.0_um}).trace(options);
    const double walls = 2.0 * depth * std::tan(theta_deg * std::numbers::pi / 180.0) / width;
    const double rest = walls - std::floor(walls);
    const double odd = std::fmod(std::floor(walls), 2.0) == 0.0 ? rest : 1.0 - rest;
    const double expected = width / period * odd;  // goes back towards the light, x > 0
    const std::vector<double> areas = projected_solid_angles(options.grid);
    double back = 0.0, error = 0.0;
    for (std::size_t k = 0; k < areas.size(); ++k) {
      if (k % 32 < 16) continue;
      back += areas[k] * bsdf.reflection.mean[k];
      error = std::hypot(error, areas[k] * bsdf.reflection.standard_error[k]);
    }
    SCOPED_TRACE(theta_deg);
    EXPECT_NEAR(back, expected, 8.0 * error);
    EXPECT_LT(error, 3e-3);
    EXPECT_LT(number(bsdf, "leaked_share"), 1e-4);
  }
}

// Two interfaces over a third.
TriangleMesh pile(double thickness) {
  TriangleMesh mesh;
  test::add_level(mesh, 0.0, 0.0, 10.0, 10.0, 0.0);
  test::add_level(mesh, 0.0, 0.0, 10.0, 10.0, 3.0 - thickness, false);
  test::add_level(mesh, 0.0, 0.0, 10.0, 10.0, 3.0);
  return mesh;
}

// Three interfaces that each reflect R of what comes, from either side: all three together 3R/(1 + 2R), since light
// goes to and fro between them in any number of ways (a pile of plates; Stokes 1862).
TEST(PileOfPlates, ReflectsAsStokesSays) {
  for (const double thickness : {1.0, 0.0}) {
    const MeshPathTracer tracer(pile(thickness), MeshPeriod{10.0_um, 10.0_um});
    for (const double theta_deg : {0.0, 50.0}) {
      const Bsdf bsdf = tracer.trace(options_at(theta_deg, 10.0, Dielectric{1.5}));
      const double r = dielectric_fresnel(std::cos(theta_deg * std::numbers::pi / 180.0), 1.5).reflectance;
      EXPECT_NEAR(bsdf.energy.reflected.value, 3.0 * r / (1.0 + 2.0 * r), 8.0 * bsdf.energy.reflected.standard_error);
      EXPECT_LT(bsdf.energy.reflected.standard_error, 1e-3);
      EXPECT_NEAR(bsdf.energy.reflected.value + bsdf.energy.transmitted.value, 1.0, rounding);
    }
  }
}

TEST(PileOfPlates, AbsorbsByTheLengthOfTheWayInside) {
  // The light crosses the plate once: T = (1 − R)³ e^(−βl) to first order in R; higher orders are within a bound of
  // 3R².
  constexpr double eta = 1.1, absorption = 0.4, theta = 50.0 * std::numbers::pi / 180.0;
  const Bsdf bsdf = MeshPathTracer(pile(1.0), MeshPeriod{10.0_um, 10.0_um})
                        .trace(options_at(50.0, 10.0, Dielectric{eta, absorption}));
  const double r = dielectric_fresnel(std::cos(theta), eta).reflectance;
  const double way = 1.0 / std::sqrt(1.0 - std::pow(std::sin(theta) / eta, 2));
  EXPECT_NEAR(bsdf.energy.transmitted.value, std::pow(1.0 - r, 3) * std::exp(-absorption * way),
              3.0 * r * r + 8.0 * bsdf.energy.transmitted.standard_error);
  EXPECT_LT(r, 0.02);
}

// A relief that leans over: waves whose crests reach beyond their own feet, in both directions.
TriangleMesh leaning_waves(double lean) {
  TriangleMesh mesh = to_closed_mesh(test::relief(32, 32, Continuation::Periodic, [](double c, double r) {
    return 3.0 * std::cos(2.0 * std::numbers::pi * c / 16.0) + 2.0 * std::cos(2.0 * std::numbers::pi * (r + c) / 32.0);
  }));
  test::bend(mesh, [lean](const test::Point& p) {
    return test::Point{p[0] + lean * p[2], p[1] + 0.3 * lean * p[2], p[2]};
  });
  return mesh;
}

TEST(MeshWhiteFurnace, AMirrorWithOverhangsSendsAllLightBack) {
  const TriangleMesh mesh = leaning_waves(1.5);
  std::size_t under = 0;
  for (const auto& [a, b, c] : mesh.triangles) {
    const auto at = [&](std::uint32_t k, std::size_t axis) { return double{mesh.vertices_um[k][axis]}; };
    under += (at(b, 0) - at(a, 0)) * (at(c, 1) - at(a, 1)) < (at(b, 1) - at(a, 1)) * (at(c, 0) - at(a, 0)) ? 1 : 0;
  }
  EXPECT_GT(under, mesh.triangles.size() / 10);  // it does hang over
  const MeshPathTracer tracer(mesh, MeshPeriod{32.0_um, 32.0_um});
  for (const double theta_deg : {0.0, 45.0, 80.0}) {
    PathTracingOptions options = options_at(theta_deg, 200.0, Mirror{});
    options.max_bounces = 4096;
    const Bsdf bsdf = tracer.trace(options);
    EXPECT_NEAR(bsdf.energy.reflected.value, 1.0, 1e-4) << theta_deg;
    EXPECT_LT(number(bsdf, "leaked_share"), 1e-4);
    EXPECT_NEAR(sum_of(bsdf.energy), 1.0, 1e-12);
    EXPECT_EQ(bsdf.provenance.count("warnings"), 0U);
  }
}

TEST(MeshWhiteFurnace, AClearOverhangLosesNothing) {
  const Bsdf bsdf =
      MeshPathTracer(leaning_waves(1.5), MeshPeriod{32.0_um, 32.0_um}).trace(options_at(45.0, 200.0, Dielectric{1.5}));
  EXPECT_LT(number(bsdf, "leaked_share"), 1e-4);
  EXPECT_NEAR(bsdf.energy.reflected.value + bsdf.energy.transmitted.value + bsdf.energy.cut_off.value, 1.0, rounding);
  EXPECT_LT(bsdf.energy.cut_off.value, 1e-3);
}

TEST(OpenMesh, HasLightLeaveItSidewaysAndTheMapsAreOfTheRest) {
  TriangleMesh plate;
  test::add_level(plate, 0.0, 0.0, 10.0, 10.0, 0.0);
  const Bsdf flat = MeshPathTracer(plate).trace(options_at(30.0, 0.0, Mirror{}));
  EXPECT_EQ(flat.energy.reflected.value, 1.0);
  // With a wall along y in its middle, lit from its front: what it sends to the plate leaves beside the plate's end.
  TriangleMesh tower = plate;
  test::add_quad(tower, {5.0, 0.0, 0.0}, {5.0, 10.0, 0.0}, {5.0, 10.0, 2.5}, {5.0, 0.0, 2.5});
  const Bsdf bsdf = MeshPathTracer(tower).trace(options_at(60.0, 0.0, Mirror{}));
  EXPECT_NEAR(sum_of(bsdf.energy), 1.0, 1e-12);
  const std::vector<double> areas = projected_solid_angles(bsdf.grid);
  double albedo = 0.0;
  for (std::size_t k = 0; k < areas.size(); ++k) albedo += areas[k] * bsdf.reflection.mean[k];
  EXPECT_GT(bsdf.energy.left_sideways.value, 0.01);
  EXPECT_NEAR(albedo, bsdf.energy.reflected.value / (1.0 - bsdf.energy.left_sideways.value), 1e-9);
}

TEST(OpenMesh, SaysThatItHasHoles) {
  TriangleMesh frame;  // 10 × 10 with a hole of 4 × 4: aimed at all of it at normal incidence, as it has no height
  test::add_level(frame, 0.0, 0.0, 10.0, 3.0, 0.0);
  test::add_level(frame, 0.0, 7.0, 10.0, 10.0, 0.0);
  test::add_level(frame, 0.0, 3.0, 3.0, 7.0, 0.0);
  test::add_level(frame, 7.0, 3.0, 10.0, 7.0, 0.0);
  const Bsdf bsdf = MeshPathTracer(frame).trace(options_at(0.0, 0.0, Mirror{}));
  // Of 4096 strata those that the hole's edges cut are random: 4·26 of them, a standard deviation of 5 rays.
  EXPECT_NEAR(number(bsdf, "missed_share"), 0.16, 0.01);
  EXPECT_NE(bsdf.provenance.at("warnings").find("holes"), std::string::npos);
  EXPECT_NEAR(bsdf.energy.left_sideways.value, 0.16, 0.002);
}

TEST(MeshPathTracer, AsksWhetherTheMeshIsOrientedOutwards) {
  const TriangleMesh inward = test::turned_round(leaning_waves(0.5));
  try {
    (void)MeshPathTracer(inward, MeshPeriod{32.0_um, 32.0_um});
    FAIL() << "taken";
  } catch (const InvalidInput& error) {
    EXPECT_NE(std::string(error.what()).find("oriented outwards"), std::string::npos);
  }
  // A quarter of a plate turned round: by as much light is lost, and it is said why.
  TriangleMesh mixed;
  test::add_level(mixed, 0.0, 0.0, 10.0, 7.5, 0.0);
  test::add_level(mixed, 0.0, 7.5, 10.0, 10.0, 0.0, false);
  const Bsdf bsdf = MeshPathTracer(mixed).trace(options_at(0.0, 0.0, Mirror{}));
  EXPECT_NEAR(number(bsdf, "from_behind_share"), 0.25, 1e-9);  // strata fit
  EXPECT_NEAR(bsdf.energy.cut_off.value, 0.25, 1e-9);
  EXPECT_NE(bsdf.provenance.at("warnings").find("from behind"), std::string::npos);
}

TEST(MeshPathTracer, GivesTheSameBitsWithAnyNumberOfThreadsAndWhenItGoesOn) {
  const TriangleMesh mesh = leaning_waves(1.5);
  const auto trace = [&](std::size_t threads, const PathTracingOptions& options) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    return MeshPathTracer(mesh, MeshPeriod{32.0_um, 32.0_um}).trace(options);
  };
  PathTracingOptions options = options_at(45.0, 200.0, Dielectric{1.5});
  options.tolerance = 1e-5;  // so that there are passes
  const Bsdf alone = trace(1, options), together = trace(4, options);
  EXPECT_EQ(alone.reflection.mean, together.reflection.mean);
  EXPECT_EQ(alone.transmission.standard_error, together.transmission.standard_error);
  const test::TemporaryFolder folder;
  options.state = folder / "state";
  options.samples = 1U << 15;
  (void)trace(2, options);
  options.samples = 1U << 16;
  EXPECT_EQ(trace(2, options).reflection.mean, alone.reflection.mean);
}

TEST(MeshPathTracer, RefusesWhatAMeshDoesNotHave) {
  const MeshPathTracer tracer(leaning_waves(0.0), MeshPeriod{32.0_um, 32.0_um});
  PathTracingOptions options = options_at(0.0, 0.0, Mirror{});
  options.normals = NormalKind::Interpolated;
  EXPECT_THROW((void)tracer.trace(options), InvalidInput);
  options = options_at(0.0, 0.0, Mirror{});
  options.estimator = Estimator::Slides;
  EXPECT_THROW((void)tracer.trace(options), InvalidInput);
  options = options_at(0.0, 0.0, Mirror{});
  options.control_variate = ControlVariate::On;
  EXPECT_THROW((void)tracer.trace(options), InvalidInput);
}

}  // namespace
}  // namespace mezzotint
