#include "measurement/pattern_fit/pattern_fit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "forward/base/error.h"
#include "forward/base/fft.h"
#include "forward/base/random.h"
#include "measurement/formats/surface_file.h"
#include "tests/test_data.h"

namespace mezzotint {
namespace {

Grid grid_of(std::size_t side, double pitch_um) {
  return {side, side, Length::from_um(pitch_um), Length::from_um(pitch_um)};
}

HeightField with_white_noise(HeightField field, double rms_um, std::uint64_t seed) {
  const RandomStream random(seed, RandomPurpose::Test);
  for (std::size_t i = 0; i < field.grid().size(); ++i)
    field.heights_um()[i] += static_cast<float>(rms_um * random.normal4(i)[0]);
  return field;
}

const FittedParameter& named(const PatternFit& fit, const char* name) {
  return *std::ranges::find(fit.parameters, name, &FittedParameter::name);
}

bool covers(const FittedParameter& found, double truth) { return *found.low_95 <= truth && truth <= *found.high_95; }

// Five standard errors: with 23 degrees of freedom a false alarm in 20 000.
void expect_found(const PatternFit& fit, const char* name, double truth) {
  const FittedParameter& found = named(fit, name);
  ASSERT_TRUE(found.quantity.standard_error) << name;
  EXPECT_NEAR(found.quantity.value, truth, 5.0 * *found.quantity.standard_error) << name;
}

const PatternFitOptions noise_alone{.kinds = {"noise"}, .draws = 24};

// Patches of 32 cells with five samples each. Of 20 intervals of 95 % fewer than 16 hold the truth once in 390 times.
// A height that is known worse than 3 % would need a patch of fewer cells.
TEST(TextureFit, HasIntervalsForNoiseThatHoldTheTruth) {
  int held = 0;
  for (std::uint64_t set = 0; set < 10; ++set) {
    const auto u = RandomStream(set, RandomPurpose::Test).uniform4(0);
    const double scale = 50.0 * std::pow(4.0, u[0]), height = 2.0 * std::pow(10.0, u[1]);
    const Noise truth{.scale = Length::from_um(scale), .height = Length::from_um(height), .seed = set + 100};
    const PatternFit fit = fit_pattern(synthesize(truth, grid_of(160, scale / 5.0)), noise_alone);
    EXPECT_TRUE(fit.fits) << fit.verdict;
    for (const auto& [name, value] : {std::pair{"scale_um", scale}, std::pair{"height_um", height}}) {
      const FittedParameter& found = named(fit, name);
      held += covers(found, value) ? 1 : 0;
      EXPECT_LT(*found.high_95 - *found.low_95, 2.0 * 0.03 * value) << name << ", set " << set;
    }
  }
  EXPECT_GE(held, 16);
}

TEST(TextureFit, SeesStretchDirectionAndNoiseOfTheInstrument) {
  const Noise truth{.scale = 30.0_um, .stretch = 1.6, .direction = 35.0_deg, .height = 12.0_um, .seed = 5};
  const PatternFit fit = fit_pattern(with_white_noise(synthesize(truth, grid_of(256, 5.0)), 0.6, 3), noise_alone);
  EXPECT_TRUE(fit.fits) << fit.verdict;
  expect_found(fit, "scale_um", 30.0);
  expect_found(fit, "stretch", 1.6);
  expect_found(fit, "direction_deg", 35.0);
  expect_found(fit, "height_um", 12.0);
  EXPECT_NEAR(fit.white_noise.value, 0.6, 5.0 * *fit.white_noise.standard_error);
}

// Thirty samples a cell: most frequencies hold nothing but how the pattern was drawn, a millionth and less of its
// power.
TEST(TextureFit, IsNotMisledByFrequenciesWithoutPower) {
  const Noise truth{.scale = 60.0_um, .stretch = 2.5, .direction = 30.0_deg, .height = 16.0_um};
  const PatternFit fit = fit_pattern(synthesize(truth, grid_of(640, 2.0)), {.draws = 24});
  EXPECT_TRUE(fit.fits) << fit.verdict;
  EXPECT_EQ(kind_name(fit.pattern), "noise");
  expect_found(fit, "scale_um", 60.0);
  expect_found(fit, "height_um", 16.0);
}

// Noise alone, or of another number of octaves, competes.
TEST(TextureFit, CountsOctavesAndFindsHurstsExponent) {
  const FractionalBrownianMotion truth{.scale = 40.0_um, .height = 10.0_um, .hurst = 0.4, .octaves = 2, .seed = 9};
  const PatternFit fit = fit_pattern(synthesize(truth, grid_of(256, 5.0)), {.kinds = {"noise", "fbm"}, .draws = 40});
  EXPECT_TRUE(fit.fits) << fit.verdict;
  ASSERT_TRUE(std::holds_alternative<FractionalBrownianMotion>(fit.pattern)) << fit.verdict;
  EXPECT_EQ(std::get<FractionalBrownianMotion>(fit.pattern).octaves, 2);
  expect_found(fit, "scale_um", 40.0);
  expect_found(fit, "hurst", 0.4);
  expect_found(fit, "height_um", 10.0);
}

// 13 and 7 waves along a side of 160 samples with an error of 5 % of the height: by Cramér and Rao a wavelength is
// known to √6/(π · waves · (amplitude/error) · 160) of itself, below 1e-3; ten times that would be another estimator.
TEST(TextureFit, FindsLinesAsWellAsTheirNoiseLetsIt) {
  const Sinusoid crossed{.wavelength_u = 40.0_um, .wavelength_v = 55.0_um, .direction = 20.0_deg, .height = 8.0_um};
  const Ridges parallel{.wavelength = 45.0_um, .direction = -65.0_deg, .height = 8.0_um, .skew = 0.3};
  const Grid grid = grid_of(160, 3.0);
  const PatternFit sinusoid = fit_pattern(with_white_noise(synthesize(crossed, grid, {}), 0.4, 1));
  EXPECT_TRUE(sinusoid.fits) << sinusoid.verdict;
  ASSERT_TRUE(std::holds_alternative<Sinusoid>(sinusoid.pattern)) << sinusoid.verdict;
  expect_found(sinusoid, "wavelength_u_um", 40.0);
  expect_found(sinusoid, "wavelength_v_um", 55.0);
  expect_found(sinusoid, "direction_deg", 20.0);
  expect_found(sinusoid, "height_um", 8.0);
  EXPECT_LT(*named(sinusoid, "wavelength_u_um").quantity.standard_error, 1e-3 * 40.0);
  const PatternFit ridges = fit_pattern(with_white_noise(synthesize(parallel, grid, {}), 0.4, 2));
  EXPECT_TRUE(ridges.fits) << ridges.verdict;
  ASSERT_TRUE(std::holds_alternative<Ridges>(ridges.pattern)) << ridges.verdict;
  expect_found(ridges, "wavelength_um", 45.0);
  expect_found(ridges, "direction_deg", -65.0);
  expect_found(ridges, "height_um", 8.0);
  expect_found(ridges, "skew", 0.3);
}

// Without noise only the rounding of floats is left.
TEST(TextureFit, FindsALineExactlyWhereNothingLiesOverIt) {
  const Ridges truth{.wavelength = 45.0_um, .direction = 10.0_deg, .height = 8.0_um};
  const PatternFit fit = fit_pattern(synthesize(truth, grid_of(128, 3.0)));
  EXPECT_TRUE(fit.fits) << fit.verdict;
  EXPECT_NEAR(named(fit, "wavelength_um").quantity.value, 45.0, 1e-4);
  EXPECT_NEAR(named(fit, "skew").quantity.value, 0.5, 1e-5);
}

// A tenth of the samples scattered, and a hole of two cells; unequal pitches, a tilt ten times the height, an offset of
// 76 mm.
TEST(TextureFit, HoldsForAScanAsInstrumentsGiveIt) {
  const Noise truth{.scale = 40.0_um, .stretch = 1.4, .direction = 70.0_deg, .height = 6.0_um, .seed = 21};
  const Grid grid{256, 320, Length::from_um(8.0), Length::from_um(6.0)};
  HeightField scan = with_white_noise(synthesize(truth, grid), 0.1, 8);
  const RandomStream random(4, RandomPurpose::Test);
  for (std::size_t row = 0; row < grid.rows; ++row)
    for (std::size_t column = 0; column < grid.columns; ++column) {
      const double x = 8.0 * static_cast<double>(column), y = 6.0 * static_cast<double>(row);
      scan.at(column, row) += static_cast<float>(0.03 * (x + y));
      const bool hole = std::hypot(x - 900.0, y - 1000.0) < 40.0;
      if (hole || random.uniform4(row * grid.columns + column, 7)[0] < 0.1)
        scan.at(column, row) = std::numeric_limits<float>::quiet_NaN();
    }
  const HeightField far(grid, Continuation::Mirrored, {scan.heights_um().begin(), scan.heights_um().end()},
                        Length::from_mm(76.0));
  const PatternFit fit = fit_pattern(far, noise_alone);
  EXPECT_TRUE(fit.fits) << fit.verdict;
  EXPECT_NEAR(fit.missing_share, 0.1, 0.01);
  expect_found(fit, "scale_um", 40.0);
  expect_found(fit, "stretch", 1.4);
  expect_found(fit, "direction_deg", 70.0);
  expect_found(fit, "height_um", 6.0);
}

// White noise through a filter: |f| in cycles a sample to a factor of the amplitude.
template <typename Filter>
HeightField gaussian_field(std::size_t side, const Filter& filter) {
  RealFft2d fft(side, side);
  const RandomStream random(3, RandomPurpose::Test);
  for (std::size_t i = 0; i < side * side; ++i) fft.real()[i] = random.normal4(i)[0];
  fft.forward();
  for (std::size_t ky = 0; ky < side; ++ky)
    for (std::size_t kx = 0; kx < fft.spectrum_columns(); ++kx)
      fft.spectrum()[ky * fft.spectrum_columns() + kx] *=
          filter(std::hypot(static_cast<double>(kx), static_cast<double>(std::min(ky, side - ky))) /
                 static_cast<double>(side));
  fft.inverse();
  HeightField field(grid_of(side, 1.0), Continuation::Mirrored);
  std::ranges::transform(fft.real(), field.heights_um().begin(), [](double z) { return static_cast<float>(z); });
  return field;
}

TEST(TextureFit, SaysThatNoPatternFitsWhatIsNone) {
  HeightField blocks(grid_of(128, 1.0), Continuation::Mirrored);
  const RandomStream random(1, RandomPurpose::Test);
  for (std::size_t row = 0; row < 128; ++row)
    for (std::size_t column = 0; column < 128; ++column)
      blocks.at(column, row) = static_cast<float>(random.uniform4(row / 8 * 100 + column / 8)[0]);
  const HeightField band = gaussian_field(128, [](double f) { return f > 0.05 && f < 0.15 ? 1.0 : 0.0; });
  const HeightField bell = gaussian_field(128, [](double f) { return std::exp(-f * f / (4.0 * 0.06 * 0.06)); });
  const HeightField white = gaussian_field(128, [](double) { return 1.0; });
  const std::array fields = {blocks, band, bell, white};
  for (std::size_t i = 0; i < fields.size(); ++i) {
    // The bell is where a sum of octaves comes nearest; it takes the longest, too.
    const PatternFitOptions all, few{.kinds = {"noise", "sinusoid", "ridges"}, .draws = 24};
    const PatternFit fit = fit_pattern(fields.at(i), i == 2 ? all : few);
    EXPECT_FALSE(fit.fits) << i << ": " << fit.verdict;
    EXPECT_TRUE(fit.verdict.starts_with("no pattern fits")) << fit.verdict;
  }
}

TEST(TextureFit, SaysThatNoPatternFitsASurfaceThatWasGround) {
  const auto path = test::external_data_folder() / "surface" / "surfalize_test_2.opd";
  MEZZOTINT_NEEDS_DATA(path);
  const PatternFit fit = fit_pattern(crop(read_surface(path).field, 200, 100, 160, 160), {.draws = 24});
  EXPECT_FALSE(fit.fits) << fit.verdict;
}

void expect_refusal(const HeightField& field, const PatternFitOptions& options, const char* reason) {
  try {
    static_cast<void>(fit_pattern(field, options));
    ADD_FAILURE() << "not refused: " << reason;
  } catch (const InvalidInput& error) {
    EXPECT_NE(std::string(error.what()).find(reason), std::string::npos) << error.what();
  }
}

TEST(TextureFit, RefusesWhatHoldsNoTexture) {
  expect_refusal(HeightField(grid_of(31, 1.0), Continuation::Mirrored), {}, "32 x 32 samples at least");
  expect_refusal(HeightField(grid_of(64, 1.0), Continuation::Mirrored), {}, "flat");
  HeightField sparse(grid_of(64, 1.0), Continuation::Mirrored);
  for (std::size_t i = 0; i < sparse.grid().size(); ++i)
    if (i % 16 > 0) sparse.heights_um()[i] = std::numeric_limits<float>::quiet_NaN();
  expect_refusal(sparse, {}, "are missing");
  expect_refusal(sparse, {.kinds = {"turbulence"}}, "missing");
}

TEST(TextureFit, SaysHowManyCellsAPatchLacks) {
  const Noise truth{.scale = 60.0_um, .height = 6.0_um, .seed = 2};
  expect_refusal(synthesize(truth, grid_of(96, 4.0)), noise_alone, "8 are needed: measure");
}

}  // namespace
}  // namespace mezzotint
