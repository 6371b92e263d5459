#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "forward/base/error.h"
#include "forward/base/random.h"
#include "forward/process/print_process.h"

namespace mezzotint {
namespace {

constexpr std::size_t columns = 11, rows = 8;

std::vector<float> random_values(std::size_t count, double low, double high, std::uint64_t seed) {
  std::vector<float> values;
  const RandomStream stream(seed, RandomPurpose::Test);
  for (std::size_t i = 0; i < count; ++i)
    values.push_back(static_cast<float>(low + (high - low) * stream.uniform4(i)[0]));
  return values;
}

// All light between the threshold (.167) and full gray, so that J is smooth.
GrayImage curing_image() { return {columns, rows, random_values(columns * rows, 0.35, 0.95, 3)}; }

struct Case {
  std::string name;
  PixelSpread spread;
  Surround surround;
};
std::vector<Case> cases() {
  const auto gaussian = PixelSpread::Kernel::Gaussian, lorentzian = PixelSpread::Kernel::Lorentzian;
  return {{"Gaussian, mirrored", {gaussian, 4.0_um}, Surround::Mirror},
          {"Gaussian, repeated", {gaussian, 9.0_um}, Surround::Repeat},
          {"Gaussian, dark", {gaussian, 2.0_um}, Surround::Dark},
          {"Lorentzian, mirrored", {lorentzian, 3.0_um}, Surround::Mirror},
          {"Lorentzian, repeated", {lorentzian, 5.0_um}, Surround::Repeat},
          {"Lorentzian, dark", {lorentzian, 1.0_um}, Surround::Dark}};
}

// J = Σ slope · height: its gradient toward heights is `slopes` everywhere.
double j_of(const GrayImage& image, const PrinterProfile& profile, const ProcessOptions& options,
            const std::vector<float>& slopes) {
  const HeightField relief = print_layer(image, profile, options);
  double sum = 0.0;
  for (std::size_t i = 0; i < slopes.size(); ++i) sum += double(slopes[i]) * double(relief.heights_um()[i]);
  return sum;
}

TEST(PrintProcess, TellsTheSlopeTowardEveryGrayValue) {
  for (const Case& c : cases()) {
    PrinterProfile profile;
    profile.spread = c.spread;
    const ProcessOptions options{3, c.surround};
    const std::vector<float> slopes = random_values(9 * columns * rows, -1.0, 1.0, 5);
    const GrayImage image = curing_image();
    const std::vector<float> gradient = PrintProcess(columns, rows, profile, options).gray_slopes(image, slopes);
    // Along random directions, by Richardson's extrapolation of central differences (fourth order: (0.04/0.4)⁴/5 of the
    // third-order term). Heights are floats: their rounding, 1e-6 µm in each of 800 samples with random signs, makes
    // 3e-5/0.04 = 8e-4 of slopes whose norm is some 50: 2e-5 of it.
    for (const std::uint64_t seed : {21U, 22U, 23U}) {
      const std::vector<float> direction = random_values(image.values.size(), -1.0, 1.0, seed);
      const auto difference = [&](float step) {
        GrayImage up = image, down = image;
        for (std::size_t i = 0; i < direction.size(); ++i) {
          up.values[i] += step * direction[i];
          down.values[i] -= step * direction[i];
        }
        return (j_of(up, profile, options, slopes) - j_of(down, profile, options, slopes)) / (2.0 * double(step));
      };
      const double expected = (4.0 * difference(0.02F) - difference(0.04F)) / 3.0;
      double found = 0.0, size = 0.0;
      for (std::size_t i = 0; i < direction.size(); ++i) {
        found += double(gradient[i]) * double(direction[i]);
        size += std::pow(double(gradient[i]), 2);
      }
      EXPECT_NEAR(found, expected, 1e-4 * std::sqrt(size)) << c.name;
    }
  }
}

TEST(PrintProcess, TellsTheSlopeTowardCureCurveAndBlur) {
  for (const Case& c : cases()) {
    PrinterProfile profile;
    profile.spread = c.spread;
    const ProcessOptions options{3, c.surround};
    const std::vector<float> slopes = random_values(9 * columns * rows, 0.2, 1.0, 5);
    const GrayImage image = curing_image();
    const ProfileSlopes gradient = PrintProcess(columns, rows, profile, options).profile_slopes(image, slopes);
    const auto difference = [&](double step, const auto& change) {
      PrinterProfile up = profile, down = profile;
      change(up, step);
      change(down, -step);
      return (j_of(image, up, options, slopes) - j_of(image, down, options, slopes)) / (2.0 * step);
    };
    const auto richardson = [&](double step, const auto& change) {
      return (4.0 * difference(step, change) - difference(2.0 * step, change)) / 3.0;
    };
    // Float heights and taps leave 1e-5 to 3e-5 of J's differences.
    const auto near = [&](double found, double expected, const char* what) {
      EXPECT_NEAR(found, expected, 1e-4 * std::abs(expected)) << c.name << ": " << what;
    };
    if (c.surround == Surround::Dark) continue;  // the threshold's cliff runs along its edges
    near(gradient.alpha_um,
         richardson(0.02, [](PrinterProfile& p, double d) { p.cure.alpha = p.cure.alpha + Length::from_um(d); }),
         "alpha");
    near(gradient.beta_um,
         richardson(0.1, [](PrinterProfile& p, double d) { p.cure.beta = p.cure.beta + Length::from_um(d); }), "beta");
    near(gradient.gamma, richardson(0.01, [](PrinterProfile& p, double d) { p.cure.gamma += d; }), "gamma");
    near(gradient.width_um,
         richardson(0.2, [](PrinterProfile& p, double d) { p.spread.width = p.spread.width + Length::from_um(d); }),
         "width");
  }
}

TEST(PrintProcess, ItsSlopesAreThoseOfTheRelief) {
  for (const Case& c : cases()) {
    if (c.surround == Surround::Dark) continue;  // the threshold's cliff runs along its edges
    PrinterProfile profile;
    profile.spread = c.spread;
    const GrayImage image = curing_image();
    const auto at = [&](double place_x, double place_y) {
      return PrintProcess(columns, rows, profile, {2, c.surround, place_x, place_y});
    };
    const ReliefSlopes slopes = at(0.3, 0.6).slopes(image);
    const HeightField left = at(0.25, 0.6).print(image), right = at(0.35, 0.6).print(image);
    const HeightField low = at(0.3, 0.55).print(image), high = at(0.3, 0.65).print(image);
    const double way_um = 0.1 * 7.54 / 2.0;
    // Float heights (2e-6 µm over 0.38 µm) and the third derivative, (0.19/σ)²/6 of slopes of about 1.
    for (std::size_t i = 0; i < slopes.x.size(); ++i) {
      ASSERT_NEAR(slopes.x[i], (right.heights_um()[i] - left.heights_um()[i]) / way_um, 4e-3) << c.name;
      ASSERT_NEAR(slopes.y[i], (high.heights_um()[i] - low.heights_um()[i]) / way_um, 4e-3) << c.name;
    }
  }
}

TEST(PrintProcess, LeadsBackFromSlopesToEveryGrayValue) {
  for (const Case& c : cases()) {
    PrinterProfile profile;
    profile.spread = c.spread;
    const PrintProcess process(columns, rows, profile, {3, c.surround, 0.2, 0.9});
    const ReliefSlopes toward{random_values(9 * columns * rows, -1.0, 1.0, 5),
                              random_values(9 * columns * rows, -1.0, 1.0, 6)};
    const GrayImage image = curing_image();
    const std::vector<float> gradient = process.gray_slopes(image, toward);
    const auto j = [&](const GrayImage& gray) {
      const ReliefSlopes slopes = process.slopes(gray);
      double sum = 0.0;
      for (std::size_t i = 0; i < slopes.x.size(); ++i)
        sum += double(toward.x[i]) * double(slopes.x[i]) + double(toward.y[i]) * double(slopes.y[i]);
      return sum;
    };
    const std::vector<float> direction = random_values(image.values.size(), -1.0, 1.0, 21);
    const auto difference = [&](float step) {
      GrayImage up = image, down = image;
      for (std::size_t i = 0; i < direction.size(); ++i) {
        up.values[i] += step * direction[i];
        down.values[i] -= step * direction[i];
      }
      return (j(up) - j(down)) / (2.0 * double(step));
    };
    const double expected = (4.0 * difference(0.01F) - difference(0.02F)) / 3.0;
    double found = 0.0, size = 0.0;
    for (std::size_t i = 0; i < direction.size(); ++i) {
      found += double(gradient[i]) * double(direction[i]);
      size += std::pow(double(gradient[i]), 2);
    }
    EXPECT_NEAR(found, expected, 1e-4 * std::sqrt(size)) << c.name;
  }
}

TEST(PrintProcess, StandsStillWhereNothingCuresAndWhereTheLayerEnds) {
  PrinterProfile profile;
  profile.cure = scale_exposure(profile.cure, 3.0);  // the layer of 18 µm is full at gray .34
  const PrintProcess process(columns, rows, profile, {2, Surround::Mirror});
  const std::vector<float> slopes(4 * columns * rows, 1.0F);
  for (const float gray : {0.02F, 0.9F}) {
    const GrayImage even{columns, rows, std::vector<float>(columns * rows, gray)};
    const std::vector<float> gradient = process.gray_slopes(even, slopes);
    for (const float slope : gradient) EXPECT_EQ(slope, 0.0F);
    EXPECT_EQ(process.profile_slopes(even, slopes).alpha_um, 0.0);
    EXPECT_EQ(process.profile_slopes(even, slopes).width_um, 0.0);
  }
}

TEST(PrintProcess, ReproducesTheCureCurveOnAWedgeWhateverTheBlur) {
  for (const Case& c : cases()) {
    if (c.surround == Surround::Dark) continue;
    PrinterProfile profile;
    profile.spread = c.spread;
    const PrintProcess process(columns, rows, profile, {2, c.surround});
    for (int level = 43; level <= 255; level += 4) {
      const GrayImage even{columns, rows, std::vector<float>(columns * rows, static_cast<float>(level / 255.0))};
      const double curve_um = 17.71 + 10.24 * std::log(level / 255.0 + 0.01);
      const HeightField printed = process.print(even);
      // Float light (1e-7, times 58 µm of slope at the threshold) and a float logarithm.
      for (const float height : printed.heights_um()) ASSERT_NEAR(height, curve_um, 1e-5) << c.name;
    }
  }
}

TEST(PrintProcess, MovesAlphaByBetaTimesTheLogarithmOfTheExposure) {
  PrinterProfile profile;
  profile.spread = {PixelSpread::Kernel::Lorentzian, 2.0_um};
  profile.layer = 100.0_um;
  PrinterProfile longer = profile;
  longer.cure = scale_exposure(profile.cure, 2.0);
  const ProcessOptions options{2, Surround::Mirror};
  const HeightField once = print_layer(curing_image(), profile, options);
  const HeightField twice = print_layer(curing_image(), longer, options);
  for (std::size_t i = 0; i < once.grid().size(); ++i)
    ASSERT_NEAR(twice.heights_um()[i] - once.heights_um()[i], 10.24 * std::log(2.0), 1e-5);  // two float heights
}

TEST(PrintProcess, LeadsTheSlopeBackToTheWantedHeights) {
  // expose() is the inverse curve: without blur the print of a wanted height is that height, so the slopes come back.
  PrinterProfile profile;
  profile.spread.width = Length{};
  const std::vector<float> wanted = random_values(columns * rows, 1.0, 17.0, 8);
  const HeightField heights({columns, rows, 7.54_um, 7.54_um}, Continuation::Mirrored, wanted);
  const GrayImage gray = expose(heights, profile).image;
  const std::vector<float> slopes = random_values(columns * rows, -1.0, 1.0, 9);
  const PrintProcess process(columns, rows, profile, {1, Surround::Mirror});
  const std::vector<float> back = wanted_height_slopes(heights, gray, profile, process.gray_slopes(gray, slopes));
  for (std::size_t i = 0; i < slopes.size(); ++i) EXPECT_NEAR(back[i], slopes[i], 1e-5);  // float gray near γ
}

TEST(PrintProcess, HasNoSlopeTowardHeightsOutOfReach) {
  const PrinterProfile profile;  // reaches 17.81 µm
  const HeightField heights({2, 1, 7.54_um, 7.54_um}, Continuation::Mirrored, {0.0F, 17.9F});
  const GrayImage gray = expose(heights, profile).image;
  for (const float slope : wanted_height_slopes(heights, gray, profile, std::vector<float>{1.0F, 1.0F}))
    EXPECT_EQ(slope, 0.0F);
}

TEST(PrintProcess, GivesTheSameBitsWithAnyNumberOfThreads) {
  for (const Case& c : cases()) {
    PrinterProfile profile;
    profile.spread = c.spread;
    const PrintProcess process(columns, rows, profile, {3, c.surround});
    const std::vector<float> slopes = random_values(9 * columns * rows, -1.0, 1.0, 5);
    const std::vector<float> gray = process.gray_slopes(curing_image(), slopes);
    const ProfileSlopes of_profile = process.profile_slopes(curing_image(), slopes);
    const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
    EXPECT_EQ(process.gray_slopes(curing_image(), slopes), gray) << c.name;
    EXPECT_EQ(process.profile_slopes(curing_image(), slopes).width_um, of_profile.width_um) << c.name;
    EXPECT_EQ(process.profile_slopes(curing_image(), slopes).beta_um, of_profile.beta_um) << c.name;
  }
}

TEST(PrintProcess, RefusesAnImageOfAnotherSize) {
  const PrintProcess process(columns, rows, {}, {2, Surround::Mirror});
  EXPECT_THROW((void)process.print({rows, columns, std::vector<float>(columns * rows, 0.5F)}), InvalidInput);
  EXPECT_THROW((void)process.gray_slopes(curing_image(), std::vector<float>(7)), InvalidInput);
}

}  // namespace
}  // namespace mezzotint
