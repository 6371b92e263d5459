#include <gtest/gtest.h>
#include <cmath>

#include "forward/scattering/path_tracing.h"
#include "tests/forward/scattering/reliefs.h"

namespace mezzotint {
namespace {

// Directions and weights of paths are single; Fresnel's derivative at 89.5° raises 6e-8 to 2e-7.
constexpr double single = 3e-7;

HeightField flat(Continuation continuation = Continuation::Periodic) {
  return test::relief(16, 12, continuation, [](double, double) { return 3.0; });
}

PathTracingOptions options_at(double theta_deg, double phi_deg, const Material& material) {
  PathTracingOptions options;
  options.incidence = {Angle::from_degrees(theta_deg), Angle::from_degrees(phi_deg)};
  options.material = material;
  options.samples = 1U << 12;
  return options;
}

// Fresnel by tangents and sines (Born & Wolf, eq. 1.5.21), another form than the program's.
double fresnel(double theta, double n) {
  if (theta == 0.0) return std::pow((n - 1.0) / (n + 1.0), 2);
  const double refracted = std::asin(std::sin(theta) / n);
  const double s = std::sin(theta - refracted) / std::sin(theta + refracted);
  const double p = std::tan(theta - refracted) / std::tan(theta + refracted);
  return 0.5 * (s * s + p * p);
}

double sum_of(const DirectionMap& map, const DirectionGrid& grid) {
  const auto areas = projected_solid_angles(grid);
  double sum = 0.0;
  for (std::size_t k = 0; k < areas.size(); ++k) sum += map[k] * areas[k];
  return sum;
}

TEST(FlatSurface, ReflectsByFresnelAndSendsTheRestDown) {
  for (const double theta_deg : {0.0, 10.0, 45.0, 56.31, 75.0, 85.0, 89.5}) {
    for (const Continuation continuation : {Continuation::Periodic, Continuation::Mirrored}) {
      const Bsdf bsdf = trace_bsdf(flat(continuation), options_at(theta_deg, 30.0, Dielectric{1.5}));
      // Every path has the same weight: only rounding remains (1e-6 is what is asked for).
      EXPECT_NEAR(bsdf.energy.reflected.value, fresnel(theta_deg * std::numbers::pi / 180.0, 1.5), single) << theta_deg;
      EXPECT_NEAR(bsdf.energy.reflected.value + bsdf.energy.transmitted.value, 1.0, single);
      EXPECT_EQ(bsdf.energy.cut_off.value, 0.0);
      EXPECT_EQ(bsdf.energy.left_sideways.value, 0.0);
      EXPECT_NEAR(sum_of(bsdf.reflection.mean, bsdf.grid), bsdf.energy.reflected.value, single);
      EXPECT_NEAR(sum_of(bsdf.transmission.mean, bsdf.grid), bsdf.energy.transmitted.value, single);
    }
  }
}

TEST(FlatSurface, ReflectsToTheOtherSideAndRefractsBySnellsLaw) {
  // Light from φ = 100° comes down towards φ = 280°, and goes on that way above and below.
  const Bsdf bsdf = trace_bsdf(flat(), options_at(40.0, 100.0, Dielectric{1.5}));
  const double sine = std::sin(40.0 * std::numbers::pi / 180.0), phi = 280.0 * std::numbers::pi / 180.0;
  const auto areas = projected_solid_angles(bsdf.grid);
  const std::size_t up = bsdf.grid.bin_of(sine * std::cos(phi), sine * std::sin(phi));
  const std::size_t down = bsdf.grid.bin_of(sine / 1.5 * std::cos(phi), sine / 1.5 * std::sin(phi));
  EXPECT_NEAR(bsdf.reflection.mean[up] * areas[up], bsdf.energy.reflected.value, single);
  EXPECT_NEAR(bsdf.transmission.mean[down] * areas[down], bsdf.energy.transmitted.value, single);
}

TEST(FlatSurface, OfMetalAbsorbsWhatItDoesNotReflect) {
  const Bsdf bsdf = trace_bsdf(flat(), options_at(0.0, 0.0, Conductor{0.2, 3.0}));
  const double closed_form = (0.8 * 0.8 + 9.0) / (1.2 * 1.2 + 9.0);  // ((η−1)²+κ²)/((η+1)²+κ²)
  EXPECT_NEAR(bsdf.energy.reflected.value, closed_form, single);
  EXPECT_NEAR(bsdf.energy.absorbed.value, 1.0 - closed_form, single);
  EXPECT_EQ(bsdf.energy.transmitted.value, 0.0);
}

TEST(FlatSurface, HidesTheDefectOfTheSlidesWeight) {
  PathTracingOptions options = options_at(70.0, 0.0, Mirror{});
  options.estimator = Estimator::Slides;
  // (ω·m)/cosθ_i is 1 where m is the macronormal; only rough surfaces show what is wrong with it.
  EXPECT_NEAR(trace_bsdf(flat(), options).energy.reflected.value, 1.0, single);
}

TEST(FlatSurface, LitFromAWholeBinSpreadsOverTheOppositeBinEvenly) {
  PathTracingOptions options = options_at(50.0, 200.0, Mirror{});
  options.grid = {16, 16};
  options.spread_incidence_over_bin = true;
  const Bsdf bsdf = trace_bsdf(flat(), options);
  const Direction light = to_direction(options.incidence);
  const auto areas = projected_solid_angles(bsdf.grid);
  const std::size_t opposite = bsdf.grid.bin_of(-light.x(), -light.y());
  EXPECT_NEAR(bsdf.reflection.mean[opposite] * areas[opposite], 1.0, single);
}

}  // namespace
}  // namespace mezzotint
