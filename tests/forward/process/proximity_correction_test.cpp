#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "forward/base/error.h"
#include "forward/pattern/pattern.h"
#include "forward/process/print_process.h"
#include "forward/process/proximity_correction.h"
#include "forward/process/proximity_solver.h"

namespace mezzotint {
namespace {

const PrinterProfile printer;

HeightField sampled(const Pattern& pattern, std::size_t columns, std::size_t rows, std::size_t samples,
                    double place_x = 0.5, double place_y = 0.5) {
  const Length pitch = printer.pixel_pitch / static_cast<double>(samples);
  return synthesize(pattern, {columns * samples, rows * samples, pitch, pitch}, {pitch * place_x, pitch * place_y});
}

HeightField constant(float height_um, std::size_t columns, std::size_t rows) {
  return HeightField({columns, rows, printer.pixel_pitch, printer.pixel_pitch}, Continuation::Mirrored,
                     std::vector<float>(columns * rows, height_um));
}

// Away from the edges, beyond which the pattern goes on while the mirror stands in the print.
double rms_difference(const HeightField& a, const HeightField& b, std::size_t border) {
  double squares = 0.0, count = 0.0;
  for (std::size_t r = border; r < a.rows() - border; ++r) {
    for (std::size_t c = border; c < a.columns() - border; ++c, ++count)
      squares += std::pow(double(a.at(c, r)) - double(b.at(c, r)), 2.0);
  }
  return std::sqrt(squares / count);
}

struct Design {
  std::string name;
  Pattern pattern;
  double times;  // by which the error must fall
};

// The designs of experiments/patterns. The study in tests/benchmark has 9.0, 2.9 and 5.3 times.
TEST(ProximityCorrection, LowersTheErrorOfDesignsWhereItNeverLooked) {
  constexpr std::size_t side = 96;
  const std::vector<Design> designs = {
      {"noise.toml", Noise{60.0_um, 2.5, 30.0_deg, 16.0_um}, 7.0},
      {"ridges.toml", Ridges{120.0_um, 30.0_deg, 16.0_um}, 2.4},
      {"brushed.toml", LineIntegralConvolution{30.0_um, 300.0_um, 30.0_deg, 16.0_um}, 4.0}};
  const ProcessOptions fresh{.subsamples = 5, .surround = Surround::Mirror, .place_x = 0.21, .place_y = 0.83};
  for (const auto& [name, pattern, times] : designs) {
    const HeightField wanted = sampled(pattern, side, side, 5, fresh.place_x, fresh.place_y);
    const GrayImage plain = quantize(expose(sampled(pattern, side, side, 1), printer).image, printer);
    const auto corrected = correct_proximity(sampled(pattern, side, side, 4), printer, {.subsamples = 4});
    const double before = rms_difference(print_layer(plain, printer, fresh), wanted, 20);
    const double after = rms_difference(print_layer(corrected.image, printer, fresh), wanted, 20);
    EXPECT_LT(after * times, before) << name;
    EXPECT_LT(corrected.error_after.um() * times, corrected.error_before.um()) << name;
    EXPECT_EQ(corrected.image.values, quantize(corrected.image, printer).values) << name;
  }
}

// The adjoint of the print, which the fixed point does not use, finds nothing to go down by.
TEST(ProximityCorrection, EndsWhereTheGradientVanishes) {
  constexpr std::size_t side = 48;
  const ProcessOptions options{.subsamples = 3};
  const HeightField wanted = sampled(Noise{60.0_um, 1.0, {}, 10.0_um}, side, side, 3);
  ProximityTile tile{side, side, {wanted.heights_um().begin(), wanted.heights_um().end()}, {}};
  for (float& height : tile.wanted_um) height += 3.0F;
  const PrintProcess process(side, side, printer, options);
  const auto steepest = [&](const GrayImage& image) {
    const HeightField printed = process.print(image);
    std::vector<float> errors(tile.wanted_um.size());
    for (std::size_t i = 0; i < errors.size(); ++i) errors[i] = printed.heights_um()[i] - tile.wanted_um[i];
    const std::vector<float> slopes = process.gray_slopes(image, errors);
    return std::sqrt(std::inner_product(slopes.begin(), slopes.end(), slopes.begin(), 0.0));
  };
  const double before = steepest(exposed(tile, printer));
  EXPECT_LT(steepest(solve_proximity(tile, printer, options, 60)), 0.02 * before);
}

TEST(ProximityCorrection, LeavesAUniformFieldAlone) {
  for (const float height : {0.0F, 3.0F, 17.0F, 30.0F}) {
    const HeightField wanted = constant(height, 20, 12);
    const auto corrected = correct_proximity(wanted, printer, {.subsamples = 2});
    const Exposure plain = expose(wanted, printer);
    EXPECT_EQ(corrected.image.values, quantize(plain.image, printer).values) << height;
    EXPECT_EQ(corrected.saturated, plain.saturated) << height;
    EXPECT_EQ(corrected.counts()[0], 240U) << height;
  }
}

TEST(ProximityCorrection, SaysWhatCannotBeReachedAndWhy) {
  HeightField spike = constant(0.0F, 15, 15);
  spike.at(7, 7) = 17.5F;
  const auto high = correct_proximity(spike, printer, {.subsamples = 4});
  EXPECT_EQ(high.unreached[7 * 15 + 7], Unreached::NeedsMoreLight);
  EXPECT_LT(high.residual_um[7 * 15 + 7], -1.0F);
  EXPECT_EQ(high.unreached[0], Unreached::None);

  HeightField hole = constant(15.0F, 15, 15);
  hole.at(7, 7) = 0.0F;
  const auto low = correct_proximity(hole, printer, {.subsamples = 4});
  EXPECT_EQ(low.unreached[7 * 15 + 7], Unreached::TooMuchLight);
  EXPECT_GT(low.residual_um[7 * 15 + 7], 1.0F);

  // Ridges of a pixel, sampled within it: full gray and darkness are far, but light does not end so sharply.
  HeightField fine = sampled(Ridges{printer.pixel_pitch, {}, 4.0_um}, 15, 15, 4);
  for (float& height : fine.heights_um()) height += 6.0F;
  const auto blurred = correct_proximity(fine, printer, {.subsamples = 4});
  EXPECT_EQ(blurred.counts()[static_cast<std::size_t>(Unreached::FinerThanBlur)], 225U);
}

// A picture in tiles against a part of it solved at once.
TEST(ProximityCorrection, TilesHaveNoSeams) {
  constexpr std::size_t side = 560;
  const HeightField wanted = sampled(Noise{60.0_um, 1.0, {}, 16.0_um}, side, side, 1);
  const ProcessOptions options{.subsamples = 2};
  const auto tiled = correct_proximity(wanted, printer, options, {.steps = 20});
  const auto whole = correct_proximity(crop(wanted, 150, 150, 150, 150), printer, options, {.steps = 20});
  float most = 0.0F;
  for (std::size_t r = 20; r < 130; ++r) {
    for (std::size_t c = 20; c < 130; ++c)
      most = std::max(most, std::abs(tiled.image.at(150 + c, 150 + r) - whole.image.at(c, r)));
  }
  EXPECT_LE(most, 1.5F / 255.0F);
}

TEST(ProximityCorrection, KnowsWhatSurroundsThePicture) {
  const HeightField wanted = constant(12.0F, 560, 560);
  for (const Surround surround : {Surround::Mirror, Surround::Repeat, Surround::Dark}) {
    const auto corrected = correct_proximity(wanted, printer, {.subsamples = 2, .surround = surround}, {.steps = 20});
    const float inside = corrected.image.at(280, 280), edge = corrected.image.at(0, 280);
    EXPECT_NEAR(inside, height_to_gray(printer.cure, 12.0_um), 0.01);
    // Where nothing shines in from outside, the edge gives more itself.
    if (surround == Surround::Dark)
      EXPECT_GT(edge, inside + 0.1F);
    else
      EXPECT_EQ(edge, inside);
  }
}

TEST(ProximityCorrection, HasTheSameBitsWithAnyNumberOfThreads) {
  const HeightField wanted = sampled(Noise{60.0_um, 1.0, {}, 16.0_um}, 540, 520, 1);
  std::vector<GrayImage> images;
  for (const std::size_t threads : {1U, 3U}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    images.push_back(correct_proximity(wanted, printer, {.subsamples = 2}, {.steps = 4}).image);
  }
  EXPECT_EQ(images[0].values, images[1].values);
}

TEST(ProximityCorrection, CorrectsUnderALorentzianToo) {
  PrinterProfile stray = printer;
  stray.spread = {PixelSpread::Kernel::Lorentzian, 1.5_um};
  const HeightField wanted = sampled(Noise{60.0_um, 1.0, {}, 14.0_um}, 64, 64, 3);
  const auto corrected = correct_proximity(wanted, stray, {.subsamples = 3});
  EXPECT_LT(2.0 * corrected.error_after.um(), corrected.error_before.um());
}

TEST(ProximityCorrection, RefusesReliefsOfAnotherShape) {
  EXPECT_THROW((void)correct_proximity(sampled(Ridges{}, 8, 8, 3), printer, {.subsamples = 4}), InvalidInput);
  HeightField missing = constant(1.0F, 4, 4);
  missing.at(1, 1) = std::nanf("");
  EXPECT_THROW((void)correct_proximity(missing, printer, {}), InvalidInput);
  EXPECT_THROW((void)correct_proximity(constant(1.0F, 4, 4), printer, {}, {.tolerance = Length{}}), InvalidInput);
}

}  // namespace
}  // namespace mezzotint
