#include <cmath>
#include <map>

#include <gtest/gtest.h>

#include "forward/base/error.h"
#include "forward/base/random.h"
#include "tests/forward/bsdf_table/beckmann_table.h"

namespace mezzotint {
namespace {

using test::beckmann;
using test::coarse;
using test::degrees;

// Adds noise of so much of the map's mean value to every bin, as path tracing would: another for every incidence.
ComputeBsdf noisy(const ComputeBsdf& compute, double share) {
  return [=](const DirectionAngles& light) {
    Bsdf bsdf = compute(light);
    const auto seed = static_cast<std::uint64_t>(std::lround(1e6 * light.theta.radians() + 1e9 * light.phi.radians()));
    const RandomStream stream(seed, RandomPurpose::Test);
    const double noise = share * bsdf.energy.reflected.value / 3.14;
    for (std::size_t k = 0; k < bsdf.grid.size(); ++k) {
      const auto normal = stream.normal4(k);
      bsdf.reflection.half_a[k] += noise * std::sqrt(2.0) * normal[0];
      bsdf.reflection.half_b[k] += noise * std::sqrt(2.0) * normal[1];
      bsdf.reflection.mean[k] = 0.5 * (bsdf.reflection.half_a[k] + bsdf.reflection.half_b[k]);
      bsdf.reflection.standard_error[k] = noise;
    }
    return bsdf;
  };
}

BsdfTableOptions refined(double tolerance, std::size_t budget) {
  BsdfTableOptions options;
  options.largest_theta = Angle::from_degrees(75);
  options.tolerance = tolerance;
  options.most_incidences = budget;
  return options;
}

TEST(BuildBsdfTable, RefinesUntilTheToleranceIsMetBetweenTheNodes) {
  const BeckmannLobe lobe{0.3, 0.3, {}};
  const DirectionGrid grid{48, 48};
  for (const double tolerance : {0.1, 0.03}) {
    const BuiltBsdfTable built = build_bsdf_table(beckmann(lobe, grid), refined(tolerance, 64));
    std::cout << "tolerance " << tolerance << ": " << built.report.incidences << " incidences, largest difference "
              << built.report.largest_difference << ", squares " << built.report.squares << " of " << built.report.bins
              << '\n';
    EXPECT_TRUE(built.report.met);
    EXPECT_LE(built.report.largest_difference, tolerance);
    for (double theta = 2.0; theta < 75.0; theta += 14.6) {
      const DirectionMap truth = reflection_map(lobe, Mirror{}, degrees(theta, 0), grid);
      const double seen = relative_l2(grid, reflection_map(built.table, degrees(theta, 0), grid), truth);
      EXPECT_LT(seen, tolerance + 0.01) << theta;  // and that of joining bins
    }
  }
}

TEST(BuildBsdfTable, SpendsItsNodesWhereTheBsdfChanges) {
  const BuiltBsdfTable built = build_bsdf_table(beckmann({0.3, 0.3, {}}, {48, 48}), refined(0.03, 64));
  std::size_t below_40 = 0, above_40 = 0;
  for (const BsdfTableNode& node : built.table.nodes) ++(node.incidence.theta.degrees() < 40.0 ? below_40 : above_40);
  EXPECT_GT(above_40, below_40);
}

TEST(BuildBsdfTable, StaysWithinItsBudgetAndSaysWhatIsLeft) {
  const BsdfTableOptions options = refined(1e-3, 9);
  const BuiltBsdfTable built = build_bsdf_table(beckmann({0.3, 0.3, {}}, {32, 32}), options);
  EXPECT_EQ(built.report.incidences, 9U);
  EXPECT_FALSE(built.report.met);
  EXPECT_GT(built.report.untried, 0U);
  EXPECT_GT(built.report.largest_difference, 1e-3);
}

TEST(BuildBsdfTable, AddsAzimuthsWhereTheLobeIsAnisotropic) {
  const BeckmannLobe lobe{0.5, 0.1, Angle::from_degrees(20)};
  BsdfTableOptions options = refined(0.05, 40);
  options.symmetry = {SymmetryKind::PointAndMirror, lobe.rotation};
  options.coarse_rings = 3;
  options.coarse_azimuths = 2;
  const BuiltBsdfTable built = build_bsdf_table(beckmann(lobe, {32, 32}), options);
  EXPECT_LE(built.report.incidences, 40U);
  std::size_t most = 0;
  for (const IncidenceRing& ring : built.table.incidences.rings) most = std::max(most, ring.nodes.size());
  EXPECT_GT(most, 2U);
  EXPECT_EQ(built.table.incidences.rings.front().nodes.size(), 1U);
}

TEST(BuildBsdfTable, DoesNotRefineNoise) {
  const BuiltBsdfTable exact = build_bsdf_table(beckmann({0.4, 0.4, {}}, {32, 32}), refined(0.05, 64));
  const BuiltBsdfTable traced = build_bsdf_table(noisy(beckmann({0.4, 0.4, {}}, {32, 32}), 0.2), refined(0.05, 64));
  // Noise of .1 and more of the map in relative_l2, twice the tolerance; not a node more for it than chance.
  EXPECT_LE(traced.report.incidences, exact.report.incidences + 4);
  EXPECT_GE(traced.report.incidences + 4, exact.report.incidences);
}

TEST(BuildBsdfTable, GoesOnWhereAnEarlierRunEnded) {
  std::map<double, Bsdf> kept;
  const ComputeBsdf lobe = beckmann({0.3, 0.3, {}}, {32, 32});
  const ComputeBsdf compute = [&](const DirectionAngles& light) { return kept[light.theta.radians()] = lobe(light); };
  const FindBsdf find = [&](const DirectionAngles& light) -> std::optional<Bsdf> {
    const auto found = kept.find(light.theta.radians());
    return found == kept.end() ? std::nullopt : std::optional(found->second);
  };
  const BsdfTableOptions options = refined(0.05, 30);
  const BuiltBsdfTable whole = build_bsdf_table(lobe, options);
  const Progress stop_at_five = [&](const ProgressEvent&) {
    if (kept.size() == 5) throw Interrupted();
  };
  EXPECT_THROW((void)build_bsdf_table(compute, options, stop_at_five, find), Interrupted);
  EXPECT_EQ(kept.size(), 5U);
  const BuiltBsdfTable resumed = build_bsdf_table(compute, options, {}, find);
  EXPECT_EQ(resumed.report.computed, whole.report.computed - 5);
  ASSERT_EQ(resumed.table.nodes.size(), whole.table.nodes.size());
  const Direction light = to_direction(degrees(33, 10)), viewer = to_direction(degrees(20, 200));
  EXPECT_EQ(evaluate(resumed.table, light, viewer).value, evaluate(whole.table, light, viewer).value);
}

TEST(BuildBsdfTable, MakesIsotropicMapsMirrorSymmetric) {
  const BuiltBsdfTable built = build_bsdf_table(noisy(beckmann({0.4, 0.4, {}}, {32, 32}), 0.2), coarse({}, 3));
  const Direction light = to_direction(degrees(40, 0));
  EXPECT_NEAR(evaluate(built.table, light, to_direction(degrees(30, 150))).value,
              evaluate(built.table, light, to_direction(degrees(30, -150))).value, 1e-12);
}

TEST(BuildBsdfTable, RefusesOptionsAndAnswersThatMakeNoSense) {
  const ComputeBsdf lobe = beckmann({0.3, 0.3, {}}, {8, 8});
  const auto refuses = [&](auto change) {
    BsdfTableOptions options;
    change(options);
    EXPECT_THROW((void)build_bsdf_table(lobe, options), InvalidInput);
  };
  refuses([](BsdfTableOptions& o) { o.largest_theta = Angle::from_degrees(90); });
  refuses([](BsdfTableOptions& o) { o.coarse_rings = 1; });
  refuses([](BsdfTableOptions& o) { o.most_incidences = 3; });
  refuses([](BsdfTableOptions& o) { o.tolerance = 0.0; });
  refuses([](BsdfTableOptions& o) { o.join_tolerance = 1.0; });
  refuses([](BsdfTableOptions& o) { o.relative_index = 1.0; });
  const ComputeBsdf elsewhere = [&](const DirectionAngles&) { return lobe(degrees(10, 10)); };
  EXPECT_THROW((void)build_bsdf_table(elsewhere, {}), InvalidInput);
  std::size_t side = 8;
  const ComputeBsdf growing = [&](const DirectionAngles& light) {
    return beckmann({0.3, 0.3, {}}, {side, side++})(light);
  };
  EXPECT_THROW((void)build_bsdf_table(growing, {}), InvalidInput);
  EXPECT_THROW((void)build_bsdf_table({}, {}), InvalidInput);
}

}  // namespace
}  // namespace mezzotint
