#include "forward/base/fft.h"

#include <cmath>
#include <numbers>
#include <thread>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "forward/base/error.h"
#include "forward/base/random.h"

namespace mezzotint {
namespace {

// Round-off of a transform of N samples of size 1 grows like ε·log N, about 3e-15 here; 1e-12 is far
// above it, and far below any mistake in sign or scale.
constexpr double round_off = 1e-12;

void fill_with_noise(std::span<double> values, std::uint64_t seed) {
  const RandomStream random(seed, RandomPurpose::Test);
  for (std::size_t k = 0; k < values.size(); ++k) values[k] = random.normal4(k)[0];
}

TEST(RealFft2d, PutsACosineAtItsFrequency) {
  constexpr std::size_t columns = 30, rows = 20, kx = 4, ky = 3;
  constexpr double phase = 0.7;
  RealFft2d fft(columns, rows);
  for (std::size_t r = 0; r < rows; ++r) {
    for (std::size_t c = 0; c < columns; ++c) {
      const double turns = double(kx * c) / columns + double(ky * r) / rows;
      fft.real()[r * columns + c] = std::cos(2.0 * std::numbers::pi * turns + phase);
    }
  }
  fft.forward();
  for (std::size_t r = 0; r < rows; ++r) {
    for (std::size_t c = 0; c < fft.spectrum_columns(); ++c) {
      // cos(a) = (e^{ia} + e^{−ia})/2; the second half lies at (−kx, −ky), outside of what is stored.
      const std::complex<double> expected =
          c == kx && r == ky ? std::polar(0.5 * columns * rows, phase) : std::complex<double>{};
      EXPECT_NEAR(std::abs(fft.spectrum()[r * fft.spectrum_columns() + c] - expected), 0.0, 600 * round_off);
    }
  }
}

TEST(RealFft2d, KeepsTheEnergyAfterParseval) {
  for (const auto& [columns, rows] : {std::pair<std::size_t, std::size_t>{24, 15}, {25, 16}, {1, 9}}) {
    RealFft2d fft(columns, rows);
    fill_with_noise(fft.real(), 1);
    double in_space = 0.0;
    for (const double value : fft.real()) in_space += value * value;
    fft.forward();
    double in_frequency = 0.0;
    for (std::size_t k = 0; k < fft.spectrum().size(); ++k) {
      in_frequency += fft.weight(k % fft.spectrum_columns()) * std::norm(fft.spectrum()[k]);
    }
    EXPECT_NEAR(in_frequency / double(columns * rows), in_space, in_space * round_off);
  }
}

TEST(RealFft2d, ComesBackToWhereItStarted) {
  RealFft2d fft(54, 37);
  fill_with_noise(fft.real(), 2);
  const std::vector<double> before(fft.real().begin(), fft.real().end());
  fft.forward();
  fft.inverse();
  for (std::size_t k = 0; k < before.size(); ++k) EXPECT_NEAR(fft.real()[k], before[k], round_off);
}

TEST(RealFft2d, ForwardLeavesItsInputAlone) {
  RealFft2d fft(16, 18);
  fill_with_noise(fft.real(), 3);
  const std::vector<double> before(fft.real().begin(), fft.real().end());
  fft.forward();
  EXPECT_TRUE(std::equal(before.begin(), before.end(), fft.real().begin()));
}

TEST(RealFft2d, GivesTheSameBitsInEveryThread) {
  const auto transformed = [] {
    RealFft2d fft(120, 96);
    fill_with_noise(fft.real(), 4);
    fft.forward();
    return std::vector<std::complex<double>>(fft.spectrum().begin(), fft.spectrum().end());
  };
  const auto alone = transformed();
  std::vector<std::vector<std::complex<double>>> together(4);
  std::vector<std::thread> threads;
  for (auto& result : together) threads.emplace_back([&] { result = transformed(); });
  for (auto& thread : threads) thread.join();
  for (const auto& result : together) EXPECT_EQ(result, alone);
}

TEST(RealFft2d, RefusesASideItCannotHold) {
  EXPECT_THROW(RealFft2d(0, 8), InvalidInput);
  EXPECT_THROW(RealFft2d(8, 65537), InvalidInput);
}

TEST(QuickFftLength, IsTheNextEvenLengthWithoutLargeFactors) {
  EXPECT_EQ(quick_fft_length(1), 2U);
  EXPECT_EQ(quick_fft_length(7), 8U);
  EXPECT_EQ(quick_fft_length(31), 32U);
  EXPECT_EQ(quick_fft_length(97), 100U);
  EXPECT_EQ(quick_fft_length(1022), 1024U);
}

}  // namespace
}  // namespace mezzotint
