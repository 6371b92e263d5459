#include "forward/ladder/ladder.h"

#include <cmath>

#include <gtest/gtest.h>

#include "tests/forward/scattering/reliefs.h"

namespace mezzotint {
namespace {

LadderOptions options_at(double theta_deg, double tolerance, const Material& material = Dielectric{1.5}) {
  LadderOptions options;
  options.incidence = {Angle::from_degrees(theta_deg), Angle::from_degrees(15.0)};
  options.grid = {32, 32};
  options.material = material;
  options.tolerance = tolerance;
  return options;
}

Bsdf reference(PathTracer& tracer, const LadderOptions& options) {
  PathTracingOptions tracing;
  tracing.incidence = options.incidence;
  tracing.grid = options.grid;
  tracing.material = options.material;
  tracing.samples = std::uint64_t{1} << 19;
  tracing.seed = 77;
  return tracer.trace(tracing);
}

TEST(Ladder, TakesTheSplatWhereNoFacetIsSteepEnoughToShadow) {
  const HeightField field = test::random_relief(64, 0.05);
  PathTracer tracer(field);
  Choice choice;
  const LadderOptions options = options_at(30.0, 0.01);
  const Bsdf bsdf = simulate_auto(field, tracer, options, {}, &choice);
  EXPECT_EQ(choice.rung, Rung::Slopes);
  EXPECT_EQ(bsdf.provenance.at("model"), "slopes");
  EXPECT_NEAR(bsdf.energy.reflected.value + bsdf.energy.transmitted.value, 1.0, 1e-9);
  const MapDifference off = relative_l2(options.grid, reference(tracer, options).reflection, bsdf.reflection.mean);
  EXPECT_LE(off.corrected.value, 0.01);
}

TEST(Ladder, TracesWhereTheSplatIsWrong) {
  const HeightField field = test::random_relief(64, 0.8);
  PathTracer tracer(field);
  Choice choice;
  const Bsdf bsdf = simulate_auto(field, tracer, options_at(30.0, 0.05), {}, &choice);
  EXPECT_EQ(choice.rung, Rung::Paths);
  EXPECT_LE(relative_error(bsdf.grid, bsdf.reflection), 0.05);
  EXPECT_NE(bsdf.provenance.at("choice").find("slopes: predicted error"), std::string::npos);
}

TEST(Ladder, TracesWhatHasNoSplat) {
  const HeightField field = test::random_relief(64, 0.2);
  PathTracer tracer(field);
  Choice choice;
  const Bsdf absorbing = simulate_auto(field, tracer, options_at(30.0, 0.05, Dielectric{1.5, 0.1}), {}, &choice);
  EXPECT_EQ(choice.rung, Rung::Paths);
  EXPECT_GT(absorbing.energy.absorbed.value, 0.0);
  EXPECT_NE(absorbing.provenance.at("choice").find("a medium that absorbs"), std::string::npos);
  const HeightField patch(field.grid(), Continuation::Mirrored, {field.heights_um().begin(), field.heights_um().end()});
  PathTracer patch_tracer(patch);
  const Bsdf mirrored = simulate_auto(patch, patch_tracer, options_at(30.0, 0.05), {}, &choice);
  EXPECT_EQ(choice.rung, Rung::Paths);
  EXPECT_NE(mirrored.provenance.at("choice").find("no period"), std::string::npos);
}

TEST(Ladder, TracesRidgesThatSendAllLightToTheHorizon) {
  // Symmetric ridges of slope 1 under light from above: each facet reflects along the plane, and what comes back was
  // met twice.
  const HeightField ridges = test::relief(64, 64, Continuation::Periodic,
                                          [](double x, double) { return 8.0 - std::abs(std::fmod(x, 16.0) - 8.0); });
  PathTracer tracer(ridges);
  Choice choice;
  const Bsdf bsdf = simulate_auto(ridges, tracer, options_at(0.0, 0.05, Mirror{}), {}, &choice);
  EXPECT_EQ(choice.rung, Rung::Paths);
  // A mirror's corner of 90° sends light back where it came from: to the four bins about the normal.
  const auto areas = projected_solid_angles(bsdf.grid);
  double back = 0.0;
  for (const double x : {-1e-6, 1e-6})
    for (const double y : {-1e-6, 1e-6})
      back += bsdf.reflection.mean[bsdf.grid.bin_of(x, y)] * areas[bsdf.grid.bin_of(x, y)];
  EXPECT_NEAR(back, bsdf.energy.reflected.value, 1e-9);
  EXPECT_GT(back, 0.9);
}

TEST(Ladder, ForecastsCoverTheTrueErrorOfTheSplat) {
  for (const double gradient : {0.2, 0.4, 0.6}) {
    for (const double theta : {0.0, 40.0, 60.0}) {
      const HeightField field = test::random_relief(64, gradient);
      PathTracer tracer(field);
      const LadderOptions options = options_at(theta, 1e-2, Mirror{});
      Choice choice;
      (void)simulate_auto(field, tracer, options, {}, &choice);
      PathTracingOptions tracing;
      tracing.incidence = options.incidence;
      tracing.grid = options.grid;
      tracing.material = options.material;
      const DirectionMap splat = tracer.splat(tracing).reflection.mean;
      const double error = relative_l2(options.grid, reference(tracer, options).reflection, splat).corrected.value;
      for (const Forecast& forecast : choice.forecasts) {
        // An upper bound of 95 %: two of nine may lie beyond it by a little in one run of three.
        if (forecast.rung != Rung::Slopes) continue;
        EXPECT_GE(forecast.error, 0.85 * error) << gradient << " at " << theta;
      }
    }
  }
}

TEST(Ladder, GivesTheMomentsOfAGaussianReliefTheLobeOfBeckmann) {
  const HeightField field = test::random_relief(256, 0.2);
  const Bsdf moments = bsdf_from_moments(field, options_at(0.0, 0.1, Mirror{}));
  // Beckmann α = s for isotropic slopes; its albedo at 0° is 1.0000 for α = 0.2 (table), over this grid.
  EXPECT_NEAR(moments.energy.reflected.value, 1.0, 1e-3);
}

TEST(Ladder, WarnsWhereRaysAreNoModel) {
  LadderOptions options = options_at(0.0, 0.05);
  EXPECT_TRUE(geometric_optics_warnings({0.3, 1.0, 5.0}, options).empty());      // 105 µm features, 5 µm high
  EXPECT_EQ(geometric_optics_warnings({0.03, 0.1, 0.012}, options).size(), 2U);  // 2.5 µm features, 12 nm high
  EXPECT_EQ(geometric_optics_warnings({0.0, 0.0, 0.0}, options).size(), 0U);     // a flat mirror is one for waves too
}

}  // namespace
}  // namespace mezzotint
