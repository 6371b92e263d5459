#include <gtest/gtest.h>
#include <tbb/global_control.h>
#include <cmath>

#include "forward/base/error.h"
#include "forward/scattering/path_tracing.h"
#include "tests/forward/scattering/reliefs.h"

namespace mezzotint {
namespace {

PathTracingOptions options_at(double theta_deg, const Material& material) {
  PathTracingOptions options;
  options.incidence = {Angle::from_degrees(theta_deg), Angle::from_degrees(25.0)};
  options.material = material;
  options.samples = 1U << 16;
  return options;
}

double sum_of(const EnergyAudit& energy) {
  return energy.reflected.value + energy.transmitted.value + energy.absorbed.value + energy.left_sideways.value +
         energy.cut_off.value;
}

Bsdf trace_with_threads(std::size_t threads, const HeightField& field, const PathTracingOptions& options) {
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
  return trace_bsdf(field, options);
}

TEST(PathTracing, GivesTheSameBitsWithAnyNumberOfThreads) {
  const HeightField field = test::random_relief(128, 0.8);
  PathTracingOptions options = options_at(60.0, Dielectric{1.5});
  options.normals = NormalKind::Interpolated;
  const Bsdf one = trace_with_threads(1, field, options);
  for (const std::size_t threads : {2, 3}) {
    const Bsdf many = trace_with_threads(threads, field, options);
    EXPECT_EQ(one.reflection.mean, many.reflection.mean);
    EXPECT_EQ(one.reflection.standard_error, many.reflection.standard_error);
    EXPECT_EQ(one.reflection.half_a, many.reflection.half_a);
    EXPECT_EQ(one.transmission.mean, many.transmission.mean);
    EXPECT_EQ(one.energy.reflected.value, many.energy.reflected.value);
    EXPECT_EQ(one.provenance, many.provenance);
  }
}

TEST(PathTracing, ChangesWithTheSeedAndOnlyByItsOwnErrors) {
  const HeightField field = test::random_relief(64, 0.3);
  PathTracingOptions options = options_at(30.0, Dielectric{1.5});
  const Bsdf first = trace_bsdf(field, options);
  options.seed = 2;
  const Bsdf second = trace_bsdf(field, options);
  EXPECT_NE(first.reflection.mean, second.reflection.mean);
  const double difference = first.energy.reflected.value - second.energy.reflected.value;
  // Two independent estimates: five standard errors, false alarm 1e-6.
  EXPECT_LT(std::abs(difference),
            5.0 * std::hypot(first.energy.reflected.standard_error, second.energy.reflected.standard_error));
}

TEST(PathTracing, AccountsForAllLightThatMeetsGlass) {
  for (const double gradient : {0.3, 0.8}) {
    for (const double theta_deg : {0.0, 80.0}) {
      for (const NormalKind normals : {NormalKind::Geometric, NormalKind::Interpolated}) {
        PathTracingOptions options = options_at(theta_deg, Dielectric{1.5});
        options.normals = normals;
        const Bsdf bsdf = trace_bsdf(test::random_relief(128, gradient), options);
        EXPECT_NEAR(sum_of(bsdf.energy), 1.0, 1e-7);  // weights of paths are single: 6e-8
        EXPECT_LT(bsdf.energy.cut_off.value, 1e-5);   // through an edge by rounding; 64 interactions are plenty
        EXPECT_GT(bsdf.energy.transmitted.value, 0.4);
        EXPECT_EQ(bsdf.energy.absorbed.value, 0.0);
      }
    }
  }
}

// The unpolarised reflectance that a facet has from straight above (Born & Wolf, eq. 1.5.21).
double fresnel(double theta, double n) {
  if (theta < 1e-9) return std::pow((n - 1.0) / (n + 1.0), 2);
  const double refracted = std::asin(std::sin(theta) / n);
  const double s = std::sin(theta - refracted) / std::sin(theta + refracted);
  const double p = std::tan(theta - refracted) / std::tan(theta + refracted);
  return 0.5 * (s * s + p * p);
}

TEST(PathTracing, ReflectsFromGentleGlassWhatItsFacetsReflect) {
  // From straight above every facet is lit by its own projected area and, below the slope of ½, meets light once.
  const HeightField field = test::random_relief(64, 0.1);
  double sum = 0.0;
  for (std::size_t r = 0; r < 64; ++r) {
    for (std::size_t c = 0; c < 64; ++c) {
      const std::size_t right = (c + 1) % 64, up = (r + 1) % 64;
      const double z = field.at(c, r), zx = field.at(right, r), zy = field.at(c, up), zxy = field.at(right, up);
      sum +=
          fresnel(std::atan(std::hypot(zx - z, zxy - zx)), 1.5) + fresnel(std::atan(std::hypot(zxy - zy, zy - z)), 1.5);
    }
  }
  const double expected = sum / (2.0 * 64.0 * 64.0);
  PathTracingOptions options = options_at(0.0, Dielectric{1.5});
  const Bsdf bsdf = trace_bsdf(field, options);
  // Five standard errors (false alarm 1e-6), which strata keep below 1e-6.
  EXPECT_LT(bsdf.energy.reflected.standard_error, 1e-6);
  EXPECT_NEAR(bsdf.energy.reflected.value, expected,
              5.0 * bsdf.energy.reflected.standard_error + 1e-8);  // single Fresnel
  EXPECT_NEAR(bsdf.energy.transmitted.value, 1.0 - expected, 5e-6);
}

TEST(PathTracing, BringsALittleLightBackOutOfSteepGlass) {
  // An opaque medium of the same index (κ = 1e-9) has the same reflectance and loses what refracts in. The
  // difference is what came back: 1e-5 of the light at s = 0.8, up to 6e-4 at s = 2 (design.md).
  const HeightField steep = test::random_relief(64, 2.0);
  PathTracingOptions options = options_at(0.0, Dielectric{1.5});
  options.samples = 1U << 18;
  const Bsdf glass = trace_bsdf(steep, options);
  options.material = Conductor{1.5, 1e-9};
  const Bsdf opaque = trace_bsdf(steep, options);
  const double back = glass.energy.reflected.value - opaque.energy.reflected.value;
  // Four standard errors, false alarm 3e-5.
  EXPECT_GT(back, 4.0 * std::hypot(glass.energy.reflected.standard_error, opaque.energy.reflected.standard_error));
  EXPECT_LT(back, 1e-3);
  EXPECT_NEAR(sum_of(glass.energy), 1.0, 1e-7);  // weights of paths are single: 6e-8
  EXPECT_NEAR(sum_of(opaque.energy), 1.0, 1e-7);
  EXPECT_LT(glass.energy.cut_off.value, 1e-5);  // 64 interactions are plenty, even here
}

TEST(PathTracing, CountsLightThatMeetsAMirroredCopyFirst) {
  // z = −t·x, mirrored: a roof with its crest at x = 0 and its valley at x = L. Light that comes down along +x is
  // aimed at the plane of the mean height, −tL/2. At the crest it is too low for x_aim < tL·tanθ/2 and meets the
  // copy before it; beyond L(1 − t·tanθ/2) it passes over the valley. Together t·tanθ of the light.
  const double t = 0.1, theta_deg = 60.0;
  const HeightField roof = test::relief(201, 20, Continuation::Mirrored, [&](double c, double) { return -t * c; });
  PathTracingOptions options = options_at(theta_deg, Mirror{});
  options.incidence.phi = Angle::from_degrees(180.0);
  const Bsdf bsdf = trace_bsdf(roof, options);
  // Two edges, each within one of 64 strata along x, jittered in 32 batches: σ ≈ 1/64/√(12·32)·√2 = 1.1e-3,
  // less by the strata along y. Two of them.
  EXPECT_NEAR(bsdf.energy.left_sideways.value, t * std::tan(theta_deg * std::numbers::pi / 180.0), 2e-3);
  EXPECT_NEAR(sum_of(bsdf.energy), 1.0, 1e-7);  // single weights
  // From the other side all light that is aimed at the rising slope meets it.
  options.incidence.phi = Angle::from_degrees(0.0);
  EXPECT_EQ(trace_bsdf(roof, options).energy.left_sideways.value, 0.0);
}

TEST(PathTracing, GivesLightFromTheMeasuredPatchOnly) {
  // The roof again, lit along the slope: the patch is one plane, tilted by atan t, and has one reflection.
  const double t = 0.1;
  const HeightField roof = test::relief(201, 20, Continuation::Mirrored, [&](double c, double) { return -t * c; });
  PathTracingOptions options = options_at(60.0, Mirror{});
  options.incidence.phi = Angle::from_degrees(180.0);
  const Bsdf bsdf = trace_bsdf(roof, options);
  const double reflected = 60.0 * std::numbers::pi / 180.0 + 2.0 * std::atan(t);
  const auto areas = projected_solid_angles(bsdf.grid);
  double in_row = 0.0;  // y is 0 but for rounding: either of the two rows that meet there
  const std::size_t column = bsdf.grid.bin_of(std::sin(reflected), 0.0) % bsdf.grid.width;
  for (const std::size_t row : {31, 32}) {
    const std::size_t bin = row * bsdf.grid.width + column;
    in_row += bsdf.reflection.mean[bin] * areas[bin];
  }
  EXPECT_NEAR(in_row, 1.0, 1e-12);  // rounding: the maps are normalised by the light that met the patch
}

TEST(PathTracing, ShowsHowTheSlidesWeightMakesAndLosesEnergy) {
  // Beckmann slopes of α = s = 0.3, one bounce, no shadowing: references.md, "Energy of the slides' sample weight".
  // Slopes of 96 waves are not quite Gaussian, and 7 % of the light bounces twice at 60° (three seeds: within
  // 0.006 up to 45°, 0.015 at 60°).
  const HeightField field = test::random_relief(128, 0.3);
  for (const auto& [theta_deg, energy] : {std::pair{0.0, 0.960}, {30.0, 0.974}, {45.0, 1.002}, {60.0, 1.084}}) {
    PathTracingOptions options = options_at(theta_deg, Mirror{});
    options.estimator = Estimator::Slides;
    EXPECT_NEAR(trace_bsdf(field, options).energy.reflected.value, energy, 0.015) << theta_deg;
  }
  PathTracingOptions options = options_at(80.0, Mirror{});
  options.estimator = Estimator::Slides;
  EXPECT_NEAR(trace_bsdf(field, options).energy.reflected.value, 1.96, 0.15);  // design.md; three seeds: 1.93 to 2.03
}

TEST(PathTracing, ReportsErrorsThatCoverTheTruth) {
  // Errors of the bins against a run of 16 times as many paths: the mean of the squares of their quotients is 1
  // (and 1/16 for the run that serves as truth). Few counts in weak bins; so from bins with more than 2 % error.
  const HeightField field = test::random_relief(64, 0.3);
  PathTracingOptions options = options_at(30.0, Mirror{});
  options.grid = {16, 16};
  options.batches = 32;
  const Bsdf rough = trace_bsdf(field, options);
  options.samples <<= 4;
  options.seed = 7;
  const Bsdf fine = trace_bsdf(field, options);
  double sum = 0.0, count = 0.0;
  for (std::size_t k = 0; k < options.grid.size(); ++k) {
    if (!(fine.reflection.mean[k] > 0.02)) continue;
    const double error = std::hypot(rough.reflection.standard_error[k], fine.reflection.standard_error[k]);
    sum += std::pow((rough.reflection.mean[k] - fine.reflection.mean[k]) / error, 2);
    count += 1.0;
    EXPECT_NEAR(0.5 * (rough.reflection.half_a[k] + rough.reflection.half_b[k]), rough.reflection.mean[k], 1e-12);
  }
  ASSERT_GT(count, 30.0);
  // χ²/n has a standard deviation of √(2/n) < 0.26, and quotients by an estimated error (31 degrees of
  // freedom) raise it by 7 %: four standard deviations.
  EXPECT_GT(sum / count, 0.3);
  EXPECT_LT(sum / count, 2.1);
}

TEST(PathTracing, StopsWhenItsProgressThrows) {
  PathTracingOptions options = options_at(0.0, Mirror{});
  options.samples = 1U << 22;
  double last = 0.0;
  const Progress stop_early = [&](const ProgressEvent& event) {
    EXPECT_GE(event.fraction, last);
    last = event.fraction;
    if (event.fraction > 0.0) throw Interrupted();
  };
  EXPECT_THROW((void)trace_bsdf(test::random_relief(32, 0.1), options, stop_early), Interrupted);
  EXPECT_LT(last, 0.5);
}

TEST(PathTracing, ReportsItsProgressUpToTheEnd) {
  double last = 0.0;
  (void)trace_bsdf(test::random_relief(32, 0.1), options_at(0.0, Mirror{}),
                   [&](const ProgressEvent& event) { last = event.fraction; });
  EXPECT_EQ(last, 1.0);
}

TEST(PathTracing, SaysHowItWasMade) {
  PathTracingOptions options = options_at(0.0, Dielectric{1.5});
  options.samples = 50000;  // 32 batches of 2048 strata
  options.batches = 32;
  const Bsdf bsdf = trace_bsdf(test::random_relief(32, 0.1), options);
  EXPECT_EQ(bsdf.provenance.at("samples"), "65536");
  EXPECT_EQ(bsdf.provenance.at("tracer"), "height field");
  EXPECT_EQ(bsdf.provenance.at("material"), "dielectric:1.5");
  EXPECT_EQ(bsdf.grid, options.grid);
}

TEST(PathTracing, RefusesWhatMakesNoSense) {
  const HeightField field = test::random_relief(32, 0.1);
  const auto refuses = [&](const HeightField& relief, const auto& change) {
    PathTracingOptions options = options_at(0.0, Mirror{});
    change(options);
    EXPECT_THROW((void)trace_bsdf(relief, options), InvalidInput);
  };
  refuses(field, [](auto& o) { o.incidence.theta = Angle::from_degrees(90.0); });
  refuses(field, [](auto& o) { o.incidence.theta = Angle::from_radians(std::nan("")); });
  refuses(field, [](auto& o) { o.incidence.theta = Angle::from_degrees(-1.0); });
  refuses(field, [](auto& o) { o.batches = 5; });
  refuses(field, [](auto& o) { o.batches = 2; });
  refuses(field, [](auto& o) { o.samples = 0; });
  refuses(field, [](auto& o) { o.samples = (std::uint64_t{1} << 36) + 1; });
  refuses(field, [](auto& o) { o.max_bounces = 0; });
  refuses(field, [](auto& o) { o.grid = {0, 64}; });
  refuses(field, [](auto& o) { o.material = Dielectric{0.9}; });
  HeightField holed = field;
  holed.at(3, 4) = std::nanf("");
  refuses(holed, [](auto&) {});
  refuses(test::relief(1, 8, Continuation::Periodic, [](double, double) { return 0.0; }), [](auto&) {});
}

}  // namespace
}  // namespace mezzotint
