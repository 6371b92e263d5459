#include "forward/ladder/ladder.h"
#include "forward/pattern/pattern.h"
#include "tests/stability/scene.h"

namespace mezzotint {
namespace {

using test::light_at;
using test::percent;
using test::warning;

constexpr const char* theme = "Models";

LadderOptions ladder_at(double theta_deg, const Material& material = Mirror{}) {
  LadderOptions options;
  options.incidence = light_at(theta_deg).incidence;
  options.material = material;
  options.grid = {32, 32};
  return options;
}

double moments_to_paths(const HeightField& relief, double theta_deg, Bsdf* moments = nullptr) {
  const LadderOptions options = ladder_at(theta_deg);
  PathTracingOptions tracing = light_at(theta_deg, Mirror{}, 17);
  tracing.grid = options.grid;
  const Bsdf lobe = bsdf_from_moments(relief, options);
  if (moments != nullptr) *moments = lobe;
  return test::difference(trace_bsdf(relief, tracing), lobe);
}

HeightField waves() {
  const double unit = 2.0 * std::numbers::pi / 32.0;
  return test::relief(128, 128, Continuation::Periodic,
                      [=](double c, double r) { return 0.4 / unit * std::sin(unit * c) * std::sin(unit * r); });
}

HeightField ridges() {
  return test::relief(128, 128, Continuation::Periodic,
                      [](double c, double) { return 0.2 * std::abs(std::fmod(c, 32.0) - 16.0); });
}

TEST(Moments, AreNoModelOfSlopesThatAreNotGaussian) {
  Bsdf sines, roofs, gaussian;
  const double sine_off = moments_to_paths(waves(), 0.0, &sines), roof_off = moments_to_paths(ridges(), 0.0, &roofs);
  const double gaussian_off = moments_to_paths(test::random_relief(256, 0.2), 0.0, &gaussian);
  EXPECT_GT(sine_off, 0.3);
  EXPECT_GT(roof_off, 0.8);
  EXPECT_LT(gaussian_off, 0.2);
  const std::string told = warning(sines, "the slopes are not Gaussian");
  EXPECT_FALSE(told.empty());
  EXPECT_FALSE(warning(roofs, "the slopes are not Gaussian").empty());
  EXPECT_TRUE(warning(gaussian, "the slopes are not Gaussian").empty());
  test::record({theme, "`moments`", "ridges and sin·sin at 0°; random waves of s = 0.2 for comparison",
                fmt::format("The Beckmann lobe is off by {} on ridges (their light lies in two peaks), {} on sin·sin, "
                            "{} on random waves (relative L2).",
                            percent(roof_off), percent(sine_off), percent(gaussian_off)),
                "The kurtosis of the slopes along both axes; beyond 3 ± 0.2 it warns.", told});
}

TEST(Moments, AreOffBySecondInteractionsOnRoughRelief) {
  const double gentle = moments_to_paths(test::random_relief(256, 0.2), 60.0);
  Bsdf rough;
  const double steep = moments_to_paths(test::random_relief(256, 1.0), 60.0, &rough);
  EXPECT_GT(steep, gentle);
  EXPECT_LT(rough.energy.reflected.value, 0.95);
  const std::string told = warning(rough, "masking and shadowing take");
  EXPECT_FALSE(told.empty());
  test::record(
      {theme, "`moments`", "Gaussian slopes of s = 0.2 and 1 at 60°",
       fmt::format("Off by {} and {}. Of the light, Smith's term takes {} away at s = 1 that would be scattered again.",
                   percent(gentle), percent(steep), percent(1.0 - rough.energy.reflected.value)),
       "The light that the lobe would lose on a mirror; above 5 % it warns. `auto` never takes this rung.", told});
}

// A mirror with few, steep and narrow pits: the pilot's paths may miss them all.
HeightField rare_pits() {
  return test::relief(256, 256, Continuation::Periodic, [](double c, double r) {
    const double x = std::fmod(c, 128.0) - 64.0, y = std::fmod(r, 128.0) - 64.0;
    const double gentle =
        0.6 * std::sin(2.0 * std::numbers::pi * c / 32.0) * std::sin(2.0 * std::numbers::pi * r / 32.0);
    return gentle - 6.0 * std::exp(-(x * x + y * y) / 8.0);
  });
}

TEST(Auto, ForecastsWhatThePilotCanSee) {
  const HeightField relief = rare_pits();
  PathTracer tracer(relief);
  LadderOptions options = ladder_at(30.0);
  options.tolerance = 0.01;
  const Bsdf slopes = [&] {
    PathTracingOptions tracing = light_at(30.0);
    tracing.grid = options.grid;
    return tracer.splat(tracing);
  }();
  PathTracingOptions reference = light_at(30.0, Mirror{}, 19);
  reference.grid = options.grid;
  reference.seed = 99;
  const double off = test::difference(tracer.trace(reference), slopes);
  int covered = 0, runs = 0;
  double lowest = 1.0, highest = 0.0;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    options.seed = seed;
    Choice choice;
    (void)simulate_auto(relief, tracer, options, {}, &choice);
    const Forecast& forecast = choice.forecasts.front();
    ASSERT_EQ(forecast.rung, Rung::Slopes);
    ++runs;
    if (forecast.error >= off) ++covered;
    lowest = std::min(lowest, forecast.error);
    highest = std::max(highest, forecast.error);
  }
  // An upper bound of 95 %: below 7 of 10 there is something wrong (one run in a thousand by chance).
  EXPECT_GE(covered, 7);
  test::record(
      {theme, "`auto`", "gentle waves with a pit on 0.15 % of the area, a mirror at 30°",
       fmt::format(
           "`slopes` is off by {}. Ten pilots of 2048 paths forecast at most {} to {}, and {} of {} bounds hold.",
           percent(off), percent(lowest), percent(highest), covered, runs),
       "The pilot measures what the splat leaves out; its uncertainty is part of the forecast.",
       "provenance `choice` and `predicted_error`"});
}

TEST(Slopes, AreRefusedWhereAPatchEnds) {
  PathTracer patch(crop(test::random_relief(64, 0.2), 0, 0, 40, 40));
  const std::string told = test::refusal([&] { (void)patch.splat(light_at(30.0)); });
  EXPECT_NE(told.find("needs a periodic field"), std::string::npos);
  test::record({theme, "`slopes`", "a patch that is no period of a pattern",
                "Nothing is computed: facets of mirrored copies would shine as if they had been measured.",
                "The continuation of the height field; `auto` traces such patches.", told});
}

TEST(Rays, AreNoModelOfReliefBelowTheWavelength) {
  HeightField relief = test::random_relief(64, 0.03);
  for (float& z : relief.heights_um()) z *= 0.1F;
  PathTracer tracer(relief);
  const auto told = geometric_optics_warnings(tracer.facts(), ladder_at(0.0));
  ASSERT_FALSE(told.empty());
  const double phase = 4.0 * std::numbers::pi * tracer.facts().rms_height_um / 0.55;
  EXPECT_LT(phase, 0.2);
  test::record(
      {"Waves", "`slopes`, `single`, `paths`", "a relief of 4 nm height (Sq) at 550 nm",
       fmt::format("Rays spread all light over the lobe of the slopes; by scalar diffraction {:.3f} of it stays in the "
                   "mirror direction (exp(−(4π·Sq·cosθ/λ)²)).",
                   std::exp(-phase * phase)),
       "Feature size 2π·Sq/Sdq below ten wavelengths, or 4π·Sq·cosθ/λ below 2π (`--wavelength`).", told.back()});
}

}  // namespace
}  // namespace mezzotint
