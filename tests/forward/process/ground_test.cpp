#include <cmath>
#include <limits>
#include <numbers>

#include <gtest/gtest.h>

#include "forward/base/error.h"
#include "forward/process/printed_relief.h"
#include "forward/surface/slope_covariance.h"

namespace mezzotint {
namespace {

HeightField flat(std::size_t side, Length pitch) {
  return HeightField({side, side, pitch, pitch}, Continuation::Mirrored);
}

double rms_height_um(const HeightField& field) {
  double sum = 0.0;
  for (const float height : field.heights_um()) sum += static_cast<double>(height) * height;
  return std::sqrt(sum / static_cast<double>(field.grid().size()));
}

PrinterProfile only_octave(double weight, Length scale) {
  PrinterProfile profile;
  profile.ground = {{weight, scale}};
  return profile;
}

TEST(SplitGround, LeavesTheFinestOctaveToWaveOptics) {
  const PrinterProfile profile = only_octave(1.0 / 12.0, 2.0_um);
  EXPECT_NEAR(ground_rms_height(profile, profile.ground[0]).um(), 0.012, 5e-4);  // 12 nm, design §3
  const GroundSplit split = split_ground(profile, 550.0_nm);
  ASSERT_EQ(split.coherent.size(), 1U);
  EXPECT_TRUE(split.geometric.empty());
  EXPECT_NEAR(split.coherent_share, 0.92, 5e-3);  // 92 %, design §3
}

TEST(SplitGround, FollowsItsRuleOnTheSlidesGround) {
  const GroundSplit split = split_ground(PrinterProfile{}, 550.0_nm);
  // By hand: σ = 98.6, 16.4 and 12.3 nm; 4πσ/λ = 2.25, .375 and .282.
  ASSERT_EQ(split.geometric.size(), 1U);
  EXPECT_EQ(split.geometric[0].scale.um(), 50.0);
  ASSERT_EQ(split.coherent.size(), 2U);
  EXPECT_NEAR(split.coherent_share, std::exp(-0.375 * 0.375 - 0.282 * 0.282), 1e-3);  // three digits above
}

TEST(SplitGround, TakesEverythingAsGeometryWhereItIsRough) {
  PrinterProfile profile;
  profile.ground_amplitude = 10.0_um;
  const GroundSplit split = split_ground(profile, 550.0_nm);
  EXPECT_EQ(split.geometric.size(), 3U);
  EXPECT_EQ(split.coherent_share, 1.0);
  EXPECT_THROW((void)split_ground(profile, Length{}), InvalidInput);
}

TEST(GroundSlope, HasTheFloorsOfTheDesign) {
  const PrinterProfile profile;
  // Beckmann α = √2·σ: .040 with the 2 µm octave, .013 without; published to two digits.
  EXPECT_NEAR(std::numbers::sqrt2 * ground_rms_slope(profile, profile.ground), 0.040, 5e-4);
  EXPECT_NEAR(std::numbers::sqrt2 * ground_rms_slope(profile, {profile.ground[0], profile.ground[1]}), 0.013, 5e-4);
  EXPECT_EQ(ground_rms_slope(profile, {}), 0.0);
}

TEST(AddGround, HasItsClosedFormHeightAndSlope) {
  const PrinterProfile profile = only_octave(2.0 / 3.0, 50.0_um);
  HeightField field = flat(600, 5.0_um);  // 60 × 60 cells
  add_ground(field, profile, profile.ground, 3);
  // 3600 cells of about 3 independent draws each: the variance is known to √(2/10800) = 1.4 %, its root to
  // .7 %; four of these, plus .5 % for the plane that was chosen and .3 % for a sample each tenth of a cell.
  const double allowed = 0.028 + 0.005 + 0.003;
  EXPECT_NEAR(rms_height_um(field) / ground_rms_height(profile, profile.ground[0]).um(), 1.0, allowed);
  const SlopeCovariance slopes = slope_covariance(field);
  EXPECT_NEAR(std::sqrt(slopes.xx) / ground_rms_slope(profile, profile.ground), 1.0, allowed + 0.01);
  EXPECT_NEAR(std::sqrt(slopes.yy) / ground_rms_slope(profile, profile.ground), 1.0, allowed + 0.01);
}

TEST(AddGround, AddsToWhatIsThereAndLeavesMissingSamplesMissing) {
  const PrinterProfile profile;
  HeightField ground = flat(20, 3.0_um), field = flat(20, 3.0_um);
  for (float& height : field.heights_um()) height = 5.0F;
  field.at(3, 4) = std::numeric_limits<float>::quiet_NaN();
  add_ground(ground, profile, profile.ground, 1);
  add_ground(field, profile, profile.ground, 1);
  EXPECT_TRUE(std::isnan(field.at(3, 4)));
  EXPECT_NEAR(field.at(7, 9), 5.0F + ground.at(7, 9), 2e-6);  // float rounding at 5 µm
  EXPECT_NE(ground.at(7, 9), 0.0F);
}

TEST(AddGround, DrawsAnOctaveAlikeWithAndWithoutTheOthers) {
  PrinterProfile profile;
  HeightField first = flat(12, 3.0_um), both = flat(12, 3.0_um), second = flat(12, 3.0_um);
  add_ground(first, profile, {profile.ground[0]}, 1);
  add_ground(second, profile, {profile.ground[2]}, 1);
  add_ground(both, profile, {profile.ground[0], profile.ground[2]}, 1);
  for (std::size_t i = 0; i < 12; ++i) EXPECT_NEAR(both.at(i, i), first.at(i, i) + second.at(i, i), 1e-7);  // float
}

TEST(AddGround, IsAnotherSurfaceForAnotherSeedAndAnotherOctave) {
  // Two octaves of equal scale and weight are independent: RMS √2 of one, not 2.
  PrinterProfile profile;
  profile.ground = {{0.5, 20.0_um}, {0.5, 20.0_um}};
  HeightField sum = flat(300, 4.0_um), first = flat(300, 4.0_um), other = flat(300, 4.0_um);
  add_ground(sum, profile, profile.ground, 1);
  add_ground(first, profile, {profile.ground[0]}, 1);
  add_ground(other, profile, {profile.ground[0]}, 2);
  double product = 0.0, square = 0.0;
  for (std::size_t i = 0; i < first.grid().size(); ++i) {
    product += static_cast<double>(first.heights_um()[i]) * other.heights_um()[i];
    square += static_cast<double>(first.heights_um()[i]) * first.heights_um()[i];
  }
  // 3600 cells, about 3 independent draws each: a correlation of 0 is seen within 1 %, four of which are allowed.
  EXPECT_NEAR(product / square, 0.0, 0.04);
  EXPECT_NEAR(rms_height_um(sum) / rms_height_um(first), std::numbers::sqrt2, 0.04);
}

TEST(AddGround, RefusesOctavesWithoutAScale) {
  HeightField field = flat(4, 1.0_um);
  EXPECT_THROW(add_ground(field, PrinterProfile{}, {{1.0, Length{}}}, 1), InvalidInput);
}

TEST(Ground, SlopesAtPointsAreThoseOfTheReliefThere) {
  const PrinterProfile profile;
  const std::vector<GroundOctave> octaves = split_ground(profile, 550.0_nm).geometric;
  // Samples of half a micrometre: differences over one micrometre leave (kh)²/6 of a slope, 3 % of the octave of 25 µm.
  const Grid fine{400, 300, 0.5_um, 0.5_um};
  HeightField relief(fine, Continuation::Mirrored);
  add_ground(relief, profile, octaves, 7);
  const Grid points{40, 30, 4.0_um, 4.0_um};
  const ReliefSlopes slopes = ground_slopes(points, {10.0_um, 20.0_um}, profile, octaves, 7);
  double difference = 0.0, whole = 0.0;
  for (std::size_t row = 0; row < 30; ++row) {
    for (std::size_t column = 0; column < 40; ++column) {
      const std::size_t c = 20 + 8 * column, r = 40 + 8 * row;
      const double expected = double(relief.at(c + 1, r)) - double(relief.at(c - 1, r));
      difference += std::pow(double(slopes.x[row * 40 + column]) - expected, 2);
      whole += expected * expected;
    }
  }
  EXPECT_LT(std::sqrt(difference / whole), 0.02);
}

}  // namespace
}  // namespace mezzotint
