#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "forward/base/error.h"
#include "forward/base/random.h"
#include "forward/process/printed_relief.h"

namespace mezzotint {
namespace {

GrayImage random_image(std::size_t columns, std::size_t rows) {
  GrayImage image{columns, rows, {}};
  const RandomStream stream(7, RandomPurpose::Test);
  for (std::size_t i = 0; i < columns * rows; ++i) image.values.push_back(static_cast<float>(stream.uniform4(i)[0]));
  return image;
}

double mean(const GrayImage& image) {
  return std::accumulate(image.values.begin(), image.values.end(), 0.0) / static_cast<double>(image.values.size());
}

TEST(SpreadLight, AttenuatesASinusoidByPixelAndBlur) {
  constexpr std::size_t period = 8, subsamples = 5;
  PrinterProfile profile;
  profile.spread.width = 4.5_um;
  GrayImage image{period, 3, {}};
  for (std::size_t i = 0; i < period * 3; ++i) {
    const double phase = 2.0 * std::numbers::pi * (static_cast<double>(i % period) + 0.5) / period;
    image.values.push_back(static_cast<float>(0.5 + 0.4 * std::cos(phase)));
  }
  const GrayImage light = spread_light(image, profile, {subsamples, Surround::Repeat});
  double cosine = 0.0, sine = 0.0;
  for (std::size_t i = 0; i < light.columns; ++i) {
    const double phase = 2.0 * std::numbers::pi * (static_cast<double>(i) + 0.5) / static_cast<double>(light.columns);
    cosine += 2.0 / static_cast<double>(light.columns) * light.at(i, 4) * std::cos(phase);
    sine += 2.0 / static_cast<double>(light.columns) * light.at(i, 4) * std::sin(phase);
  }
  const Length wavelength = profile.pixel_pitch * static_cast<double>(period);
  const double x = std::numbers::pi / period, y = 2.0 * std::numbers::pi * 4.5 / wavelength.um();
  const double closed_form = std::sin(x) / x * std::exp(-y * y / 2.0);
  // Light beyond 5σ that was cut: 6e-7; float sums: 1e-7. A projection on the fundamental sees no alias.
  EXPECT_NEAR(cosine / 0.4, closed_form, 2e-6);
  EXPECT_NEAR(sine, 0.0, 2e-7);
  EXPECT_NEAR(pixel_transfer(profile, wavelength), closed_form, 1e-14);  // double rounding
}

TEST(SpreadLight, IsTheIntegralOfTheGaussianOverAnEdge) {
  PrinterProfile profile;  // σ = half a pixel
  GrayImage image{12, 1, std::vector<float>(12, 0.0F)};
  for (std::size_t i = 6; i < 12; ++i) image.values[i] = 1.0F;
  const GrayImage light = spread_light(image, profile, {4, Surround::Mirror});
  for (std::size_t i = 12; i < 36; ++i) {
    const double pixels_from_edge = (static_cast<double>(i) + 0.5) / 4.0 - 6.0;
    const double closed_form = 0.5 * std::erfc(-pixels_from_edge / 0.5 / std::numbers::sqrt2);
    EXPECT_NEAR(light.at(i, 2), closed_form, 1e-6);  // the cut at 5σ (6e-7) and float rounding
  }
}

TEST(SpreadLight, KeepsAllLightOfARepeatedTile) {
  PrinterProfile profile;
  for (const double sigma_um : {0.0, 1.0, 3.77, 20.0}) {
    profile.spread.width = Length::from_um(sigma_um);
    const GrayImage image = random_image(9, 5);  // narrower than the widest blur: it wraps around several times
    // Float taps and sums: 1e-7 each.
    EXPECT_NEAR(mean(spread_light(image, profile, {3, Surround::Repeat})), mean(image), 3e-7);
  }
}

TEST(SpreadLight, LosesLightIntoTheDark) {
  const PrinterProfile profile;
  const GrayImage white{6, 6, std::vector<float>(36, 1.0F)};
  const GrayImage dark = spread_light(white, profile, {2, Surround::Dark});
  // On the first sub-pixel's centre, a quarter pixel = σ/2 inside of the edge, Φ(½) of the light is left, per axis.
  const double inside = 0.5 * std::erfc(-0.5 / std::numbers::sqrt2);
  EXPECT_NEAR(dark.at(0, 5), inside, 1e-6);
  EXPECT_NEAR(dark.at(0, 0), inside * inside, 1e-6);
  const GrayImage mirror = spread_light(white, profile, {2, Surround::Mirror});
  for (const float value : mirror.values) EXPECT_NEAR(value, 1.0, 3e-7);  // float taps
}

TEST(SpreadLight, ContinuesByRepetitionOrByMirrors) {
  PrinterProfile profile;
  profile.spread.width = 9.0_um;
  const GrayImage image = random_image(7, 4);
  for (const Surround surround : {Surround::Repeat, Surround::Mirror}) {
    GrayImage tiled{21, 12, {}};
    for (std::size_t r = 0; r < 12; ++r) {
      for (std::size_t c = 0; c < 21; ++c) {
        const bool flip = surround == Surround::Mirror;
        const std::size_t column = flip && c / 7 != 1 ? 6 - c % 7 : c % 7;
        const std::size_t row = flip && r / 4 != 1 ? 3 - r % 4 : r % 4;
        tiled.values.push_back(image.at(column, row));
      }
    }
    const GrayImage small = spread_light(image, profile, {3, surround});
    const GrayImage large = spread_light(tiled, profile, {3, surround});
    for (std::size_t r = 0; r < small.rows; ++r) {
      // The same taps over the same values in the same order: equal bits.
      for (std::size_t c = 0; c < small.columns; ++c) EXPECT_EQ(small.at(c, r), large.at(c + 21, r + 12));
    }
  }
}

TEST(SpreadLight, KeepsASymmetricImageSymmetric) {
  const PrinterProfile profile;
  GrayImage image = random_image(8, 8);
  for (std::size_t r = 0; r < 8; ++r) {
    for (std::size_t c = 0; c < 8; ++c) {
      image.values[r * 8 + c] = image.at(std::min(c, 7 - c), std::min(r, 7 - r));
    }
  }
  for (const Surround surround : {Surround::Repeat, Surround::Mirror, Surround::Dark}) {
    const GrayImage light = spread_light(image, profile, {3, surround});
    for (std::size_t r = 0; r < 24; ++r) {
      for (std::size_t c = 0; c < 24; ++c) {
        // Summed from the other end: float rounding. A sample that is a tenth of a pixel off would differ by 1e-2.
        EXPECT_NEAR(light.at(c, r), light.at(23 - c, r), 3e-7);
        EXPECT_NEAR(light.at(c, r), light.at(c, 23 - r), 3e-7);
      }
    }
  }
}

TEST(SpreadLight, LeavesPixelsAloneWithoutBlur) {
  PrinterProfile profile;
  profile.spread.width = Length{};
  const GrayImage image = random_image(5, 3);
  const GrayImage light = spread_light(image, profile, {4, Surround::Dark});
  for (std::size_t r = 0; r < 12; ++r) {
    for (std::size_t c = 0; c < 20; ++c) EXPECT_EQ(light.at(c, r), image.at(c / 4, r / 4));
  }
}

TEST(SpreadLight, GivesTheSameBitsWithAnyNumberOfThreads) {
  const PrinterProfile profile;
  const GrayImage image = random_image(61, 47);
  const GrayImage many = spread_light(image, profile, {4, Surround::Mirror});
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  EXPECT_EQ(spread_light(image, profile, {4, Surround::Mirror}).values, many.values);
}

TEST(SpreadLight, RefusesWhatItCannotSampleBeforeItAllocates) {
  const PrinterProfile profile;
  const GrayImage image = random_image(4, 4);
  EXPECT_THROW((void)spread_light(image, profile, {0, Surround::Dark}), InvalidInput);
  EXPECT_THROW((void)spread_light(image, profile, {17, Surround::Dark}), InvalidInput);
  EXPECT_THROW((void)spread_light(GrayImage{4, 4, {0.5F}}, profile, {4, Surround::Dark}), InvalidInput);
  EXPECT_THROW((void)pixel_transfer(profile, Length{}), InvalidInput);
}

}  // namespace
}  // namespace mezzotint
