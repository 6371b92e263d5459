#include "measurement/correction/gaussian_filter.h"

#include <numbers>

#include <gtest/gtest.h>

#include "forward/base/error.h"
#include "tests/measurement/relief.h"

namespace mezzotint {
namespace {

using test::field_of;
constexpr double turn = 2.0 * std::numbers::pi;

HeightField waves(double periods, Continuation ends) {
  const Grid grid{128, 96, Length::from_um(0.5), Length::from_um(1.0)};
  return field_of(
      grid, [&](double c, double) { return std::sin(turn * periods * c / 128.0); }, ends);
}

TEST(GaussianFilter, PassesHalfOfTheWaveAsLongAsItsCutoff) {
  // Of any wavelength λ it passes 2^(−(cutoff/λ)²): the definition of ISO 16610-61. The tile is 64 µm wide.
  for (const double periods : {2.0, 4.0, 8.0}) {
    const HeightField passed = s_filter(waves(periods, Continuation::Periodic), Length::from_um(16.0));
    const double wavelength_um = 64.0 / periods, gain = std::exp2(-std::pow(16.0 / wavelength_um, 2));
    for (std::size_t c = 0; c < 128; ++c) {
      const double expected = gain * std::sin(turn * periods * static_cast<double>(c) / 128.0);
      // Weights beyond 1.2 cut-offs (1e-9) are left out, and the sum over 32 samples is the integral to 1e-12.
      EXPECT_NEAR(passed.at(c, 40), expected, 2e-7);
    }
  }
}

TEST(GaussianFilter, TheLFilterIsWhatTheSFilterTakesOut) {
  const HeightField field = test::white_noise(test::micrometre_grid(60, 50), 5);
  const HeightField smooth = s_filter(field, Length::from_um(8.0)), rough = l_filter(field, Length::from_um(8.0));
  for (std::size_t i = 0; i < field.grid().size(); ++i)
    EXPECT_NEAR(smooth.heights_um()[i] + rough.heights_um()[i], field.heights_um()[i], 1e-6);
}

TEST(GaussianFilter, LeavesATiltedPlaneAsItIsUpToTheRimAndBesideHoles) {
  HeightField field = field_of(test::micrometre_grid(70, 50), [](double c, double r) { return 0.3 * c - 0.7 * r; });
  for (std::size_t c = 10; c < 30; ++c)
    for (std::size_t r = 20; r < 28; ++r) field.at(c, r) = test::missing;
  const HeightField passed = s_filter(field, Length::from_um(20.0));
  EXPECT_EQ(passed.missing_count(), field.missing_count());
  for (std::size_t i = 0; i < field.grid().size(); ++i) {
    if (std::isnan(field.heights_um()[i])) continue;
    EXPECT_NEAR(passed.heights_um()[i], field.heights_um()[i], 1e-5);  // 35 µm in float
  }
}

// The definition, sample by sample: the height at its middle of the weighted plane of least squares.
double by_definition(const HeightField& field, double cutoff, std::size_t column, std::size_t row) {
  const double alpha = std::sqrt(std::numbers::ln2 / std::numbers::pi);
  double s[3][3] = {}, t[3] = {};
  for (std::size_t r = 0; r < field.rows(); ++r)
    for (std::size_t c = 0; c < field.columns(); ++c) {
      const double z = field.at(c, r);
      if (std::isnan(z)) continue;
      const double x = static_cast<double>(c) - static_cast<double>(column);
      const double y = static_cast<double>(r) - static_cast<double>(row);
      if (std::max(std::abs(x), std::abs(y)) > std::ceil(1.2 * cutoff)) continue;
      const double w = std::exp(-std::numbers::pi * (x * x + y * y) / (alpha * alpha * cutoff * cutoff));
      const double terms[3] = {1.0, x, y};
      for (int i = 0; i < 3; ++i) {
        t[i] += w * terms[i] * z;
        for (int j = 0; j < 3; ++j) s[i][j] += w * terms[i] * terms[j];
      }
    }
  const auto determinant = [](const double(&m)[3][3]) {
    return m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) - m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
           m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
  };
  double replaced[3][3];
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) replaced[i][j] = j == 0 ? t[i] : s[i][j];
  return determinant(replaced) / determinant(s);
}

TEST(GaussianFilter, IsItsDefinitionEverywhereAlsoWhereTilesMeet) {
  // 600 samples are two tiles of 512; a tenth is missing at random, and a block.
  HeightField field = test::white_noise(test::micrometre_grid(600, 24), 8);
  const RandomStream random(1, RandomPurpose::Test);
  for (std::size_t i = 0; i < field.grid().size(); ++i)
    if (random.uniform4(i)[1] < 0.1) field.heights_um()[i] = test::missing;
  for (std::size_t c = 505; c < 518; ++c) field.at(c, 12) = test::missing;
  const HeightField passed = s_filter(field, Length::from_um(6.0));
  for (const std::size_t column : {0U, 3U, 300U, 503U, 511U, 512U, 520U, 599U})
    for (std::size_t row = 0; row < 24; ++row) {
      if (std::isnan(field.at(column, row))) continue;
      EXPECT_NEAR(passed.at(column, row), by_definition(field, 6.0, column, row), 1e-6) << column << ' ' << row;
    }
}

// Windows of more than 128 samples go by Fourier transforms: 130 reaches 156 of them.
TEST(GaussianFilter, IsItsDefinitionForLongCutoffsToo) {
  HeightField field = test::white_noise(test::micrometre_grid(700, 40), 5);
  for (std::size_t c = 480; c < 560; ++c) field.at(c, 20) = field.at(c - 300, 3) = test::missing;
  const HeightField passed = s_filter(field, Length::from_um(130.0));
  for (const std::size_t column : {0U, 200U, 511U, 512U, 699U})
    for (const std::size_t row : {0U, 19U, 39U})
      EXPECT_NEAR(passed.at(column, row), by_definition(field, 130.0, column, row), 1e-6) << column << ' ' << row;
}

TEST(GaussianFilter, OfACutoffFarBeyondTheFieldIsItsPlane) {
  const HeightField field = field_of(test::micrometre_grid(30, 20), [](double c, double r) {
    return 0.5 * c + (static_cast<int>(c + r) % 2 == 0 ? 1.0 : -1.0);
  });
  const HeightField passed = s_filter(field, Length::from_um(1e7));
  EXPECT_NEAR(passed.at(29, 7) - passed.at(0, 7), 14.5, 0.02);  // what is left of the chequers at the rim
}

TEST(GaussianFilter, RefusesACutoffThatMakesNoSense) {
  const HeightField field(test::micrometre_grid(30, 20), Continuation::Periodic);
  for (const double cutoff_um : {0.0, -1.0, std::nan(""), HUGE_VAL, 25.0})
    EXPECT_THROW((void)s_filter(field, Length::from_um(cutoff_um)), InvalidInput) << cutoff_um;
}

}  // namespace
}  // namespace mezzotint
