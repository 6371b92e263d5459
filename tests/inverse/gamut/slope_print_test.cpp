#include "inverse/gamut/slope_print.h"

#include <cmath>

#include <gtest/gtest.h>

#include "forward/base/error.h"

namespace mezzotint {
namespace {

PrinterProfile without_blur() {
  PrinterProfile printer;
  printer.pixel_pitch = 0.01_um;
  printer.spread.width = Length{};
  return printer;
}

// Pixels that are fine against every wave take nothing away: what is left is the pattern's own closed form.
TEST(SlopeSpectrum, IsThePatternsOwnWithoutPixelsAndBlur) {
  const LineIntegralConvolution lines{.scale = 40.0_um, .length = 100.0_um};
  const std::vector<Pattern> patterns = {Noise{.stretch = 3.0}, FractionalBrownianMotion{}, lines,
                                         Sinusoid{.wavelength_v = 70.0_um}, Ridges{.skew = 0.3}};
  for (const Pattern& pattern : patterns) {
    const AxisSquares squares = linear_print_slopes(pattern, without_blur());
    const SlopeCovariance ideal = closed_form_slope_covariance(pattern).value();
    // Forty harmonics hold 98 % of the slopes of ridges; the sums over waves of noise are good to 1 %.
    EXPECT_NEAR(squares.u / ideal.xx, 1.0, 0.025) << kind_name(pattern);
    if (ideal.yy > 0.0) {
      EXPECT_NEAR(squares.v / ideal.yy, 1.0, 0.025) << kind_name(pattern);
    }
  }
}

TEST(SlopeSpectrum, LosesAsASingleWaveDoes) {
  const PrinterProfile printer;
  const Sinusoid wave{.wavelength_u = 60.0_um, .wavelength_v = 45.0_um};
  const double kept = std::pow(pixel_transfer(printer, 60.0_um) * pixel_transfer(printer, 45.0_um), 2);
  const SlopeCovariance ideal = closed_form_slope_covariance(wave).value();
  const AxisSquares squares = linear_print_slopes(wave, printer);
  EXPECT_NEAR(squares.u, kept * ideal.xx, 1e-9);
  EXPECT_NEAR(squares.v, kept * ideal.yy, 1e-9);
}

TEST(SlopeSpectrum, HasNoneOfWhatDependsOnThePlace) {
  EXPECT_THROW((void)linear_print_slopes(Turbulence{}, PrinterProfile{}), InvalidInput);
  EXPECT_THROW((void)linear_print_slopes(PatternProduct{}, PrinterProfile{}), InvalidInput);
}

// A patch of 96 pixels against one of 512: its own draw would be off by several times that (12 × 6 cells of noise).
TEST(SlopePrint, TellsALargePrintFromASmallPatch) {
  const PrinterProfile printer;
  const SlopePrint small(printer, {96, 3, 2, 1}), large(printer, {512, 3, 2, 9});
  for (const Pattern& pattern : {Pattern(Noise{.scale = 60.0_um, .stretch = 2.0}), Pattern(Sinusoid{}),
                                 Pattern(Ridges{.wavelength = 50.0_um, .skew = 0.4})}) {
    const AxisSquares a = small.squares(pattern).mean, b = large.squares(pattern).mean;
    EXPECT_NEAR(a.u / b.u, 1.0, 0.03) << kind_name(pattern);
    if (b.v > 1e-9) {
      EXPECT_NEAR(a.v / b.v, 1.0, 0.03) << kind_name(pattern);
    }
  }
}

TEST(SlopePrint, HasNoSlopesAcrossRidges) {
  const PrintedSquares squares = SlopePrint(PrinterProfile{}, {}).squares(Ridges{});
  EXPECT_LT(squares.mean.v, 1e-9);
  EXPECT_GT(squares.mean.u, 0.01);
}

}  // namespace
}  // namespace mezzotint
