#include "measurement/correction/flatten_base.h"

#include <gtest/gtest.h>

#include "forward/base/error.h"
#include "measurement/correction/outliers.h"
#include "measurement/correction/plane.h"
#include "tests/measurement/relief.h"

namespace mezzotint {
namespace {

double bow_um(double x, double y) {
  return 0.002 * x - 0.003 * y + 4e-5 * (x - 120.0) * (x - 120.0) + 1e-7 * x * y * y;
}

// Bumps that cover a fifteenth of a bowed base with 20 nm of noise.
HeightField bumps_on_a_bow() {
  HeightField field = test::white_noise(test::micrometre_grid(256, 200), 9);
  for (std::size_t row = 0; row < field.rows(); ++row)
    for (std::size_t column = 0; column < field.columns(); ++column) {
      const auto x = static_cast<double>(column), y = static_cast<double>(row);
      // More bumps to one side, so that a fit through all samples is pulled askew.
      const double bump = x < 130.0 ? test::bumps_um(x, y) : 0.0;
      field.at(column, row) =
          static_cast<float>(0.02 * static_cast<double>(field.at(column, row)) + bump + bow_um(x, y));
    }
  return field;
}

double base_rms_um(const HeightField& field) {
  double squares = 0.0, sum = 0.0, count = 0.0;
  for (std::size_t row = 0; row < field.rows(); ++row)
    for (std::size_t column = 0; column < field.columns(); ++column) {
      const auto x = static_cast<double>(column), y = static_cast<double>(row);
      if (x < 130.0 && test::bumps_um(x, y) > 0.0) continue;
      const double z = field.at(column, row);
      squares += z * z;
      sum += z;
      count += 1.0;
    }
  return std::sqrt(squares / count - sum * sum / count / count);
}

TEST(FlattenBase, LeavesTheBaseFlatToItsNoiseWhateverStandsOnIt) {
  const HeightField field = bumps_on_a_bow();
  const FlattenedBase flat = flatten_base(field, 4);
  EXPECT_TRUE(flat.settled);
  // 20 nm of noise; 15 coefficients through 48000 samples add nothing that could be seen.
  EXPECT_NEAR(base_rms_um(flat.field), 0.02, 0.0005);
  // The same polynomial through all samples follows the bumps: the test can tell.
  EXPECT_GT(base_rms_um(subtract_polynomial(field, fit_polynomial(field, 4))), 0.03);
  // Bumps of 6.25 µm² · π on 625 µm², over 130 of 256 columns: a share of 0.984 is base (but for 3σ of its noise).
  EXPECT_NEAR(flat.base_share, 0.98, 0.01);
}

TEST(FlattenBase, OfAFlatFieldIsIt) {
  const FlattenedBase flat = flatten_base(HeightField(test::micrometre_grid(20, 20), Continuation::Mirrored), 2);
  for (const float z : flat.field.heights_um()) EXPECT_EQ(z, 0.0F);
  EXPECT_EQ(flat.base_share, 1.0);
}

TEST(FlattenBase, RefusesOtherDegrees) {
  const HeightField field(test::micrometre_grid(20, 20), Continuation::Mirrored);
  EXPECT_THROW((void)flatten_base(field, 0), InvalidInput);
  EXPECT_THROW((void)flatten_base(field, 13), InvalidInput);
}

TEST(Outliers, WarnWhereTheyLookLikeFeatures) {
  const FlattenedBase flat = flatten_base(bumps_on_a_bow(), 4);
  const OutlierResult bumps = mask_outliers(flat.field, 3.0);
  EXPECT_NE(bumps.warning.find("look like features"), std::string::npos) << bumps.share;
  HeightField spiky = test::white_noise(test::micrometre_grid(256, 256), 3);
  for (std::size_t i = 0; i < 65536; i += 400) spiky.heights_um()[i] += 50.0F;
  const OutlierResult spikes = mask_outliers(spiky, 4.0);
  EXPECT_EQ(spikes.removed, 164U);
  EXPECT_EQ(spikes.warning, "");
}

TEST(LocalOutliers, AreSpikesThoughFeaturesStandHigher) {
  // Bumps 15 µm across: their tops are 0.2 µm above the median around them.
  HeightField field = test::white_noise(test::micrometre_grid(256, 200), 9);
  for (std::size_t row = 0; row < field.rows(); ++row)
    for (std::size_t column = 0; column < field.columns(); ++column)
      field.at(column, row) =
          0.02F * field.at(column, row) +
          static_cast<float>(test::bumps_um(static_cast<double>(column) / 3.0, static_cast<double>(row) / 3.0));
  for (const auto& [c, r] : {std::pair{20U, 30U}, {100U, 111U}, {0U, 0U}}) field.at(c, r) += 2.0F;
  const OutlierResult local = mask_local_outliers(field, 60.0);
  EXPECT_EQ(local.removed, 3U);
  EXPECT_TRUE(std::isnan(local.field.at(0, 0)) && std::isnan(local.field.at(100, 111)));
  // Among all heights the tops of the bumps stand out before they do.
  const OutlierResult global = mask_outliers(field, 8.0);
  EXPECT_FALSE(std::isnan(global.field.at(100, 111)));
  EXPECT_TRUE(std::isnan(global.field.at(75, 75)));
}

TEST(LocalOutliers, OfQuantisedHeightsAreMeasuredByTheStepsNotByZero) {
  HeightField field =
      test::field_of(test::micrometre_grid(40, 40), [](double c, double) { return std::floor(c / 8.0); });
  EXPECT_EQ(mask_local_outliers(field, 5.0).removed, 0U);
  field.at(4, 4) += 40.0F;
  EXPECT_EQ(mask_local_outliers(field, 5.0).removed, 1U);
}

}  // namespace
}  // namespace mezzotint
