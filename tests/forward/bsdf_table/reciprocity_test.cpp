#include <gtest/gtest.h>

#include "forward/base/random.h"
#include "forward/bsdf_table/reciprocity.h"
#include "tests/forward/bsdf_table/beckmann_table.h"

namespace mezzotint {
namespace {

using test::beckmann;
using test::coarse;

BsdfTableOptions options_of(const BsdfSymmetry& symmetry) {
  BsdfTableOptions options = coarse(symmetry, 5);
  options.largest_theta = Angle::from_degrees(60);
  return options;
}

// What is left is the finite size of bins, there and back: it falls with them (rms .039, .016, .012 of the round lobe
// and .099, .060, .029 of the elliptic one at 64, 128, 256 bins a side).
TEST(Reciprocity, IsKeptByAClosedForm) {
  const BeckmannLobe round{0.5, 0.5, {}}, elliptic{0.5, 0.3, Angle::from_degrees(20)};
  const auto check = [](const BeckmannLobe& lobe, const BsdfSymmetry& symmetry, std::size_t bins) {
    return check_reciprocity(build_bsdf_table(beckmann(lobe, {bins, bins}), options_of(symmetry)).table);
  };
  const ReciprocityCheck isotropic = check(round, {}, 128);
  EXPECT_EQ(isotropic.pairs, 5U * 4U / 2U * 7U);
  EXPECT_LT(isotropic.rms_relative, 0.02);
  EXPECT_EQ(isotropic.rms_in_standard_errors, 0.0);

  const BsdfSymmetry half_a_turn{SymmetryKind::Point, {}};
  const double coarse = check(elliptic, half_a_turn, 64).rms_relative;
  const double fine = check(elliptic, half_a_turn, 128).rms_relative;
  EXPECT_LT(fine, 0.07);
  EXPECT_LT(fine, 0.7 * coarse);
}

TEST(Reciprocity, SeesABsdfThatLacksIt) {
  const ComputeBsdf lobe = beckmann({0.5, 0.5, {}}, {64, 64});
  const ComputeBsdf skewed = [&](const DirectionAngles& light) {
    Bsdf bsdf = lobe(light);
    for (double& value : bsdf.reflection.mean) value *= 1.0 + light.theta.radians();
    bsdf.reflection = test::exact(bsdf.reflection.mean);
    return bsdf;
  };
  EXPECT_GT(check_reciprocity(build_bsdf_table(skewed, options_of({})).table).rms_relative, 0.2);
}

// Lambert's law with noise: nothing but the noise is left, and the standard errors say so.
TEST(Reciprocity, TellsNoiseFromAFault) {
  std::uint64_t run = 0;
  const ComputeBsdf lambert = [&](const DirectionAngles& light) {
    Bsdf bsdf;
    bsdf.incidence = light;
    bsdf.grid = {32, 32};
    bsdf.reflection = test::exact(DirectionMap(bsdf.grid.size(), 0.3));
    bsdf.transmission = test::exact(DirectionMap(bsdf.grid.size(), 0.0));
    const RandomStream stream(++run, RandomPurpose::Test);
    for (std::size_t k = 0; k < bsdf.grid.size(); ++k) {
      const auto normal = stream.normal4(k);
      bsdf.reflection.mean[k] += 0.02 * normal[0];
      bsdf.reflection.half_a[k] = bsdf.reflection.half_b[k] = bsdf.reflection.mean[k];  // so that no bin is joined
      bsdf.reflection.standard_error[k] = 0.02;
    }
    return bsdf;
  };
  const ReciprocityCheck seen =
      check_reciprocity(build_bsdf_table(lambert, options_of({SymmetryKind::Point, {}})).table);
  ASSERT_GT(seen.pairs, 300U);
  // Values that share a bin are the same number: 10 % for 400 pairs, of which a part is not independent.
  EXPECT_NEAR(seen.rms_in_standard_errors, 1.0, 0.15);
  EXPECT_LT(static_cast<double>(seen.beyond_three_errors), 0.02 * static_cast<double>(seen.pairs));
  EXPECT_EQ(seen.lost_in_noise, 0U);
}

}  // namespace
}  // namespace mezzotint
