#include <gtest/gtest.h>
#include <array>
#include <cmath>

#include "forward/scattering/path_tracing.h"
#include "tests/forward/scattering/reliefs.h"

namespace mezzotint {
namespace {

struct Pair {
  DirectionAngles first;
  DirectionAngles second;
};

DirectionAngles at(double theta_deg, double phi_deg) {
  return {Angle::from_degrees(theta_deg), Angle::from_degrees(phi_deg)};
}

// Sixteen different bins of a 32² map, so that all estimates are independent; near and far pairs, in and out
// of the plane of incidence, chosen for enough light at an RMS gradient of 0.5.
const std::array<Pair, 8> pairs = {{{at(3.0, 10.0), at(40.0, 200.0)},
                                    {at(8.0, 90.0), at(55.0, 250.0)},
                                    {at(15.0, 300.0), at(62.0, 110.0)},
                                    {at(20.0, 0.0), at(50.0, 170.0)},
                                    {at(12.0, 200.0), at(67.0, 30.0)},
                                    {at(30.0, 45.0), at(65.0, 260.0)},
                                    {at(35.0, 150.0), at(72.0, 320.0)},
                                    {at(25.0, 250.0), at(45.0, 20.0)}}};

std::size_t bin_of(const DirectionGrid& grid, const DirectionAngles& angles) {
  const Direction direction = to_direction(angles);
  return grid.bin_of(direction.x(), direction.y());
}

Estimate brdf_from_to(const HeightField& field, PathTracingOptions options, const DirectionAngles& light,
                      const DirectionAngles& viewer, std::uint64_t seed) {
  options.incidence = light;
  options.seed = seed;
  const Bsdf bsdf = trace_bsdf(field, options);
  const std::size_t bin = bin_of(options.grid, viewer);
  return {bsdf.reflection.mean[bin], bsdf.reflection.standard_error[bin]};
}

double chi_square(const HeightField& field, const PathTracingOptions& options) {
  double sum = 0.0;
  std::uint64_t seed = 100;
  for (const auto& [a, b] : pairs) {
    const Estimate there = brdf_from_to(field, options, a, b, ++seed);
    const Estimate back = brdf_from_to(field, options, b, a, ++seed);
    const double error = std::hypot(there.standard_error, back.standard_error);
    EXPECT_GT(there.value, 0.0);
    EXPECT_GT(back.value, 0.0);
    sum += std::pow((there.value - back.value) / error, 2);
  }
  return sum;
}

// Probability that a χ² of 8 degrees of freedom exceeds x.
double tail_probability(double x) {
  double term = 1.0, sum = 1.0;
  for (int k = 1; k < 4; ++k) sum += term *= 0.5 * x / k;
  return sum * std::exp(-0.5 * x);
}

PathTracingOptions reciprocity_options() {
  PathTracingOptions options;
  options.grid = {32, 32};
  options.material = Mirror{};
  options.spread_incidence_over_bin = true;
  options.samples = 1U << 18;
  options.batches = 64;  // standard errors of standard errors 9 %, so χ² is some 3 % too large
  options.max_bounces = 256;
  return options;
}

TEST(Reciprocity, HoldsBetweenBinsForAMirror) {
  // The same relief both ways, light spread over its bin: the two fluxes are equal exactly, and differ here by
  // the noise of sampling alone. False-alarm rate 0.001.
  const double sum = chi_square(test::random_relief(128, 0.5), reciprocity_options());
  RecordProperty("chi_square", std::to_string(sum));
  EXPECT_GT(tail_probability(sum), 0.001) << "χ² = " << sum << " of 8 pairs";
}

TEST(Reciprocity, IsBrokenByTheSlidesWeight) {
  // The test above must be able to fail: this weight is wrong by the ratio of the cosines, 20 to 90 %.
  PathTracingOptions options = reciprocity_options();
  options.estimator = Estimator::Slides;
  options.samples = 1U << 16;
  const double sum = chi_square(test::random_relief(128, 0.5), options);
  EXPECT_LT(tail_probability(sum), 1e-6) << "χ² = " << sum << " of 8 pairs";
}

}  // namespace
}  // namespace mezzotint
