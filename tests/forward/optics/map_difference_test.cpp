#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "forward/base/error.h"
#include "forward/base/random.h"
#include "forward/optics/direction_map.h"

namespace mezzotint {
namespace {

constexpr DirectionGrid grid{16, 16};
constexpr std::uint64_t trials = 1000;

// A map that is nowhere constant, and another that differs from it by `shift` times a pattern.
DirectionMap reference_map(double shift = 0.0) {
  DirectionMap map(grid.size());
  for (std::size_t k = 0; k < map.size(); ++k) {
    const double t = static_cast<double>(k);
    map[k] = 1.0 + 0.5 * std::sin(0.7 * t) + shift * std::cos(1.3 * t);
  }
  return map;
}

double noise_of_bin(std::size_t bin) { return 0.05 + 0.1 * static_cast<double>(bin % 5); }

// An estimate of a map: two halves with independent normal noise, their mean, its true standard error.
MapEstimate noisy(const DirectionMap& truth, std::uint64_t trial, std::uint32_t which) {
  const RandomStream stream(20191121, RandomPurpose::Test);
  MapEstimate estimate{truth, truth, truth, truth};
  for (std::size_t k = 0; k < truth.size(); ++k) {
    const auto normal = stream.normal4(trial * truth.size() + k, which);
    estimate.half_a[k] += std::sqrt(2.0) * noise_of_bin(k) * normal[0];
    estimate.half_b[k] += std::sqrt(2.0) * noise_of_bin(k) * normal[1];
    estimate.mean[k] = 0.5 * (estimate.half_a[k] + estimate.half_b[k]);
    estimate.standard_error[k] = noise_of_bin(k);
  }
  return estimate;
}

struct Moments {
  double sum = 0.0, squares = 0.0, count = 0.0;
  void add(double x) { sum += x, squares += x * x, count += 1.0; }
  [[nodiscard]] double mean() const { return sum / count; }
  [[nodiscard]] double deviation() const { return std::sqrt(squares / count - mean() * mean()); }
  [[nodiscard]] double error_of_mean() const { return deviation() / std::sqrt(count); }
};

// What a thousand trials say of one kind of comparison.
struct Study {
  Moments corrected, corrected_square, plain_square, stated_error;
  double floor = 0.0;
};

void add_to(Study& study, const MapDifference& difference) {
  study.corrected.add(difference.corrected.value);
  study.corrected_square.add(difference.corrected.value * difference.corrected.value);
  study.plain_square.add(difference.plain * difference.plain);
  study.stated_error.add(difference.corrected.standard_error);
  study.floor = difference.floor;
}

void expect_unbiased_against(const Study& study, double truth) {
  // 4.5 standard errors: a false alarm in 150,000 seeds. The plain figure, biased by the square of the
  // floor, must stand out by far more, or the test could not tell.
  EXPECT_NEAR(study.corrected_square.mean(), truth * truth, 4.5 * study.corrected_square.error_of_mean());
  EXPECT_GT(study.plain_square.mean() - truth * truth, 20.0 * study.plain_square.error_of_mean());
  EXPECT_NEAR(study.plain_square.mean(), truth * truth + study.floor * study.floor,
              4.5 * study.plain_square.error_of_mean() + 0.01 * truth * truth);  // 1 %: noise of the reference below
  // The spread of 1000 trials is known to 1/√2000 = 2.2 %; 10 % is 4.5 times that.
  EXPECT_NEAR(study.stated_error.mean() / study.corrected.deviation(), 1.0, 0.10);
}

TEST(RelativeL2, OfTwoExactMapsIsWeightedByTheDisc) {
  const std::vector<double> areas = projected_solid_angles(grid);
  DirectionMap f = reference_map(0.3), g = reference_map();
  double above = 0.0, below = 0.0;
  for (std::size_t k = 0; k < f.size(); ++k) {
    if (areas[k] == 0.0)
      f[k] = std::nan("");  // outside of the disc: nobody looks
    else
      above += areas[k] * (f[k] - g[k]) * (f[k] - g[k]), below += areas[k] * g[k] * g[k];
  }
  EXPECT_NEAR(relative_l2(grid, f, g), std::sqrt(above / below), 1e-14);  // rounding
}

TEST(RelativeL2, IsUnbiasedAgainstAnExactReference) {
  const DirectionMap f = reference_map(0.3), g = reference_map();
  Study study;
  for (std::uint64_t t = 0; t < trials; ++t) add_to(study, relative_l2(grid, noisy(f, t, 0), g));
  expect_unbiased_against(study, relative_l2(grid, f, g));
}

TEST(RelativeL2, IsUnbiasedAgainstANoisyReference) {
  const DirectionMap f = reference_map(0.4), g = reference_map();
  Study study;
  for (std::uint64_t t = 0; t < trials; ++t) {
    const MapDifference difference = relative_l2(grid, noisy(f, t, 0), noisy(g, t, 1));
    study.corrected.add(difference.corrected.value);
    study.corrected_square.add(difference.corrected.value * difference.corrected.value);
    study.stated_error.add(difference.corrected.standard_error);
  }
  const double truth = relative_l2(grid, f, g);
  // A ratio of two unbiased sums is biased by its own relative variance, here (0.03)² of it: allow 0.2 %.
  EXPECT_NEAR(study.corrected_square.mean(), truth * truth,
              4.5 * study.corrected_square.error_of_mean() + 0.002 * truth * truth);
  EXPECT_NEAR(study.stated_error.mean() / study.corrected.deviation(), 1.0, 0.10);  // as above
}

TEST(RelativeL2, FindsNothingInNoiseAlone) {
  const DirectionMap g = reference_map();
  std::size_t zeros = 0, false_alarms = 0;
  Moments plain;
  double floor = 0.0;
  for (std::uint64_t t = 0; t < trials; ++t) {
    const MapDifference difference = relative_l2(grid, noisy(g, t, 2), g);
    zeros += difference.corrected.value == 0.0;
    false_alarms += difference.corrected.value > 3.0 * difference.corrected.standard_error;
    plain.add(difference.plain * difference.plain);
    floor = difference.floor;
  }
  // Half of the trials fall on the wrong side of 0: 4.5 √(1000)/2 = 71.
  EXPECT_NEAR(static_cast<double>(zeros), 500.0, 71.0);
  // √q > 3 standard errors is q > 1.59 σ of q: 5.6 % of normal trials, 56 ± 7.3; 4.5 of these are 33, and 10
  // more because a sum of products is not quite normal.
  EXPECT_LT(false_alarms, 56U + 33U + 10U);
  EXPECT_NEAR(plain.mean(), floor * floor, 4.5 * plain.error_of_mean());
}

TEST(RelativeL2, HasNoErrorWithoutNoise) {
  const DirectionMap f = reference_map(0.3), g = reference_map();
  const MapEstimate exact{f, DirectionMap(f.size(), 0.0), f, f};
  const MapDifference difference = relative_l2(grid, exact, g);
  EXPECT_EQ(difference.corrected.value, difference.plain);
  EXPECT_EQ(difference.corrected.standard_error, 0.0);
  EXPECT_EQ(difference.floor, 0.0);
}

TEST(RelativeL2, RefusesMapsThatDoNotFitAndReferencesThatAreNothing) {
  const DirectionMap map = reference_map(), shorter(5, 1.0), zero(map.size(), 0.0);
  EXPECT_THROW((void)relative_l2(grid, shorter, map), InvalidInput);
  EXPECT_THROW((void)relative_l2(grid, map, shorter), InvalidInput);
  EXPECT_THROW((void)relative_l2(grid, map, zero), InvalidInput);
  EXPECT_THROW((void)relative_l2(grid, MapEstimate{map, map, map, {}}, map), InvalidInput);
}

}  // namespace
}  // namespace mezzotint
