#include "forward/ladder/ladder.h"
#include "tests/stability/scene.h"

namespace mezzotint {
namespace {

using test::light_at;
using test::percent;
using test::warning;

constexpr const char* theme = "Steep relief";

TEST(SteepRelief, IsTracedWithoutLossUpToAnRmsGradientOfTwo) {
  const HeightField relief = test::random_relief(128, 2.0);
  double lost = 0.0, interactions = 0.0;
  for (const double theta : {0.0, 60.0, 80.0}) {
    const Bsdf mirror = trace_bsdf(relief, light_at(theta));
    EXPECT_NEAR(mirror.energy.reflected.value + mirror.energy.cut_off.value, 1.0, 1e-9) << theta;
    EXPECT_LT(mirror.energy.cut_off.value, 1e-4) << theta;
    lost = std::max(lost, mirror.energy.cut_off.value);
    interactions = std::max(interactions, test::share(mirror, "interactions_per_path"));
    const Bsdf clear = trace_bsdf(relief, light_at(theta, Dielectric{1.5}));
    EXPECT_NEAR(test::accounted_for(clear), 1.0, 1e-8) << theta;  // weights in single precision
  }
  EXPECT_GT(interactions, 2.0);
  test::record({theme, "`paths`", "s = 2 (facets of some 63°), light at 0, 60 and 80°",
                fmt::format("Up to {:.1f} interactions a path; a mirror gives all light back ({} is lost), and with a "
                            "dielectric all light is accounted for within 1e-8. It holds.",
                            interactions, test::below(lost)),
                "The energy audit.", "—"});
}

TEST(SteepRelief, LosesLightAtTheBounceCap) {
  PathTracingOptions options = light_at(0.0, Mirror{}, 18);
  options.max_bounces = 4;
  options.grid = {16, 16};  // so that the stated error is small against what is cut off
  const Bsdf bsdf = trace_bsdf(test::random_relief(128, 2.0), options);
  EXPECT_GT(bsdf.energy.cut_off.value, 0.03);
  EXPECT_NEAR(test::accounted_for(bsdf), 1.0, 1e-9);
  const std::string told = warning(bsdf, "was cut off after 4 interactions");
  EXPECT_FALSE(told.empty());
  test::record(
      {theme, "bounce cap (`--max-bounces`)", "4 interactions, a mirror of s = 2 at 0°",
       fmt::format("{} of the light is still on its way and stands in no map.", percent(bsdf.energy.cut_off.value)),
       "`cut_off` in the audit; it warns where that exceeds the stated error.", told});
}

TEST(SteepRelief, LosesLightThatSingleScatteringLeavesOut) {
  PathTracingOptions options = light_at(0.0, Mirror{}, 18);
  options.max_bounces = 1;
  options.grid = {16, 16};
  const Bsdf bsdf = trace_bsdf(test::random_relief(128, 1.0), options);
  EXPECT_GT(bsdf.energy.cut_off.value, 0.3);
  const std::string told = warning(bsdf, "meets the surface again");
  EXPECT_FALSE(told.empty());
  test::record({theme, "`single`", "a mirror of s = 1 at 0°",
                fmt::format("{} of the light meets the surface again.", percent(bsdf.energy.cut_off.value)),
                "`cut_off` in the audit; it warns where that exceeds the stated error.", told});
}

HeightField blocks(double height_um) {
  return test::relief(64, 64, Continuation::Periodic, [height_um](double c, double r) {
    return (static_cast<int>(c) / 16 + static_cast<int>(r) / 16) % 2 != 0 ? height_um : 0.0;
  });
}

TEST(SteepRelief, MakesWellsOfVerticalSteps) {
  const Bsdf bsdf = trace_bsdf(blocks(1e4), light_at(60.0, Mirror{}, 13));
  EXPECT_NEAR(test::accounted_for(bsdf), 1.0, 1e-9);
  EXPECT_GT(bsdf.energy.cut_off.value, 0.3);
  EXPECT_LT(test::share(bsdf, "leaked_share"), 1e-4);
  const std::string told = warning(bsdf, "was cut off after 64 interactions");
  EXPECT_FALSE(told.empty());
  EXPECT_FALSE(warning(bsdf, "changes from sample to sample").empty());
  test::record({theme, "`paths`", "vertical steps: blocks of 16 × 16 samples, walls with a slope of 10 000, 60°",
                fmt::format("{} of the light is still in the wells after 64 interactions. Nothing leaks through the "
                            "walls (leaked_share {}).",
                            percent(bsdf.energy.cut_off.value), bsdf.provenance.at("leaked_share")),
                "`cut_off`, and slopes that change from sample to sample.", told});
}

TEST(SteepRelief, IsWiderWhereStepsAreSampledCoarsely) {
  const HeightField steps = blocks(1.0);
  HeightField fine = test::relief(128, 128, Continuation::Periodic, [](double c, double r) {
    return (static_cast<int>(c) / 32 + static_cast<int>(r) / 32) % 2 != 0 ? 2.0 : 0.0;  // the same, in finer samples
  });
  const double coarse_gradient = test::rms_gradient(steps), fine_gradient = test::rms_gradient(fine);
  EXPECT_NEAR(fine_gradient / coarse_gradient, std::numbers::sqrt2, 0.05);
  const std::string told = warning(trace_bsdf(steps, light_at(30.0)), "changes from sample to sample");
  EXPECT_FALSE(told.empty());
  test::record({theme, "height field", "steps, sampled twice as finely",
                fmt::format("The RMS gradient goes from {:.3f} to {:.3f} (√2): a wall is one sample wide whatever the "
                            "pitch, and no pitch is fine enough.",
                            coarse_gradient, fine_gradient),
                "The variance of the slopes over two samples against that over one.", told});
}

// 45° facets and light at 30°: all of it goes down after its first reflection. The audit divided by that light once.
TEST(SteepRelief, CanSendNoLightStraightOut) {
  const HeightField relief = test::relief(64, 64, Continuation::Periodic, [](double c, double r) {
    return (static_cast<int>(c) + static_cast<int>(r)) % 2 != 0 ? 1.0 : 0.0;
  });
  PathTracer tracer(relief);
  LadderOptions options;
  options.incidence = light_at(30.0).incidence;
  options.material = Mirror{};
  options.tolerance = 0.1;
  Choice choice;
  const Bsdf bsdf = simulate_auto(relief, tracer, options, {}, &choice);
  EXPECT_EQ(choice.rung, Rung::Paths);
  EXPECT_NEAR(bsdf.energy.reflected.value, 1.0, 1e-4);
  const Bsdf slopes = tracer.splat(light_at(30.0));
  EXPECT_EQ(slopes.energy.reflected.value, 0.0);
  EXPECT_EQ(slopes.energy.cut_off.value, 1.0);
  const std::string told = choice.forecasts.front().reason;
  EXPECT_NE(told.find("no facet reflects light upward by itself"), std::string::npos);
  test::record({theme, "`slopes` and the control variate", "a mirror of 45° pyramids, one sample each, at 30°",
                fmt::format("No facet sends light straight out: the splat is empty, and there is nothing to correct. "
                            "The paths alone give an albedo of {:.5f}.",
                            bsdf.energy.reflected.value),
                "The splat's share of the light: below 10 % the beam is traced without it.", told});
}

TEST(SteepRelief, IsTheSameForEmbree) {
  const HeightField relief = test::random_relief(128, 2.0);
  double lost = 0.0, largest = 0.0;
  for (const double theta : {0.0, 89.0}) {
    PathTracingOptions options = light_at(theta, Mirror{}, 14);
    options.control_variate = ControlVariate::Off;
    options.grid = {16, 16};
    const Bsdf own = trace_bsdf(relief, options);
    options.tracer = TracerKind::Embree;
    const Bsdf embree = trace_bsdf(relief, options);
    lost = std::max({lost, test::share(own, "leaked_share"), test::share(embree, "leaked_share")});
    largest = std::max(largest, relative_l2(own.grid, own.reflection.mean, embree.reflection.mean));
  }
  EXPECT_LT(lost, 1e-3);
  // The same samples: only rays that meet an edge may part.
  EXPECT_LT(largest, 0.02);
  test::record({theme, "`--tracer embree`", "s = 2 at 0 and 89°, the same rays as the height-field tracer",
                fmt::format("Of the light, {} is lost at edges by either; the maps of the same rays differ by {}.",
                            test::below(lost), largest == 0.0 ? "nothing" : percent(largest)),
                "`leaked_share`; above 1e-4 it warns.", "—"});
}

}  // namespace
}  // namespace mezzotint
