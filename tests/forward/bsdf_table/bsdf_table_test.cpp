#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "forward/base/error.h"
#include "forward/base/random.h"
#include "tests/forward/bsdf_table/beckmann_table.h"

namespace mezzotint {
namespace {

using test::beckmann;
using test::coarse;
using test::degrees;

double difference_at(const IncidenceGrid& grid, const std::vector<Bsdf>& nodes, const Bsdf& truth, bool warp) {
  return relative_l2(truth.grid, interpolated_reflection(grid, nodes, truth.incidence, warp).mean,
                     truth.reflection.mean);
}

// The reason for the warp: between 20° and 40° a cross-fade of narrow lobes has two peaks, and neither in its place.
TEST(BsdfTable, MovesANarrowLobeWhereACrossFadeHasTwo) {
  const DirectionGrid grid;
  IncidenceGrid incidences;
  incidences.rings = {{Angle::from_degrees(20), {Angle()}, {0}}, {Angle::from_degrees(40), {Angle()}, {1}}};
  for (const double alpha : {0.05, 0.1, 0.2}) {
    const ComputeBsdf compute = beckmann({alpha, alpha, {}}, grid);
    const std::vector<Bsdf> nodes = {compute(degrees(20, 0)), compute(degrees(40, 0))};
    const Bsdf truth = compute(degrees(30, 0));
    const double warped = difference_at(incidences, nodes, truth, true);
    const double faded = difference_at(incidences, nodes, truth, false);
    std::cout << "alpha " << alpha << ": warped " << warped << ", cross-faded " << faded << '\n';
    EXPECT_LT(warped, 0.2 * faded);
  }
}

TEST(BsdfTable, ComesCloseToTheClosedFormEverywhere) {
  const BeckmannLobe lobe{0.25, 0.25, {}};
  const DirectionGrid grid{128, 128};
  const BsdfTable table = build_bsdf_table(beckmann(lobe, grid), coarse({}, 7)).table;
  for (const double theta : {0.0, 17.0, 38.0, 55.0}) {
    const DirectionAngles light = degrees(theta, 211);
    const DirectionMap seen = reflection_map(table, light, {32, 32});
    const double difference = relative_l2({32, 32}, seen, reflection_map(lobe, Mirror{}, light, {32, 32}));
    std::cout << "theta " << theta << ": " << difference << '\n';
    EXPECT_LT(difference, 0.03);
  }
  // The peak, by a look-up: a bin is a fortieth of the lobe's width across.
  const Direction light = to_direction(degrees(38, 100)), mirror = to_direction(degrees(38, -80));
  EXPECT_NEAR(evaluate(table, light, mirror).value / brdf(lobe, Mirror{}, light, mirror), 1.0, 0.03);
}

TEST(BsdfTable, HasAnAlbedoThatIsLinearBetweenItsNodes) {
  const DirectionGrid grid;
  const ComputeBsdf compute = beckmann({0.5, 0.5, {}}, grid);
  const BsdfTable table = build_bsdf_table(compute, coarse({}, 3)).table;
  const double lower = table.incidences.rings[1].theta.degrees();
  const auto at = [&](double theta) { return scattered_share(table, to_direction(degrees(theta, 70))); };
  EXPECT_NEAR(at(lower), test::albedo(grid, compute(degrees(lower, 0)).reflection.mean), 1e-7);  // floats
  EXPECT_NEAR(at(0.75 * lower + 0.25 * 85.0), 0.75 * at(lower) + 0.25 * at(85.0), 1e-12);
  EXPECT_EQ(at(88.0), at(85.0));
}

// Anisotropic, by each symmetry that a rotated elliptic lobe has: all tell the same.
TEST(BsdfTable, KnowsEveryAzimuthByItsSymmetry) {
  const BeckmannLobe lobe{0.4, 0.2, Angle::from_degrees(20)};
  const DirectionGrid grid;
  for (const SymmetryKind kind :
       {SymmetryKind::None, SymmetryKind::Point, SymmetryKind::Mirror, SymmetryKind::PointAndMirror}) {
    const std::size_t azimuths =
        static_cast<std::size_t>(std::lround(azimuth_range(kind) / 0.785)) + (range_wraps(kind) ? 0 : 1);
    const BsdfTable table = build_bsdf_table(beckmann(lobe, grid), coarse({kind, lobe.rotation}, 5, azimuths)).table;
    for (const double phi : {-170.0, -95.0, -40.0, 33.0, 120.0, 165.0}) {
      const DirectionAngles light = degrees(35, phi);
      const DirectionMap seen = reflection_map(table, light, {32, 32});
      const double difference = relative_l2({32, 32}, seen, reflection_map(lobe, Mirror{}, light, {32, 32}));
      EXPECT_LT(difference, 0.05) << static_cast<int>(kind) << " at " << phi;
    }
  }
}

TEST(BsdfTable, IsContinuousWhereTheLightCrossesAMirrorOrANode) {
  const BeckmannLobe lobe{0.4, 0.2, Angle::from_degrees(20)};
  const Direction viewer = to_direction(degrees(30, 170));
  for (const SymmetryKind kind :
       {SymmetryKind::None, SymmetryKind::Point, SymmetryKind::Mirror, SymmetryKind::PointAndMirror}) {
    // An axis that the lobe does not have: what the table makes of it is still continuous.
    const BsdfTable table =
        build_bsdf_table(beckmann(lobe, {32, 32}), coarse({kind, Angle::from_degrees(50)}, 3, 4)).table;
    const double theta = table.incidences.rings[1].theta.degrees();
    for (const double phi : {0.0, 50.0, 140.0, 180.0, 230.0, 320.0}) {
      const auto at = [&](double t, double p) { return evaluate(table, to_direction(degrees(t, p)), viewer).value; };
      EXPECT_NEAR(at(theta, phi - 1e-7), at(theta, phi + 1e-7), 1e-5);
      EXPECT_NEAR(at(theta - 1e-7, phi), at(theta + 1e-7, phi), 1e-5);
    }
  }
}

TEST(BsdfTable, HandsOnTheNoiseOfItsMaps) {
  const DirectionGrid grid{16, 16};
  const ComputeBsdf exact = beckmann({0.5, 0.5, {}}, grid);
  const ComputeBsdf noisy = [&](const DirectionAngles& light) {
    Bsdf bsdf = exact(light);
    for (double& error : bsdf.reflection.standard_error) error = 0.01;
    return bsdf;
  };
  const BsdfTable table = build_bsdf_table(noisy, coarse({SymmetryKind::None, {}}, 3, 4)).table;
  const Direction node = to_direction(table.nodes[1].incidence), viewer = to_direction(degrees(10, 30));
  EXPECT_NEAR(evaluate(table, node, viewer).standard_error, 0.01, 1e-6);
}

TEST(BsdfTable, HasNoLightBelowTheHorizonAndNoneThatIsNotStored) {
  const BsdfTable table = build_bsdf_table(beckmann({0.5, 0.5, {}}, {16, 16}), coarse({}, 3)).table;
  const Direction up = to_direction(degrees(20, 0)), down(0.6, 0.0, -0.8);
  EXPECT_EQ(evaluate(table, down, up).value, 0.0);
  EXPECT_EQ(evaluate(table, up, down).value, 0.0);
  EXPECT_EQ(pdf(table, down, up), 0.0);
  EXPECT_EQ(sample(table, down, 0.3, 0.4).pdf, 0.0);
  EXPECT_EQ(scattered_share(table, down), 0.0);
}

TEST(BsdfTable, RefusesATableThatContradictsItself) {
  BsdfTable table = build_bsdf_table(beckmann({0.5, 0.5, {}}, {8, 8}), coarse({}, 3)).table;
  EXPECT_NO_THROW(require_valid(table));
  BsdfTable wrong = table;
  std::swap(wrong.incidences.rings[0], wrong.incidences.rings[2]);
  EXPECT_THROW(require_valid(wrong), InvalidInput);
  wrong = table;
  wrong.incidences.rings[1].nodes[0] = 3;
  EXPECT_THROW(require_valid(wrong), InvalidInput);
  wrong = table;
  wrong.relative_index = 1.0;
  EXPECT_THROW(require_valid(wrong), InvalidInput);
  wrong = table;
  wrong.incidences.rings.clear();
  EXPECT_THROW(require_valid(wrong), InvalidInput);
}

}  // namespace
}  // namespace mezzotint
