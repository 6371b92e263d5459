#include "tests/stability/scene.h"

namespace mezzotint {
namespace {

using test::light_at;
using test::percent;
using test::warning;

constexpr const char* theme = "Grazing light";

TEST(GrazingLight, IsTracedWithoutLossUpTo89Point9Degrees) {
  double interactions = 0.0, lost = 0.0;
  for (const double gradient : {0.3, 0.8}) {
    const Bsdf bsdf = trace_bsdf(test::random_relief(128, gradient), light_at(89.9, Mirror{}, 13));
    // All weights are 1: the sum is exact but for the division.
    EXPECT_NEAR(bsdf.energy.reflected.value + bsdf.energy.cut_off.value, 1.0, 1e-12) << gradient;
    EXPECT_LT(bsdf.energy.cut_off.value, 1e-4) << gradient;
    interactions = test::share(bsdf, "interactions_per_path");
    lost = std::max(lost, bsdf.energy.cut_off.value);
  }
  const std::string told = test::refusal([] { (void)trace_bsdf(test::random_relief(16, 0.1), light_at(90.0)); });
  EXPECT_NE(told.find("not including, 90°"), std::string::npos);
  test::record(
      {theme, "`paths`", "light at 89.9°, RMS gradients s = 0.3 and 0.8",
       fmt::format("A mirror gives all light back ({} is lost). A ray goes {:.0f} times as far as it falls, through "
                   "many tiles; that takes long, and nothing breaks.",
                   test::below(lost), std::tan(89.9 * std::numbers::pi / 180.0)),
       "The energy audit. At 90° no light comes in, and it is refused; `mezzotint bsdf` refuses more than 89°.", told});
  EXPECT_NEAR(interactions, 1.0, 0.1);
}

// Figures of the slides' weight on other Gaussian reliefs: 0.96, 1.09, 1.96, 15.6 (docs/physics.md names two of them).
TEST(GrazingLight, GainsEnergyByTheSlidesWeight) {
  const HeightField relief = test::random_relief(128, 0.3);
  std::vector<double> albedo;
  Bsdf at_80;
  for (const double theta : {0.0, 60.0, 80.0, 89.0}) {
    PathTracingOptions options = light_at(theta);
    options.estimator = Estimator::Slides;
    const Bsdf bsdf = trace_bsdf(relief, options);
    albedo.push_back(bsdf.energy.reflected.value);
    if (theta == 80.0) at_80 = bsdf;
  }
  EXPECT_NEAR(albedo[0], 0.96, 0.01);
  EXPECT_NEAR(albedo[2], 1.96, 0.05);
  EXPECT_GT(albedo[3], 10.0);
  const std::string told = warning(at_80, "does not conserve energy");
  EXPECT_FALSE(told.empty());
  test::record({theme, "`--estimator slides`", "a mirror of s = 0.3 at 0, 60, 80 and 89°",
                fmt::format("The albedo of a lossless relief is {:.2f}, {:.2f}, {:.2f} and {:.1f}: the weight belongs "
                            "to points uniform on the microsurface, and the points are uniform in the plane.",
                            albedo[0], albedo[1], albedo[2], albedo[3]),
                "The audit does not sum to 1.", told});
}

TEST(GrazingLight, MakesSlopesAloneCreateEnergy) {
  PathTracer tracer(test::random_relief(128, 0.3));
  std::vector<double> total;
  for (const double theta : {60.0, 75.0, 80.0, 85.0}) {
    total.push_back(test::share(tracer.splat(light_at(theta)), "unadjusted_energy"));
  }
  const Bsdf at_80 = tracer.splat(light_at(80.0));
  const double off = test::difference(tracer.trace(light_at(80.0, Mirror{}, 17)), at_80);
  EXPECT_NEAR(total[2], 1.09, 0.02);  // forward/scattering/slope_splat.h: 9 % at 80°
  EXPECT_GT(total[3], 1.3);
  EXPECT_GT(off, 0.1);
  // Divided by their total, the maps hold no more light than came in.
  EXPECT_NEAR(at_80.energy.reflected.value, 1.0, 1e-12);
  const std::string told = warning(at_80, "know neither shadows");
  EXPECT_FALSE(told.empty());
  test::record({theme, "`slopes`", "a mirror of s = 0.3 at 60, 75, 80 and 85°",
                fmt::format("Facets that others would shadow shine too: {:.2f}, {:.2f}, {:.2f} and {:.2f} of the light "
                            "comes out. Divided by that, the map at 80° is still {} from the traced one (relative L2).",
                            total[0], total[1], total[2], total[3], percent(off)),
                "`unadjusted_energy` in the provenance, and the light that all facets would catch.", told});
}

TEST(GrazingLight, HidesWhatSlopesCreateBehindWhatTheyLose) {
  PathTracer tracer(test::random_relief(128, 0.8));
  const Bsdf slopes = tracer.splat(light_at(60.0));
  const double total = test::share(slopes, "unadjusted_energy");
  const double off = test::difference(tracer.trace(light_at(60.0, Mirror{}, 17)), slopes);
  EXPECT_NEAR(total, 1.0, 0.05);
  EXPECT_GT(off, 0.1);
  const std::string told = warning(slopes, "know neither shadows");
  EXPECT_FALSE(told.empty());
  test::record({theme, "`slopes`", "a mirror of s = 0.8 at 60°",
                fmt::format("The energy looks right ({:.2f}): what is created for want of shadows hides what is lost "
                            "for want of second interactions. The map is off by {}.",
                            total, percent(off)),
                "Both are measured, not their sum.", told});
}

TEST(GrazingLight, PutsItsLobeIntoBinsThatTheHorizonCuts) {
  const HeightField relief = test::random_relief(128, 0.1);
  const Bsdf coarse = trace_bsdf(relief, light_at(80.0, Dielectric{1.5}));
  PathTracingOptions options = light_at(80.0, Dielectric{1.5});
  options.grid = {256, 256};
  const Bsdf fine = trace_bsdf(relief, options);
  const std::string told = warning(coarse, "of the reflected light lies in bins that the horizon cuts");
  EXPECT_FALSE(told.empty());
  EXPECT_TRUE(warning(fine, "of the reflected light lies in bins that the horizon cuts").empty());
  // The light in them is right all the same: rim bins are divided by the part of their area that lies in the disc.
  EXPECT_NEAR(coarse.energy.reflected.value, fine.energy.reflected.value,
              5.0 * std::hypot(coarse.energy.reflected.standard_error, fine.energy.reflected.standard_error));
  test::record(
      {theme, "direction map of 64 × 64 bins", "s = 0.1, index 1.5, 80°",
       fmt::format("{} of the reflected light lies in bins that straddle the horizon. Energy is right (albedo {:.4f}, "
                   "{:.4f} at 256 × 256), but the map does not tell angles apart there.",
                   told.substr(0, told.find(" of the")), coarse.energy.reflected.value, fine.energy.reflected.value),
       "The share of the light in bins that the unit circle cuts; above 20 % it warns.", told});
}

// Standard error with the control variate, over that of a beam with as many paths; both must agree.
double error_beside_a_beam(double gradient, double theta_deg) {
  PathTracer tracer(test::random_relief(128, gradient));
  PathTracingOptions options = light_at(theta_deg, Dielectric{1.5}, 16);
  options.control_variate = ControlVariate::On;
  const Bsdf splat = tracer.trace(options);
  options.control_variate = ControlVariate::Off;
  const Bsdf beam = tracer.trace(options);
  EXPECT_NEAR(splat.energy.reflected.value, beam.energy.reflected.value,
              5.0 * std::hypot(splat.energy.reflected.standard_error, beam.energy.reflected.standard_error));
  return relative_error(splat.grid, splat.reflection) / relative_error(beam.grid, beam.reflection);
}

TEST(GrazingLight, TakesTheAdvantageFromTheControlVariate) {
  const double lower = error_beside_a_beam(0.8, 80.0), ratio = error_beside_a_beam(2.0, 89.0);
  // An error of an error from 8 batches is known to a quarter in a bin and to some 3 % over the map.
  EXPECT_LT(lower, 0.6);
  EXPECT_GT(ratio, 1.5 * lower);
  PathTracer tracer(test::random_relief(128, 2.0));
  const Bsdf automatic = tracer.trace(light_at(89.0, Dielectric{1.5}, 12));
  EXPECT_EQ(automatic.provenance.at("control_variate"), "none");
  test::record({theme, "control variate, forced on", "s = 2 at 89° (s·tanθ = 115, limit 20)",
                fmt::format("Most points lie in shadow, and few judgements hold: the standard error is {:.1f} times "
                            "that of a beam with as many "
                            "paths, for a sweep and a pilot more. The result stays unbiased.",
                            ratio),
                "The standard error says so. Nothing switches it on there unless a caller of the library forces it: "
                "the program takes the beam by itself.",
                "provenance `control_variate`: none"});
}

}  // namespace
}  // namespace mezzotint
