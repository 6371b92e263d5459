#include <gtest/gtest.h>

#include "forward/scattering/path_tracing.h"
#include "tests/forward/scattering/reliefs.h"

namespace mezzotint {
namespace {

struct Furnace {
  double gradient;
  double theta_deg;
  NormalKind normals;
};

PathTracingOptions furnace_options(double theta_deg, NormalKind normals) {
  PathTracingOptions options;
  options.incidence = {Angle::from_degrees(theta_deg), Angle::from_degrees(20.0)};
  options.material = Mirror{};
  options.normals = normals;
  options.samples = 1U << 16;
  options.max_bounces = 256;
  return options;
}

void expect_all_light_back(const Bsdf& bsdf) {
  // Not one path of 2^16 is lost: none goes through an edge by rounding, none still bounces after 256 times.
  EXPECT_NEAR(bsdf.energy.reflected.value, 1.0, 1e-6);
  EXPECT_EQ(bsdf.energy.transmitted.value, 0.0);
  EXPECT_EQ(bsdf.energy.absorbed.value, 0.0);
  EXPECT_EQ(bsdf.energy.left_sideways.value, 0.0);
  // Weights are 1 throughout, so that the sums are exact but for the division by the number of paths.
  EXPECT_NEAR(bsdf.energy.reflected.value + bsdf.energy.cut_off.value, 1.0, 1e-12);
}

class WhiteFurnace : public testing::TestWithParam<Furnace> {};

TEST_P(WhiteFurnace, AMirrorSendsAllLightBack) {
  const auto [gradient, theta_deg, normals] = GetParam();
  const Bsdf bsdf = trace_bsdf(test::random_relief(128, gradient), furnace_options(theta_deg, normals));
  expect_all_light_back(bsdf);
  RecordProperty("one_minus_albedo", std::to_string(1.0 - bsdf.energy.reflected.value));
}

std::vector<Furnace> furnaces() {
  std::vector<Furnace> all;
  for (const double gradient : {0.1, 0.3, 0.8, 1.0}) {
    for (const double theta_deg : {0.0, 30.0, 60.0, 80.0, 89.0}) {
      for (const NormalKind normals : {NormalKind::Geometric, NormalKind::Interpolated}) {
        all.push_back({gradient, theta_deg, normals});
      }
    }
  }
  return all;
}

INSTANTIATE_TEST_SUITE_P(Reliefs, WhiteFurnace, testing::ValuesIn(furnaces()), [](const auto& furnace_case) {
  const Furnace& furnace = furnace_case.param;
  return "Gradient" + std::to_string(std::lround(100.0 * furnace.gradient)) + "Theta" +
         std::to_string(std::lround(furnace.theta_deg)) +
         (furnace.normals == NormalKind::Geometric ? "Geometric" : "Interpolated");
});

TEST(WhiteFurnaceReliefs, HoldTheGradientThatTheyAreNamedAfter) {
  // Scaled to it; heights are stored in single precision.
  EXPECT_NEAR(test::rms_gradient(test::random_relief(128, 0.8)), 0.8, 1e-5);
}

TEST(WhiteFurnaceReliefs, MeetLightMoreThanOnceWhereTheyAreSteep) {
  // Without this the furnace would test nothing: 20 % of the light bounces twice at s = 0.7 (forward-limits.md).
  PathTracingOptions options = furnace_options(0.0, NormalKind::Geometric);
  options.max_bounces = 1;
  const Bsdf bsdf = trace_bsdf(test::random_relief(128, 0.8), options);
  EXPECT_GT(bsdf.energy.cut_off.value, 0.1);
  EXPECT_NEAR(bsdf.energy.reflected.value + bsdf.energy.cut_off.value, 1.0, 1e-12);
}

TEST(WhiteFurnaceReliefs, MayHaveOblongCellsAndTinyTiles) {
  const HeightField oblong = test::relief(
      24, 3, Continuation::Periodic,
      [](double c, double r) { return 1.5 * std::cos(c * 0.2618) + 0.3 * r * (r - 2.0); }, 2.5);
  const HeightField tiny = test::relief(2, 2, Continuation::Periodic, [](double c, double r) { return 0.5 * c * r; });
  for (const double theta_deg : {0.0, 60.0, 89.0}) {
    expect_all_light_back(trace_bsdf(oblong, furnace_options(theta_deg, NormalKind::Geometric)));
    expect_all_light_back(trace_bsdf(tiny, furnace_options(theta_deg, NormalKind::Geometric)));
  }
}

TEST(WhiteFurnaceReliefs, GiveBackAllThatMetAMirroredPatch) {
  HeightField patch = test::random_relief(64, 0.5);
  patch = crop(patch, 3, 5, 50, 40);
  for (const NormalKind normals : {NormalKind::Geometric, NormalKind::Interpolated}) {
    const Bsdf bsdf = trace_bsdf(patch, furnace_options(70.0, normals));
    EXPECT_GT(bsdf.energy.left_sideways.value, 0.01);  // a patch this rough shades its own border
    EXPECT_LT(bsdf.energy.cut_off.value, 1e-4);        // as above
    const auto areas = projected_solid_angles(bsdf.grid);
    double albedo = 0.0;
    for (std::size_t k = 0; k < areas.size(); ++k) albedo += bsdf.reflection.mean[k] * areas[k];
    // The maps are normalised by the light that met the patch; 4096 terms, each rounded once.
    EXPECT_NEAR(albedo, 1.0 - bsdf.energy.cut_off.value / (1.0 - bsdf.energy.left_sideways.value), 1e-12);
  }
}

}  // namespace
}  // namespace mezzotint
