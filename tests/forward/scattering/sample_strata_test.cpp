#include "forward/scattering/sample_strata.h"

#include <gtest/gtest.h>
#include <cmath>
#include <set>

namespace mezzotint {
namespace {

TEST(SampleStrata, FillTheSquareEvenly) {
  for (const std::uint32_t bits : {0U, 1U, 4U, 7U}) {
    const SampleStrata strata(bits);
    const double across = std::ldexp(1.0, static_cast<int>((bits + 1) / 2)),
                 along = std::ldexp(1.0, static_cast<int>(bits / 2));
    std::set<std::pair<double, double>> met;
    for (std::uint64_t index = 0; index < (std::uint64_t{1} << bits); ++index) {
      const auto [u, v] = strata.point(index, 0.5, 0.999);
      EXPECT_TRUE(u >= 0.0 && u < 1.0 && v >= 0.0 && v < 1.0);
      met.insert({std::floor(u * across), std::floor(v * along)});
    }
    EXPECT_EQ(met.size(), std::size_t{1} << bits);
  }
}

TEST(SampleStrata, KeepNeighboursTogether) {
  // A quarter of a Morton curve is a quarter of the square.
  const SampleStrata strata(8);
  for (std::uint64_t index = 0; index < 64; ++index) {
    const auto [u, v] = strata.point(index, 0.5, 0.5);
    EXPECT_LT(u, 0.5);
    EXPECT_LT(v, 0.5);
  }
}

}  // namespace
}  // namespace mezzotint
