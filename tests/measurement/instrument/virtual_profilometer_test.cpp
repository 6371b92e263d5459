#include "measurement/instrument/virtual_profilometer.h"

#include <cmath>
#include <cstddef>
#include <numbers>
#include <span>
#include <vector>

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "forward/base/error.h"
#include "measurement/instrument/light_collected.h"

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

TEST(VirtualProfilometer, PassesASinusoidByItsTransfer) {
  // Whole waves across the period, and pixels as fine as the relief: the Gaussian alone is left.
  const double side_um = 256.0;
  for (const double waves : {4.0, 16.0, 32.0, 64.0}) {
    HeightField relief(square(256, 1.0), Continuation::Periodic);
    const auto phase = [&](std::size_t column) {
      return 2.0 * std::numbers::pi * waves * static_cast<double>(column) / side_um;
    };
    for (std::size_t k = 0; k < relief.heights_um().size(); ++k)
      relief.heights_um()[k] = static_cast<float>(10.0 * std::cos(phase(k % 256)));
    VirtualProfilometer instrument = with_pitch(1.0);
    instrument.bandwidth = 16.0_um;
    const HeightField measured = measure_virtually(relief, instrument);
    double along = 0.0;
    for (std::size_t k = 0; k < measured.heights_um().size(); ++k)
      along += 2.0 * static_cast<double>(measured.heights_um()[k]) * std::cos(phase(k % 256)) / (256.0 * 256.0);
    const double ratio = 16.0 / (side_um / waves);
    // The filter's weights end where they are 1e-9, and heights are floats: 10 µm · 6e-8, less by the mean of many.
    EXPECT_NEAR(along, 10.0 * std::exp2(-ratio * ratio), 1e-6) << waves << " waves; at 16, half of the amplitude";
  }
}

TEST(VirtualProfilometer, SeesNothingBeyondItsAcceptanceAngle) {
  // Planes to either side of tan(arcsin 0.3) = 0.3145; the tilt counts.
  VirtualProfilometer instrument = with_pitch(1.0);
  instrument.aperture = 0.3;
  const auto missing_of = [&](double slope_x, double slope_y) {
    return measure_virtually(plane(40, 1.0, slope_x, slope_y), instrument).missing_count();
  };
  EXPECT_EQ(missing_of(0.31, 0.0), 0U);
  EXPECT_EQ(missing_of(0.0, -0.31), 0U);
  EXPECT_EQ(missing_of(0.32, 0.0), 1600U);
  EXPECT_EQ(missing_of(0.2, 0.25), 1600U);
  instrument.tilt_x = 0.02;
  EXPECT_EQ(missing_of(0.31, 0.0), 1600U);
  EXPECT_EQ(missing_of(-0.33, 0.0), 0U);
  instrument.rotation = Angle::from_degrees(180.0);  // the sample turns, the tilt is the instrument's
  EXPECT_EQ(missing_of(-0.33, 0.0), 1600U);
  EXPECT_EQ(missing_of(0.33, 0.0), 0U);
}

TEST(VirtualProfilometer, CollectsTheLightOfTwoOverlappingPupils) {
  EXPECT_EQ(light_collected(0.0, 0.5), 1.0);
  EXPECT_EQ(light_collected(std::tan(std::asin(0.5)) * (1.0 + 1e-12), 0.5), 0.0);
  // Half of a diameter apart: (2/π)(π/3 − √3/4).
  const double half = std::tan(std::asin(0.25));
  EXPECT_NEAR(light_collected(half, 0.5), 2.0 / 3.0 - std::sqrt(3.0) / (2.0 * std::numbers::pi), 1e-12);
}

TEST(VirtualProfilometer, HasMoreSpikesAndMissesMoreWhereLessLightComesBack) {
  for (const double slope : {0.0, 0.2, 0.28}) {
    const HeightField relief = plane(300, 1.0, slope, 0.0);
    VirtualProfilometer instrument = with_pitch(1.0);
    instrument.aperture = 0.3;
    instrument.missing_share = 0.05;
    instrument.outlier_share = 0.02;
    instrument.outlier_size = 5.0_um;
    const HeightField measured = measure_virtually(relief, instrument);
    double spikes = 0.0, squares = 0.0, seen = 0.0;
    for (std::size_t k = 0; k < 90000; ++k) {
      if (std::isnan(measured.heights_um()[k])) continue;
      const double off = static_cast<double>(measured.heights_um()[k]) - static_cast<double>(relief.heights_um()[k]);
      EXPECT_LE(std::abs(off), 5.0 + 1e-5);
      seen += 1.0;
      spikes += std::abs(off) > 1e-5 ? 1.0 : 0.0;
      squares += off * off;
    }
    const double light = light_collected(slope, 0.3);
    const auto share = [&](double level) { return level / (level + (1.0 - level) * light); };
    const double expected_seen = 1.0 - share(0.05), expected_spikes = share(0.02);
    // Binomial, at five standard deviations.
    const double n = 90000.0;
    EXPECT_NEAR(seen / n, expected_seen, 5.0 * std::sqrt(expected_seen * (1.0 - expected_seen) / n)) << slope;
    EXPECT_NEAR(spikes / seen, expected_spikes, 5.0 * std::sqrt(expected_spikes * (1.0 - expected_spikes) / seen));
    // Uniform in ±5 µm: a variance of 25/3, whose own relative deviation is √(4/5) for one spike.
    EXPECT_NEAR(squares / spikes, 25.0 / 3.0, 5.0 * 25.0 / 3.0 * std::sqrt(0.8 / spikes)) << slope;
  }
}

