#include "inverse/verification/printed_draw.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "forward/surface/slope_covariance.h"

namespace mezzotint {
namespace {

GrayImage flat_image(std::size_t side) { return {side, side, std::vector<float>(side * side, 0.7F)}; }

double rms(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) sum += value * value;
  return std::sqrt(sum / static_cast<double>(values.size()));
}

TEST(PrintedDraw, TheGroundOfATileClosesAndKeepsItsRoughness) {
  const PrinterProfile printer;
  std::vector<double> across_seam, anywhere;
  double variance = 0.0;
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    const HeightField relief =
        print_draw(flat_image(64), printer, {.subsamples = 3, .surround = Surround::Repeat}, seed);
    ASSERT_TRUE(relief.periodic());
    for (std::size_t row = 0; row < relief.rows(); ++row) {
      across_seam.push_back(relief.at(0, row) - relief.at(relief.columns() - 1, row));
      across_seam.push_back(relief.at(row, 0) - relief.at(row, relief.rows() - 1));
      anywhere.push_back(relief.at(60, row) - relief.at(59, row));
      anywhere.push_back(relief.at(row, 60) - relief.at(row, 59));
    }
    const SlopeCovariance covariance = slope_covariance(relief);
    variance += (covariance.xx + covariance.yy) / 16.0;
  }
  // 16 lines of some 10 grains each: their RMS is known to 10 %.
  EXPECT_NEAR(rms(across_seam) / rms(anywhere), 1.0, 0.35);
  // Closed form; 8 tiles of 10 × 10 grains.
  const double expected = ground_rms_slope(printer, split_ground(printer, 550.0_nm).geometric);
  EXPECT_NEAR(std::sqrt(variance) / expected, 1.0, 0.06);
}

TEST(PrintedDraw, IsTheLayerWhereThereIsNoGround) {
  PrinterProfile printer;
  printer.ground_amplitude = Length{};
  const HeightField relief = print_draw(flat_image(16), printer, {.subsamples = 2}, 3);
  EXPECT_FALSE(relief.periodic());
  // 0.7 is no level of the printer; 179/255 is, 178.5 being rounded away from 0.
  const double gray = std::round(0.7F * 255.0) / 255.0;
  for (const float z : relief.heights_um()) ASSERT_NEAR(z, gray_to_height(printer.cure, gray).um(), 2e-5);
}

TEST(PrintedDraw, OtherSeedsHaveOtherGroundsAndPlaces) {
  GrayImage edge = flat_image(16);
  for (std::size_t i = 0; i < 8; ++i) edge.values[i] = 0.3F;
  PrinterProfile printer;
  printer.ground_amplitude = Length{};
  const auto print = [&](std::uint64_t seed) { return print_draw(edge, printer, {.subsamples = 2}, seed); };
  EXPECT_TRUE(std::ranges::equal(print(1).heights_um(), print(1).heights_um()));
  EXPECT_FALSE(std::ranges::equal(print(1).heights_um(), print(2).heights_um()));
}

}  // namespace
}  // namespace mezzotint
