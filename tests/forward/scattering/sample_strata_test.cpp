#include "forward/scattering/sample_strata.h"

#include <cmath>
#include <set>
#include <vector>

#include <gtest/gtest.h>

namespace mezzotint {
namespace {

struct Points {
  std::vector<double> u, v;
};

Points points(std::uint32_t bits, Placement placement, std::uint64_t first, std::size_t count,
              std::uint32_t batch = 0) {
  Points all{std::vector<double>(count), std::vector<double>(count)};
  SampleStrata(bits, placement, 1, 0, batch).points(first, all.u, all.v);
  return all;
}

TEST(SampleStrata, FillTheSquareEvenly) {
  for (const Placement placement : {Placement::Strata, Placement::Lattice}) {
    for (const std::uint32_t bits : {0U, 1U, 4U, 7U, 10U}) {
      const double across = std::ldexp(1.0, static_cast<int>((bits + 1) / 2)),
                   along = std::ldexp(1.0, static_cast<int>(bits / 2));
      const std::size_t count = std::size_t{1} << bits;
      const Points all = points(bits, placement, 0, count);
      std::set<std::pair<double, double>> met;
      for (std::size_t k = 0; k < count; ++k) {
        EXPECT_TRUE(all.u[k] >= 0.0 && all.u[k] < 1.0 && all.v[k] >= 0.0 && all.v[k] < 1.0);
        met.insert({std::floor(all.u[k] * across), std::floor(all.v[k] * along)});
      }
      EXPECT_EQ(met.size(), count);
    }
  }
}

TEST(SampleStrata, KeepNeighboursTogether) {
  // A quarter of a Morton curve is a quarter of the square.
  const Points quarter = points(8, Placement::Strata, 0, 64);
  for (std::size_t k = 0; k < 64; ++k) {
    EXPECT_LT(quarter.u[k], 0.5);
    EXPECT_LT(quarter.v[k], 0.5);
  }
}

TEST(SampleStrata, AreTheSameWhereverReadingStarts) {
  const Points all = points(12, Placement::Strata, 0, 4096), part = points(12, Placement::Strata, 1001, 300);
  for (std::size_t k = 0; k < 300; ++k) {
    EXPECT_EQ(part.u[k], all.u[1001 + k]);
    EXPECT_EQ(part.v[k], all.v[1001 + k]);
  }
}

TEST(SampleStrata, JitterIsUniformAndIndependentInUAndV) {
  // χ² of 16 × 16 places within a stratum, 2^16 strata in each of 4 batches: 255 degrees of freedom, of which 4 chi-
  // squares stay below 342 in all but one of 10^3 cases.
  for (std::uint32_t batch = 0; batch < 4; ++batch) {
    const Points all = points(16, Placement::Strata, 0, 65536, batch);
    std::vector<double> counts(256);
    for (std::size_t k = 0; k < all.u.size(); ++k) {
      const auto place = [](double x) { return static_cast<std::size_t>(16.0 * (x * 256.0 - std::floor(x * 256.0))); };
      counts[16 * place(all.v[k]) + place(all.u[k])] += 1.0;
    }
    double chi_square = 0.0;
    for (const double count : counts) chi_square += (count - 256.0) * (count - 256.0) / 256.0;
    EXPECT_LT(chi_square, 342.0);
    EXPECT_GT(chi_square, 180.0);  // as unlikely on the other side: too even is not random either
  }
}

}  // namespace
}  // namespace mezzotint
