#include <rapidcheck.h>

#include <gtest/gtest.h>

#include <array>

#include "fabrication/projector/dlpc900_image.h"
#include "fabrication/projector/run_length.h"
#include "forward/base/error.h"
#include "tests/fabrication/projector/emulator/image_decoder.h"

namespace mezzotint::dlpc900 {
namespace {

using Bytes = std::vector<std::uint8_t>;

const Bytes guide_example = {0x03, 0x04, 0x05, 0x06, 0x05, 0x77, 0x77, 0x77, 0x00, 0x03, 0x04, 0x05,
                             0x06, 0x07, 0x08, 0x09, 0x0a, 0x0b, 0x0c, 0x82, 0x01, 0x78, 0x9a, 0xbc,
                             0x00, 0x00, 0x01, 0x01, 0x02, 0x03, 0x00, 0x01, 0x09, 0x00, 0x01, 0x00};

TEST(ImageCode, WritesTheGuidesExampleWordByWord) {
  Bytes bytes;
  RunLengthWords words(bytes, true);
  const Bytes first = {4, 5, 6}, second = {0x77, 0x77, 0x77}, raw = {4, 5, 6, 7, 8, 9, 10, 11, 12},
              long_run = {0x78, 0x9a, 0xbc}, single = {1, 2, 3};
  words.repeat(3, first.data());
  words.repeat(5, second.data());
  words.raw(3, raw.data());
  words.repeat(130, long_run.data());
  words.end_line();
  words.raw(1, single.data());  // one raw pixel becomes a run of one
  words.copy_from_above(9);
  words.end_image();
  EXPECT_EQ(bytes, guide_example);
}

TEST(ImageCode, EncodesTheGuidesExampleFromItsPixels) {
  // The example's lines in full: 141 pixels, and then one of its own and a copy of the rest.
  Bytes line;
  const auto add = [&](int count, Bytes pixel) {
    for (int i = 0; i < count; ++i) line.insert(line.end(), pixel.begin(), pixel.end());
  };
  add(3, {4, 5, 6});
  add(5, {0x77, 0x77, 0x77});
  for (std::uint8_t i = 0; i < 9; ++i) line.push_back(static_cast<std::uint8_t>(4 + i));
  add(130, {0x78, 0x9a, 0xbc});
  PackedImage image{141, 2, line};
  image.bytes.insert(image.bytes.end(), line.begin(), line.end());
  image.bytes[3 * 141] = 1, image.bytes[3 * 141 + 1] = 2, image.bytes[3 * 141 + 2] = 3;
  Bytes expected(guide_example.begin(), guide_example.begin() + 32);
  for (const int byte : {0x8c, 0x01, 0x00, 0x01, 0x00}) expected.push_back(static_cast<std::uint8_t>(byte));
  expected.resize((expected.size() + 3) / 4 * 4, 0);
  const Bytes encoded = encode_image(image, Compression::EnhancedRunLength);
  EXPECT_EQ(Bytes(encoded.begin() + 48, encoded.end()), expected);
}

TEST(ImageCode, TheDecoderReadsTheGuidesExample) {
  const Bytes pixels = emulator::decode_enhanced_example(guide_example, 141);
  ASSERT_EQ(pixels.size(), 3U * (141 + 10));
  EXPECT_EQ(Bytes(pixels.begin() + 3 * 141, pixels.begin() + 3 * 141 + 6), (Bytes{1, 2, 3, 4, 5, 6}));
}

TEST(ImageCode, WritesTheHeaderOfTheGuide) {
  const PackedImage image{5, 2, Bytes(30, 9)};
  const Bytes bytes = encode_image(image, Compression::None);
  const Bytes header = {0x53, 0x70, 0x6c, 0x64, 5,   0, 2, 0, 32, 0, 0, 0, 255, 255, 255,
                        255,  255,  255,  255,  255, 0, 0, 0, 0,  1, 0, 1, 0,   0,   1};
  EXPECT_EQ(Bytes(bytes.begin(), bytes.begin() + 30), header);
  EXPECT_EQ(Bytes(bytes.begin() + 30, bytes.begin() + 48), Bytes(18, 0));
  EXPECT_EQ(bytes.size(), 48U + 2 * 16) << "rows are filled up to 16 bytes";
}

TEST(ImageCode, LongRunsTakeTwoBytesOfLength) {
  const PackedImage image{1280, 1, Bytes(3 * 1280, 7)};
  const Bytes bytes = encode_image(image, Compression::EnhancedRunLength);
  EXPECT_EQ(Bytes(bytes.begin() + 48, bytes.end()), (Bytes{0x80, 0x0a, 7, 7, 7, 0, 1, 0}));  // 1280 = 0 + 10·128
}

TEST(ImageCode, PlanesLieInTheBytesOfTheirBitPositions) {
  const Bytes first = {1, 2, 3, 4}, second = {5, 6, 7, 8};
  const auto image = pack_planes(1, 2, {PlaneView{first, 2, 1}, PlaneView{second, 2, 0}, {}});
  EXPECT_EQ(image.bytes, (Bytes{0, 5, 2, 0, 7, 4}));
  const auto decoded = emulator::decode_image(encode_image_smallest(image));
  EXPECT_EQ(decoded.plane(0), (Bytes{2, 4}));
  EXPECT_EQ(decoded.plane(8), (Bytes{5, 7}));
  EXPECT_EQ(decoded.plane(16), (Bytes{0, 0}));
}

TEST(ImageCode, RefusesWhatIsNoImage) {
  EXPECT_THROW(static_cast<void>(encode_image({0, 4, {}}, Compression::None)), InvalidInput);
  EXPECT_THROW(static_cast<void>(encode_image({70000, 1, Bytes(210000)}, Compression::None)), InvalidInput);
  EXPECT_THROW(static_cast<void>(encode_image({4, 4, Bytes(47)}, Compression::None)), InvalidInput);
  EXPECT_THROW(static_cast<void>(pack_planes(3, 1, {PlaneView{Bytes(2), 2, 0}, {}, {}})), InvalidInput);
}

/// Images that lie in wait for run-length codes: few colours, copies of lines with flaws, widths at the limits.
rc::Gen<PackedImage> hard_image() {
  return rc::gen::exec([] {
    PackedImage image;
    const auto limits = rc::gen::element<std::size_t>(1, 2, 127, 128, 129, 254, 255, 256, 257, 300);
    image.columns = *rc::gen::oneOf(rc::gen::inRange<std::size_t>(1, 24), limits);
    image.rows = *rc::gen::inRange<std::size_t>(1, 5);
    const auto colours = *rc::gen::element<unsigned>(1, 2, 3, 255);
    const auto stay = *rc::gen::element<unsigned>(0, 128, 240, 255);   // of 256: goes on as the pixel before
    const auto above = *rc::gen::element<unsigned>(0, 128, 250, 256);  // of 256: as the pixel above
    std::uint32_t state = *rc::gen::arbitrary<std::uint32_t>() | 1U;
    const auto draw = [&] { return (state = state * 1664525U + 1013904223U) >> 16; };
    for (std::size_t i = 0; i < image.columns * image.rows; ++i) {
      std::array<std::uint8_t, 3> pixel{};
      const std::size_t column = i % image.columns;
      const auto from = [&](std::size_t place) { std::copy_n(image.bytes.begin() + 3 * place, 3, pixel.begin()); };
      if (i >= image.columns && draw() % 256 < above) {
        from(i - image.columns);
      } else if (column > 0 && draw() % 256 < stay) {
        from(i - 1);
      } else {
        for (auto& byte : pixel) byte = static_cast<std::uint8_t>(draw() % colours);
      }
      image.bytes.insert(image.bytes.end(), pixel.begin(), pixel.end());
    }
    return image;
  });
}

void expect_round_trip(const PackedImage& image) {
  std::size_t smallest = SIZE_MAX;
  for (const auto compression : {Compression::None, Compression::RunLength, Compression::EnhancedRunLength}) {
    const Bytes bytes = encode_image(image, compression);
    const auto decoded = emulator::decode_image(bytes);
    RC_ASSERT(decoded.width == image.columns);
    RC_ASSERT(decoded.height == image.rows);
    RC_ASSERT(decoded.rgb == image.bytes);
    smallest = std::min(smallest, bytes.size());
  }
  RC_ASSERT(encode_image_smallest(image).size() == smallest);
}

TEST(ImageCode, AnIndependentDecoderReadsBackTenThousandImages) {
  constexpr int images_a_case = 100;  // of 100 cases
  int images = 0;
  const bool holds = rc::check("decode(encode(image)) == image", [&] {
    for (int i = 0; i < images_a_case; ++i) {
      expect_round_trip(*hard_image());
      ++images;
    }
  });
  EXPECT_TRUE(holds);
  EXPECT_GE(images, 10000);
}

TEST(ImageCode, NoiseIsNotMadeLonger) {
  PackedImage image{1280, 20, {}};
  std::uint32_t state = 7;
  for (int i = 0; i < 3 * 1280 * 20; ++i) {
    image.bytes.push_back(static_cast<std::uint8_t>((state = state * 1664525U + 1013904223U) >> 24));
  }
  const Bytes bytes = encode_image_smallest(image);
  EXPECT_EQ(bytes.size(), 48U + 3 * 1280 * 20);
  EXPECT_EQ(bytes[25], 0) << "uncompressed";
  EXPECT_EQ(emulator::decode_image(bytes).rgb, image.bytes);
}

}  // namespace
}  // namespace mezzotint::dlpc900
