#include "fabrication/job/layer_png.h"

#include <algorithm>
#include <string>

#include <gtest/gtest.h>

#include "fabrication/job/huffman_code.h"
#include "fabrication/job/png_picture.h"
#include "forward/base/random.h"

namespace mezzotint {
namespace {

using Pixels = std::vector<std::uint8_t>;

// libpng (by OpenImageIO) is the judge: it checks the structure and both checksums.
void expect_round_trip(const Pixels& gray, std::size_t columns, std::size_t rows) {
  const LayerPicture picture = to_runs(gray, columns, rows);
  ASSERT_EQ(to_pixels(picture), gray);
  const std::string png = encode_layer_png(picture);
  Pixels decoded = decode_gray_png(std::as_bytes(std::span(png)), columns, rows, {"job.uvj", "slice"});
  for (std::size_t row = 0; row < rows / 2; ++row) {
    const auto low = decoded.begin() + static_cast<long>(row * columns);
    std::swap_ranges(low, low + static_cast<long>(columns),
                     decoded.begin() + static_cast<long>((rows - 1 - row) * columns));
  }
  ASSERT_TRUE(decoded == gray) << columns << " x " << rows;
}

TEST(LayerPng, KeepsPicturesWithoutContrast) {
  for (const auto& [columns, rows] : {std::pair{1U, 1U}, {2U, 1U}, {1U, 7U}, {259U, 3U}, {2560U, 1600U}}) {
    for (const int level : {0, 1, 254, 255})
      expect_round_trip(Pixels(columns * rows, static_cast<std::uint8_t>(level)), columns, rows);
  }
}

TEST(LayerPng, KeepsRandomPicturesOfAllKinds) {
  for (std::uint64_t trial = 0; trial < 300; ++trial) {
    const RandomStream random(trial, RandomPurpose::Test);
    const auto setting = random.uniform4(0);
    const auto columns = 1 + static_cast<std::size_t>(setting[0] * 700.0);
    const auto rows = 1 + static_cast<std::size_t>(setting[1] * 60.0);
    const double go_on = setting[2] < 0.3 ? 0.0 : 1.0 - setting[2] * setting[2] * 0.1;
    const double repeat_row = setting[3];
    Pixels gray(columns * rows);
    std::uint8_t level = 0;
    for (std::size_t i = 0; i < gray.size(); ++i) {
      const auto draw = random.uniform4(i + 1);
      if (draw[0] >= go_on) level = draw[1] < 0.6 ? 0 : static_cast<std::uint8_t>(draw[2] * 256.0);
      gray[i] = level;
    }
    for (std::size_t row = 1; row < rows; ++row) {
      if (random.uniform4(gray.size() + row)[0] < repeat_row)
        std::copy_n(gray.begin() + static_cast<long>((row - 1) * columns), columns,
                    gray.begin() + static_cast<long>(row * columns));
    }
    expect_round_trip(gray, columns, rows);
  }
}

TEST(LayerPng, KeepsRunsOfEveryLength) {
  for (std::size_t length = 1; length < 600; ++length) {
    Pixels gray(length + 7, 0);
    std::fill_n(gray.begin() + 3, length, 200);
    expect_round_trip(gray, gray.size(), 1);
  }
}

TEST(LayerPng, PacksAnEmptyLayerIntoAFewKilobytes) {
  EXPECT_LT(encode_layer_png(to_runs(Pixels(2560 * 1600, 0), 2560, 1600)).size(), 4500U);
}

// 2^−length of all codes add up to 1: no bit is wasted, and a decoder can tell every code from every other.
TEST(HuffmanCode, IsCompleteWithinItsLimit) {
  std::vector<std::uint64_t> counts(30, 0);
  std::uint64_t a = 1, b = 1;
  for (std::size_t i = 0; i < counts.size(); ++i) {
    counts[i] = a;
    a = std::exchange(b, a + b);
  }
  for (const int limit : {7, 15}) {
    const HuffmanCode code = huffman_code(counts, limit);
    double sum = 0.0;
    for (const std::uint8_t length : code.lengths) {
      EXPECT_LE(length, limit);
      sum += 1.0 / (1U << length);
    }
    EXPECT_EQ(sum, 1.0);
  }
}

}  // namespace
}  // namespace mezzotint