TEST(VirtualProfilometer, HasRoundHolesOfTheShareAndSizeItSays) {
  const std::size_t side = 1000;
  const HeightField relief(square(side, 1.0), Continuation::Mirrored);
  VirtualProfilometer instrument = with_pitch(1.0);
  instrument.hole_share = 0.2;
  instrument.hole_diameter = 8.0_um;
  const HeightField measured = measure_virtually(relief, instrument);
  const auto seen = [&](std::size_t column, std::size_t row) {
    return std::isnan(measured.at(column, row)) ? 0.0 : 1.0;
  };
  for (const std::size_t apart : {std::size_t{0}, std::size_t{2}, std::size_t{4}, std::size_t{6}, std::size_t{8}}) {
    double both = 0.0, count = 0.0;
    for (std::size_t row = 0; row < side; ++row)
      for (std::size_t column = 0; column + apart < side; ++column) {
        both += seen(column, row) * seen(column + apart, row);
        count += 1.0;
      }
    // Boolean model: two points are free of holes where no centre lies in two discs about them, of which the share
    // `common` (that of two pupils) overlaps.
    const double ratio = static_cast<double>(apart) / 8.0;
    const double common = 2.0 / std::numbers::pi * (std::acos(ratio) - ratio * std::sqrt(1.0 - ratio * ratio));
    // Some 20,000 independent places of a disc's area: a deviation of 0.003, taken five times.
    EXPECT_NEAR(both / count, std::pow(0.8, 2.0 - common), 0.015) << apart;
  }
}

TEST(VirtualProfilometer, KeepsItsOffsetInTheDatum) {
  HeightField relief = plane(20, 1.0, 0.1, 0.0);
  VirtualProfilometer instrument = with_pitch(1.0);
  const HeightField plain = measure_virtually(relief, instrument);
  instrument.offset = 76.123456789_mm;
  const HeightField far = measure_virtually(relief, instrument);
  EXPECT_EQ(far.datum().um(), 76123.456789);
  EXPECT_TRUE(std::equal(plain.heights_um().begin(), plain.heights_um().end(), far.heights_um().begin()));
}

TEST(VirtualProfilometer, GivesTheSameBitsWithAnyNumberOfThreads) {
  VirtualProfilometer instrument = with_pitch(0.9);
  instrument.bandwidth = 3.0_um;
  instrument.aperture = 0.5;
  instrument.noise = 20.0_nm;
  instrument.missing_share = instrument.outlier_share = instrument.hole_share = 0.05;
  instrument.outlier_size = instrument.hole_diameter = 4.0_um;
  const HeightField relief = plane(120, 1.0, 0.3, -0.2);
  const auto bits = [&](std::size_t threads) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    const HeightField measured = measure_virtually(relief, instrument);
    const auto bytes = std::as_bytes(measured.heights_um());
    return std::vector<std::byte>(bytes.begin(), bytes.end());
  };
  EXPECT_EQ(bits(1), bits(4));
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
  const auto refused = [&](const auto& spoil) {
    VirtualProfilometer spoilt = with_pitch(1.0);
    spoil(spoilt);
    EXPECT_THROW((void)measure_virtually(relief, spoilt), InvalidInput);
  };
  refused([](VirtualProfilometer& i) { i.aperture = 1.1; });
  refused([](VirtualProfilometer& i) { i.bandwidth = -1.0_um; });
  refused([](VirtualProfilometer& i) { i.outlier_share = 0.6; });
  refused([](VirtualProfilometer& i) { i.outlier_size = Length::from_um(std::nan("")); });
  refused([](VirtualProfilometer& i) { i.hole_share = 0.1; });  // without a diameter
  refused([](VirtualProfilometer& i) { i.offset = Length::from_um(HUGE_VAL); });
}

}  // namespace
}  // namespace mezzotint
