#include "forward/scattering/bin_interval.h"

#include <gtest/gtest.h>
#include <cmath>

#include "tests/forward/scattering/coverage.h"
#include "tests/forward/scattering/gaussian_relief.h"

namespace mezzotint {
namespace {

TEST(ChiSquareQuantile, HasTheValuesOfTables) {
  EXPECT_NEAR(chi_square_quantile(0.975, 2.0), -2.0 * std::log(0.025), 1e-9);  // closed form
  EXPECT_NEAR(chi_square_quantile(0.025, 2.0), -2.0 * std::log(0.975), 1e-9);
  EXPECT_NEAR(chi_square_quantile(0.025, 20.0), 9.590777, 1e-6);  // as printed
  EXPECT_NEAR(chi_square_quantile(0.975, 20.0), 34.169607, 1e-6);
  EXPECT_NEAR(chi_square_quantile(0.975, 1.0), 5.023886, 1e-6);
  EXPECT_NEAR(chi_square_quantile(0.025, 1.0) / 9.820691e-4, 1.0, 1e-6);
}

TEST(ChiSquareQuantile, TakesAnyNumberOfDegrees) {
  // Between the table's rows it must rise, and far below one hit the lower end nearly vanishes.
  double before = 0.0;
  for (double degrees = 0.05; degrees < 24.0; degrees += 0.05) {
    const double x = chi_square_quantile(0.025, degrees);
    EXPECT_GT(x, before) << degrees;
    before = x;
  }
  EXPECT_LT(chi_square_quantile(0.025, 0.05), 1e-30);
}

TEST(Student95, HasTheValuesOfTables) {
  EXPECT_NEAR(student_95(3), 3.18245, 5e-3);  // the expansion's own error
  EXPECT_NEAR(student_95(7), 2.36462, 1e-4);
  EXPECT_NEAR(student_95(31), 2.03951, 1e-5);
}

BinHits hits_of(double number, double weight) { return {number * weight, number * weight * weight, 0.0}; }

TEST(FewHitsInterval, IsGarwoodsScaledByTheWeightOfAHit) {
  const Interval five = few_hits_interval(hits_of(5.0, 1.0), 1.0);
  EXPECT_NEAR(five.low, 1.62349, 1e-5);  // Garwood 1936, as printed
  EXPECT_NEAR(five.high, 11.66833, 1e-5);
  const Interval light = few_hits_interval(hits_of(5.0, 0.04), 1.0);
  EXPECT_NEAR(light.low, 0.04 * five.low, 1e-12);
  EXPECT_NEAR(light.high, 0.04 * five.high, 1e-12);
}

TEST(FewHitsInterval, BoundsAnEmptyBinByTheLargestWeight) {
  const Interval none = few_hits_interval({}, 0.7);
  EXPECT_EQ(none.low, 0.0);
  EXPECT_NEAR(none.high, -0.7 * std::log(0.025), 1e-9);
}

TEST(FewHitsInterval, OfHitsOfManyWeightsIsWiderThanOfTheirMean) {
  const BinHits unequal{0.9 + 4.0 * 0.025, 0.81 + 4.0 * 0.000625, 0.0};  // five hits, one of which is nearly all
  EXPECT_LT(unequal.effective(), 1.3);
  EXPECT_GT(few_hits_interval(unequal, 1.0).high, 2.0 * few_hits_interval(hits_of(5.0, 0.2), 1.0).high);
}

TEST(FewHitsInterval, TurnsWithTheSignOfTheLight) {
  const BinHits given{3.0, 5.0, 1.0}, taken{-3.0, 5.0, 4.0};  // four there and one back, and the other way round
  const Interval there = few_hits_interval(given, 1.0), back = few_hits_interval(taken, 1.0);
  EXPECT_NEAR(there.low, -back.high, 1e-12);
  EXPECT_NEAR(there.high, -back.low, 1e-12);
}

TEST(FewHitsInterval, CoversEveryPoissonNumber) {
  // Summed over all numbers of hits: 95 % or more for every expectation, as Garwood's construction promises.
  for (double mean = 0.05; mean < 12.0; mean *= 1.1) {
    double covered = 0.0, probability = std::exp(-mean);
    for (int hits = 0; hits < 60; probability *= mean / ++hits) {
      const Interval interval = few_hits_interval(hits_of(hits, 1.0), 1.0);
      if (interval.low <= mean && mean <= interval.high) covered += probability;
    }
    EXPECT_GE(covered, 0.95 - 1e-9) << mean;
  }
}

TEST(MapIntervals, HoldTheTruthWithFewHitsAndWithMany) {
  // 40 repeats here, 200 in tests/benchmark. Thousands of intervals a class: their share is known to 1 % or better.
  PathTracer tracer(test::gaussian_relief(128, 0.3, 8.0));
  for (const Material& material : {Material{Mirror{}}, Material{Dielectric{1.5}}}) {
    PathTracingOptions options;
    options.grid = {32, 32};
    options.incidence = {Angle::from_degrees(30.0), Angle::from_degrees(20.0)};
    options.material = material;
    options.samples = 1U << 13;
    options.control_variate = ControlVariate::Off;
    const test::Coverage coverage = test::coverage_of(tracer, options, 40, 128);
    for (std::size_t c = 0; c < coverage.edges.size(); ++c) {
      if (coverage.intervals[c] < 1000.0) continue;
      EXPECT_GT(coverage.share(c), coverage.edges[c] < few_hits ? 0.95 : 0.92) << "from " << coverage.edges[c];
      // A number of hits is whole: near 0 no interval can cover less than all but the rare ones.
      if (coverage.edges[c] >= few_hits) {
        EXPECT_LT(coverage.share(c), 0.985) << "from " << coverage.edges[c];
      }
    }
  }
}

}  // namespace
}  // namespace mezzotint
