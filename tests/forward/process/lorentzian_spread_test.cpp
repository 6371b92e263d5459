#include <array>
#include <cmath>
#include <numbers>
#include <numeric>
#include <vector>

#include <gtest/gtest.h>

#include "forward/base/random.h"
#include "forward/process/printed_relief.h"

namespace mezzotint {
namespace {

constexpr double pitch_um = 7.54;

PrinterProfile lorentzian(double width_pixels) {
  PrinterProfile profile;
  profile.spread = {PixelSpread::Kernel::Lorentzian, Length::from_um(width_pixels * pitch_um)};
  return profile;
}

GrayImage random_image(std::size_t columns, std::size_t rows) {
  GrayImage image{columns, rows, {}};
  const RandomStream stream(11, RandomPurpose::Test);
  for (std::size_t i = 0; i < columns * rows; ++i) image.values.push_back(static_cast<float>(stream.uniform4(i)[0]));
  return image;
}

TEST(LorentzianSpread, IsTheIntegralOfTheKernelOverAPixel) {
  const double w = 0.4;
  GrayImage image{9, 7, std::vector<float>(63, 0.0F)};
  image.values[3 * 9 + 4] = 1.0F;
  const GrayImage light = spread_light(image, lorentzian(w), {3, Surround::Dark});
  // By the midpoint rule over the lit pixel: h²/24·∇²k·area, with ∇²k ≤ 6/(2π w⁴): 4e-6 of at most 0.6 at h = 1/200.
  const auto kernel_over_pixel = [w](double x, double y) {
    double sum = 0.0;
    constexpr int steps = 200;
    for (int j = 0; j < steps; ++j) {
      for (int i = 0; i < steps; ++i) {
        const double dx = 4.0 + (i + 0.5) / steps - x, dy = 3.0 + (j + 0.5) / steps - y;
        sum += w / (2.0 * std::numbers::pi * std::pow(dx * dx + dy * dy + w * w, 1.5));
      }
    }
    return sum / (steps * steps);
  };
  for (const auto& [column, row] :
       std::vector<std::array<std::size_t, 2>>{{13, 10}, {12, 9}, {16, 11}, {0, 0}, {26, 3}})
    EXPECT_NEAR(light.at(column, row), kernel_over_pixel((double(column) + 0.5) / 3.0, (double(row) + 0.5) / 3.0),
                1e-5);
}

TEST(LorentzianSpread, SeesAnEdgeAsAnArcTangent) {
  // Across a straight edge the kernel's marginal counts: ½ + atan(x/w)/π. The mirrors put another edge 256 pixels away
  // on either side, each of which changes the light by w/(π·256); on this edge the two cancel.
  const double w = 0.5;
  GrayImage image{512, 3, std::vector<float>(3 * 512, 0.0F)};
  for (std::size_t i = 0; i < image.values.size(); ++i) image.values[i] = i % 512 >= 256 ? 1.0F : 0.0F;
  const GrayImage light = spread_light(image, lorentzian(w), {2, Surround::Mirror});
  for (const int from_edge : {-40, -5, -1, 0, 1, 4, 30}) {
    const auto sample = static_cast<std::size_t>(512 + from_edge);
    const double x = (from_edge + 0.5) / 2.0;
    EXPECT_NEAR(light.at(sample, 3), 0.5 + std::atan(x / w) / std::numbers::pi, 2.0 * w / (std::numbers::pi * 256.0));
  }
}

TEST(LorentzianSpread, AttenuatesAWaveByTheExponentialOfItsFrequency) {
  constexpr std::size_t period = 8, subsamples = 16;  // so fine that no alias is left
  for (const double w : {0.2, 0.5, 1.3}) {
    GrayImage image{period, 3, {}};
    for (std::size_t i = 0; i < period * 3; ++i) {
      const double phase = 2.0 * std::numbers::pi * (static_cast<double>(i % period) + 0.5) / period;
      image.values.push_back(static_cast<float>(0.5 + 0.4 * std::cos(phase)));
    }
    const PrinterProfile profile = lorentzian(w);
    for (const Surround surround : {Surround::Repeat, Surround::Mirror}) {  // a whole cosine is its own mirror image
      const GrayImage light = spread_light(image, profile, {subsamples, surround});
      double cosine = 0.0;
      for (std::size_t i = 0; i < light.columns; ++i) {
        const double phase = 2.0 * std::numbers::pi * (static_cast<double>(i) + 0.5) / double(light.columns);
        cosine += 2.0 / double(light.columns) * double(light.at(i, 7)) * std::cos(phase);
      }
      const double x = std::numbers::pi / period;
      const double closed_form = std::sin(x) / x * std::exp(-2.0 * std::numbers::pi * w / period);
      EXPECT_NEAR(cosine / 0.4, closed_form, 2e-6) << w;
      EXPECT_NEAR(pixel_transfer(profile, profile.pixel_pitch * double(period)), closed_form, 1e-14);
    }
  }
}

TEST(LorentzianSpread, LeavesAnEvenImageAsItIs) {
  const GrayImage even{10, 6, std::vector<float>(60, 0.37F)};
  for (const Surround surround : {Surround::Repeat, Surround::Mirror}) {
    for (const float value : spread_light(even, lorentzian(0.7), {4, surround}).values)
      EXPECT_NEAR(value, 0.37, 1e-7);  // float
  }
}

TEST(LorentzianSpread, ContinuesByRepetitionOrByMirrors) {
  const GrayImage image = random_image(7, 4);
  for (const Surround surround : {Surround::Repeat, Surround::Mirror}) {
    GrayImage tiled{63, 36, {}};
    for (std::size_t r = 0; r < 36; ++r) {
      for (std::size_t c = 0; c < 63; ++c) {
        const bool flip_x = surround == Surround::Mirror && (c / 7) % 2 == 1;
        const bool flip_y = surround == Surround::Mirror && (r / 4) % 2 == 1;
        tiled.values.push_back(image.at(flip_x ? 6 - c % 7 : c % 7, flip_y ? 3 - r % 4 : r % 4));
      }
    }
    const GrayImage small = spread_light(image, lorentzian(0.5), {3, surround});
    const GrayImage large = spread_light(tiled, lorentzian(0.5), {3, surround});
    double worst = 0.0;
    for (std::size_t r = 0; r < small.rows; ++r) {
      for (std::size_t c = 0; c < small.columns; ++c)
        worst = std::max(worst, std::abs(double(small.at(c, r)) - double(large.at(c + 4 * 21, r + 4 * 12))));
    }
    EXPECT_LT(worst, 1e-6);  // as promised; one copy more or less would be off by 1e-4
  }
}

}  // namespace
}  // namespace mezzotint
