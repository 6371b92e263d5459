#include "fabrication/slicing/slice.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "fabrication/job/job_file.h"
#include "fabrication/job/layer_png.h"
#include "fabrication/part/mesh_facts.h"
#include "fabrication/part/part_file.h"
#include "forward/base/error.h"
#include "tests/fabrication/slicing/shapes.h"
#include "tests/test_data.h"

namespace mezzotint {
namespace {

// A small field of coarse pixels: parts of some millimetres fit.
PrinterProfile small_printer() {
  PrinterProfile profile;
  profile.pixels_x = 300;
  profile.pixels_y = 200;
  profile.pixel_pitch = Length::from_um(20.0);
  profile.layer = Length::from_um(50.0);
  profile.cure.alpha = Length::from_um(55.0);
  profile.cure.beta = Length::from_um(30.0);
  return profile;
}

struct Slices {
  SliceSummary summary;
  std::vector<std::vector<std::uint8_t>> layers;
};

Slices slices_of(const PartMesh& part, const PrinterProfile& profile, const SliceOptions& options) {
  Slices slices;
  slices.summary = slice_part(part, profile, options, {},
                              [&](SlicedLayer&& layer) { slices.layers.push_back(to_pixels(layer.picture)); });
  return slices;
}

TEST(SlicePart, FillsTheFieldsMiddle) {
  const auto [summary, layers] = slices_of(test::box({7.0, 7.0, -3.0}, {8.0, 7.5, -2.8}), small_printer(), {});
  ASSERT_EQ(layers.size(), 4U);
  EXPECT_NEAR(summary.volume_mm3, 0.1, 1e-6);
  for (std::size_t row = 0; row < 200; ++row) {
    for (std::size_t column = 0; column < 300; ++column) {
      const bool inside = row >= 88 && row < 112 && column >= 125 && column < 175;
      const bool rim = row == 87 || row == 112;  // 25 rows about the middle: half a row on either side
      const bool dark = !inside && !(rim && column >= 125 && column < 175);
      if (inside) {
        ASSERT_GE(layers[1][row * 300 + column], 200) << column << ", " << row;
      }
      if (dark) {
        ASSERT_EQ(layers[1][row * 300 + column], 0) << column << ", " << row;
      }
    }
  }
}

TEST(SlicePart, MovesAndTurnsAsAsked) {
  // Longer along x, then turned to y and moved by (40, −10) pixels.
  SliceOptions options;
  options.placement = {Angle::from_degrees(90.0), Length::from_um(800.0), Length::from_um(-200.0)};
  const Slices slices = slices_of(test::box({0.0, 0.0, 0.0}, {1.6, 0.4, 0.1}), small_printer(), options);
  std::size_t lowest_row = 1000, highest_row = 0, first_column = 1000, last_column = 0;
  for (std::size_t i = 0; i < slices.layers[0].size(); ++i) {
    if (slices.layers[0][i] == 0) continue;
    lowest_row = std::min(lowest_row, i / 300);
    highest_row = std::max(highest_row, i / 300);
    first_column = std::min(first_column, i % 300);
    last_column = std::max(last_column, i % 300);
  }
  EXPECT_EQ(first_column, 180U);
  EXPECT_EQ(last_column, 199U);
  EXPECT_EQ(lowest_row, 50U);
  EXPECT_EQ(highest_row, 129U);
}

TEST(SlicePart, RefusesAPartThatIsTooLargeAndSaysTheSizes) {
  try {
    (void)slices_of(test::box({0.0, 0.0, 0.0}, {6.5, 1.0, 1.0}), small_printer(), {});
    FAIL();
  } catch (const InvalidInput& error) {
    const std::string text = error.what();
    EXPECT_NE(text.find("6.5 x 1 mm"), std::string::npos) << text;
    EXPECT_NE(text.find("6 x 4 mm"), std::string::npos) << text;
  }
  SliceOptions turned;
  turned.placement.rotation = Angle::from_degrees(45.0);
  EXPECT_NO_THROW((void)slices_of(test::box({0.0, 0.0, 0.0}, {6.0, 4.0, 0.1}), small_printer(), {}));
  EXPECT_THROW((void)slices_of(test::box({0.0, 0.0, 0.0}, {4.5, 1.5, 0.1}), small_printer(), turned), InvalidInput);
  EXPECT_THROW((void)slices_of({}, small_printer(), {}), InvalidInput);
  PartMesh broken = test::box({0.0, 0.0, 0.0}, {1.0, 1.0, 1.0});
  broken.vertices_mm[3][1] = std::nan("");
  EXPECT_THROW((void)slices_of(broken, small_printer(), {}), InvalidInput);
}

TEST(SlicePart, CountsLayersOfUnevenHeights) {
  const auto layers = [](double height_mm, CoverageMode mode) {
    return slices_of(test::box({0.0, 0.0, 0.0}, {1.0, 1.0, height_mm}), small_printer(), {.coverage = {mode, 0}})
        .layers.size();
  };
  EXPECT_EQ(layers(1.0, CoverageMode::Volume), 20U);
  EXPECT_EQ(layers(1.0 + 1e-7, CoverageMode::Volume), 20U);  // what rounding to float may add
  EXPECT_EQ(layers(1.01, CoverageMode::Volume), 21U);
  EXPECT_EQ(layers(1.01, CoverageMode::Midplane), 20U);
  EXPECT_EQ(layers(1.03, CoverageMode::Midplane), 21U);
}

TEST(SlicePart, GivesTheSameBytesWithAnyNumberOfThreads) {
  const PartMesh ball = test::sphere({0.0, 0.0, 0.0}, 1.7, 60, 90);
  std::vector<std::string> first;
  for (const std::size_t threads : {1U, 2U, 7U}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    std::vector<std::string> packed;
    (void)slice_part(ball, small_printer(), {}, encode_layer_png,
                     [&](SlicedLayer&& layer) { packed.push_back(layer.packed); });
    if (first.empty()) first = packed;
    EXPECT_EQ(packed.size(), 68U);
    EXPECT_EQ(packed, first) << threads;
  }
}

TEST(SlicePart, StopsWhereProgressThrows) {
  std::size_t taken = 0;
  const Progress stop = [&](const ProgressEvent&) {
    if (taken > 10) throw Interrupted();
  };
  EXPECT_THROW(
      (void)slice_part(
          test::box({0.0, 0.0, 0.0}, {1.0, 1.0, 50.0}), small_printer(), {}, {}, [&](SlicedLayer&&) { ++taken; }, stop),
      Interrupted);
  EXPECT_LT(taken, 100U);
}

TEST(SlicePart, SaysWhatSaturates) {
  PrinterProfile weak = small_printer();
  weak.cure.alpha = Length::from_um(48.0);  // full gray: 48.3 of 50 µm
  const PartMesh block = test::box({0.0, 0.0, 0.0}, {1.0, 1.0, 0.125});
  const SliceSummary summary = slices_of(block, weak, {}).summary;
  EXPECT_EQ(summary.total.saturated, 2U * 2500U);  // the third layer is half as high
  EXPECT_NEAR(summary.largest_coverage, (48.0 + 30.0 * std::log(1.01)) / 50.0, 1e-12);
  EXPECT_EQ(slices_of(block, small_printer(), {}).summary.total.saturated, 0U);
  EXPECT_EQ(slices_of(block, weak, {.linear = true}).summary.total.saturated, 0U);
}

// A pit or a peak as wide as a pixel, on the pixel grid and off it, on a plate: each is seen in the layer that it
// lies in.
TEST(SlicePart, KeepsReliefOfOnePixel) {
  const PrinterProfile printer = small_printer();
  constexpr std::size_t cells = 60;
  std::vector<std::vector<double>> heights(cells + 1, std::vector<double>(cells + 1, 0.5));
  const double step = 0.02;  // one pixel
  std::vector<std::pair<std::size_t, std::size_t>> marks;
  for (std::size_t r = 4; r < cells - 4; r += 4) {
    for (std::size_t c = 4; c < cells - 4; c += 4) {
      marks.emplace_back(r, c);
      heights[r][c] += (r + c) / 4 % 2 == 0 ? 0.04 : -0.04;
    }
  }
  for (const double shift_um : {0.0, 7.3}) {
    SliceOptions options;
    options.placement.offset_x = options.placement.offset_y = Length::from_um(shift_um);
    const Slices slices = slices_of(test::plate(heights, step), printer, options);
    ASSERT_EQ(slices.layers.size(), 11U);
    for (const auto& [r, c] : marks) {
      const bool peak = (r + c) / 4 % 2 == 0;
      const auto& layer = slices.layers[peak ? 10 : 9];
      int lightest = 0, darkest = 255;
      for (std::size_t y = 0; y < 2; ++y) {
        for (std::size_t x = 0; x < 2; ++x) {
          const int gray = layer[(200 / 2 - cells / 2 + r - 1 + y) * 300 + 300 / 2 - cells / 2 + c - 1 + x];
          lightest = std::max(lightest, gray);
          darkest = std::min(darkest, gray);
        }
      }
      // A cone of 40 of 50 µm over a pixel: at least a tenth of a pixel's layer in one of the four about it.
      if (peak) {
        EXPECT_GT(lightest, 0) << r << ", " << c;
      }
      if (!peak) {
        EXPECT_LT(darkest, slices.layers[9][100 * 300 + 120]) << r << ", " << c;
      }
    }
  }
}

// What the 8 bits may be off: half a level a pixel that is neither dark nor full.
TEST(SlicePart, SumsToTheVolumeOfWatertightParts) {
  const auto folder = test::external_data_folder() / "mesh";
  MEZZOTINT_NEEDS_DATA(folder);
  std::size_t checked = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (!is_part_path(entry.path()) || entry.path().filename() == "c3_spot.obj") continue;
    PartMesh part;
    try {
      part = read_part(entry.path()).mesh;
    } catch (const FileError&) {
      continue;  // the broken ones
    }
    const MeshFacts facts = mesh_facts(part);
    if (!facts.watertight() || facts.volume_mm3 <= 0.0 || facts.bodies != 1) continue;
    // As large as the field allows, in 40 layers.
    const double size = std::max({facts.high_mm[0] - facts.low_mm[0], facts.high_mm[1] - facts.low_mm[1], 1e-9});
    const double height = facts.high_mm[2] - facts.low_mm[2];
    if (height <= 0.0) continue;
    PrinterProfile printer = small_printer();
    printer.pixels_y = 300;
    printer.pixel_pitch = Length::from_mm(size / 297.3);
    printer.layer = Length::from_mm(height / 39.7);
    SliceOptions options;
    options.linear = true;
    double gray = 0.0;
    std::uint64_t partly = 0;
    const SliceSummary summary = slice_part(part, printer, options, {}, [&](SlicedLayer&& layer) {
      const PictureFigures figures = figures_of(layer.picture);
      gray += static_cast<double>(figures.gray_sum) / 255.0;
      partly += figures.lit - figures.full;
    });
    const double pixel_mm3 = printer.pixel_pitch.mm() * printer.pixel_pitch.mm() * printer.layer.mm();
    EXPECT_NEAR(summary.volume_mm3, facts.volume_mm3, 1e-5 * facts.volume_mm3) << entry.path();
    EXPECT_NEAR(gray * pixel_mm3, facts.volume_mm3, (static_cast<double>(partly) + 1000.0) / 510.0 * pixel_mm3)
        << entry.path();
    EXPECT_EQ(summary.total.open_rows, 0U) << entry.path();
    ++checked;
  }
  EXPECT_GT(checked, 10U);
}

}  // namespace
}  // namespace mezzotint
