#include "measurement/instrument/virtual_profilometer.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "forward/base/error.h"

namespace mezzotint {
namespace {

Grid square(std::size_t side, double pitch_um) {
  return {side, side, Length::from_um(pitch_um), Length::from_um(pitch_um)};
}

/// A tilted plane, which cubic convolution reproduces: any placement of it has a closed form.
HeightField plane(std::size_t side, double pitch_um, double slope_x, double slope_y) {
  HeightField field(square(side, pitch_um), Continuation::Mirrored);
  for (std::size_t r = 0; r < side; ++r) {
    for (std::size_t c = 0; c < side; ++c) {
      field.at(c, r) =
          static_cast<float>(pitch_um * (slope_x * static_cast<double>(c) + slope_y * static_cast<double>(r)));
    }
  }
  return field;
}

VirtualProfilometer with_pitch(double pitch_um) {
  VirtualProfilometer instrument;
  instrument.pitch = Length::from_um(pitch_um);
  return instrument;
}

// Heights of some 10 µm in float: 2^-24 relative, twice rounded.
constexpr double storage = 4e-6;

TEST(VirtualProfilometer, SeesTheReliefItselfWhenNothingIsInTheWay) {
  const HeightField relief = plane(20, 1.5, 0.3, -0.1);
  const HeightField measured = measure_virtually(relief, with_pitch(1.5));
  ASSERT_EQ(measured.grid(), relief.grid());
  EXPECT_EQ(measured.missing_count(), 0U);
  for (std::size_t k = 0; k < relief.heights_um().size(); ++k) {
    EXPECT_EQ(measured.heights_um()[k], relief.heights_um()[k]);
  }
}

TEST(VirtualProfilometer, PlacesTurnsAndTiltsAsItsFrameSays) {
  const double a = 0.3, b = -0.1, side_um = 30.0;
  const HeightField relief = plane(31, 1.0, a, b);
  VirtualProfilometer instrument = with_pitch(0.75);
  instrument.shift_x = Length::from_um(2.3);
  instrument.shift_y = Length::from_um(-1.1);
  instrument.rotation = Angle::from_degrees(25.0);
  instrument.tilt_x = 0.02;
  instrument.tilt_y = -0.05;
  const HeightField measured = measure_virtually(relief, instrument);
  EXPECT_EQ(measured.columns(), 41U);
  const double cosine = std::cos(instrument.rotation.radians()), sine = std::sin(instrument.rotation.radians());
  std::size_t seen = 0;
  for (std::size_t r = 0; r < measured.rows(); ++r) {
    for (std::size_t c = 0; c < measured.columns(); ++c) {
      // Back from q = R(p − m) + m + s to p, m the middle.
      const double x = 0.75 * static_cast<double>(c) - 15.0, y = 0.75 * static_cast<double>(r) - 15.0;
      const double px = cosine * (x - 2.3) + sine * (y + 1.1) + 15.0;
      const double py = -sine * (x - 2.3) + cosine * (y + 1.1) + 15.0;
      const bool inside = px >= 0 && px <= side_um && py >= 0 && py <= side_um;
      ASSERT_EQ(std::isnan(measured.at(c, r)), !inside) << c << ", " << r;
      if (!inside) continue;
      EXPECT_NEAR(measured.at(c, r), a * px + b * py + 0.02 * x - 0.05 * y, storage);
      ++seen;
    }
  }
  EXPECT_GT(seen, 1000U);
}

TEST(VirtualProfilometer, AveragesOverItsPixelWhenThatIsTheLarger) {
  const double wavelength_um = 10.0;
  HeightField relief(square(401, 0.25), Continuation::Mirrored);
  for (std::size_t k = 0; k < relief.heights_um().size(); ++k) {
    const double x = 0.25 * static_cast<double>(k % relief.columns());
    relief.heights_um()[k] = static_cast<float>(std::cos(2.0 * std::numbers::pi * x / wavelength_um));
  }
  for (const double pitch_um : {2.5, 5.0, 10.0}) {
    const HeightField measured = measure_virtually(relief, with_pitch(pitch_um));
    // The mean over a pixel: sinc(pitch/λ). Its points lie 0.25 µm apart, which changes that by (π·0.25/λ)²/6 = 0.1 %,
    // and the interpolation adds less. At pitch = λ single points would show a flat surface of height 1.
    const double phase = std::numbers::pi * pitch_um / wavelength_um;
    const double x = pitch_um * 3.0;
    const double expected = std::sin(phase) / phase * std::cos(2.0 * std::numbers::pi * x / wavelength_um);
    EXPECT_NEAR(measured.at(3, 2), expected, 2e-3) << pitch_um;
    EXPECT_TRUE(std::isnan(measured.at(0, 2)));  // half of that pixel is not on the relief
  }
}

TEST(VirtualProfilometer, AddsTheNoiseItSays) {
  const HeightField relief(square(200, 1.0), Continuation::Mirrored);
  VirtualProfilometer instrument = with_pitch(1.0);
  instrument.noise = 50.0_nm;
  const HeightField measured = measure_virtually(relief, instrument);
  double sum = 0.0, squares = 0.0, neighbours = 0.0;
  const auto n = static_cast<double>(measured.grid().size());
  for (std::size_t k = 0; k < measured.grid().size(); ++k) {
    const double z = static_cast<double>(measured.heights_um()[k]);
    sum += z;
    squares += z * z;
    if (k > 0) neighbours += z * static_cast<double>(measured.heights_um()[k - 1]);
  }
  // Five standard errors each: a false alarm in about a million.
  EXPECT_NEAR(sum / n, 0.0, 5.0 * 0.05 / std::sqrt(n));
  EXPECT_NEAR(std::sqrt(squares / n), 0.05, 5.0 * 0.05 / std::sqrt(2.0 * n));
  EXPECT_NEAR(neighbours / squares, 0.0, 5.0 / std::sqrt(n));
}

TEST(VirtualProfilometer, MissesTheShareItSays) {
  const HeightField relief(square(200, 1.0), Continuation::Mirrored);
  VirtualProfilometer instrument = with_pitch(1.0);
  instrument.missing_share = 0.1;
  // Binomial: 4000 ± 60, at five standard deviations.
  EXPECT_NEAR(static_cast<double>(measure_virtually(relief, instrument).missing_count()), 4000.0, 300.0);
}

TEST(VirtualProfilometer, IsFixedByItsSeed) {
  const HeightField relief = plane(30, 1.0, 0.1, 0.2);
  VirtualProfilometer instrument = with_pitch(1.0);
  instrument.noise = 10.0_nm;
  const HeightField once = measure_virtually(relief, instrument);
  const HeightField again = measure_virtually(relief, instrument);
  instrument.seed = 2;
  const HeightField other = measure_virtually(relief, instrument);
  EXPECT_TRUE(std::equal(once.heights_um().begin(), once.heights_um().end(), again.heights_um().begin()));
  EXPECT_FALSE(std::equal(once.heights_um().begin(), once.heights_um().end(), other.heights_um().begin()));
}

TEST(VirtualProfilometer, KnowsAPeriodicReliefUpToTheEndOfItsPeriod) {
  const HeightField relief(square(32, 1.0), Continuation::Periodic);
  const HeightField measured = measure_virtually(relief, with_pitch(0.5));
  EXPECT_EQ(measured.columns(), 64U);
  EXPECT_EQ(measured.missing_count(), 0U);
  VirtualProfilometer shifted = with_pitch(1.0);
  shifted.shift_x = 4.0_um;
  EXPECT_EQ(measure_virtually(relief, shifted).missing_count(), 4U * 32U);
}

TEST(VirtualProfilometer, RefusesWhatNoInstrumentIs) {
  const HeightField relief(square(32, 1.0), Continuation::Mirrored);
  VirtualProfilometer instrument = with_pitch(0.0);
  EXPECT_THROW((void)measure_virtually(relief, instrument), InvalidInput);
  instrument = with_pitch(1e-12);  // more samples than fit: refused before anything is allocated
  EXPECT_THROW((void)measure_virtually(relief, instrument), InvalidInput);
  instrument = with_pitch(1.0);
  instrument.missing_share = 0.6;
  EXPECT_THROW((void)measure_virtually(relief, instrument), InvalidInput);
  instrument.missing_share = 0.0;
  instrument.noise = Length::from_nm(-1.0);
  EXPECT_THROW((void)measure_virtually(relief, instrument), InvalidInput);
  instrument.noise = 0.0_nm;
  instrument.rotation = Angle::from_radians(std::nan(""));
  EXPECT_THROW((void)measure_virtually(relief, instrument), InvalidInput);
}

}  // namespace
}  // namespace mezzotint
