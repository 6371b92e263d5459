#include <cmath>
#include <limits>

#include "forward/base/error.h"
#include "measurement/formats/parsers.h"
#include "tests/measurement/formats/file_builders.h"
#include "tests/test_data.h"

namespace mezzotint {
namespace {

using test::Al3dRecipe;
using test::as_bytes;
using test::build_al3d;

SurfaceFile parse(const Al3dRecipe& recipe) { return parse_al3d("test.al3d", as_bytes(build_al3d(recipe))); }

std::string complaint(const Al3dRecipe& recipe) {
  try {
    parse(recipe);
  } catch (const FileError& error) {
    return error.what();
  }
  return "no complaint";
}

std::vector<float> distinct_heights(std::size_t count) {
  std::vector<float> heights_m;
  for (std::size_t i = 0; i < count; ++i) heights_m.push_back(1e-6F * static_cast<float>(i * i + 1));
  return heights_m;
}

// Every sample in its place, the first row of the file on top.
void expect_heights(const Al3dRecipe& recipe, const HeightField& field) {
  ASSERT_EQ(field.columns(), recipe.columns);
  ASSERT_EQ(field.rows(), recipe.rows);
  for (std::size_t row = 0; row < recipe.rows; ++row) {
    for (std::size_t column = 0; column < recipe.columns; ++column) {
      const double expected_um = recipe.heights_m[row * recipe.columns + column] * 1e6;
      // Float about a mean of some 100 µm at most.
      EXPECT_NEAR(field.at(column, recipe.rows - 1 - row) + field.datum().um(), expected_um, 2e-5);
    }
  }
}

TEST(Al3d, ReadsAnyWidthWithPackedAndWithPaddedRows) {
  for (const std::uint64_t columns : {1, 2, 3, 4, 5}) {
    for (const bool padded : {false, true}) {
      for (const bool texture : {false, true}) {
        SCOPED_TRACE(testing::Message() << columns << " columns, padded " << padded << ", texture " << texture);
        const Al3dRecipe recipe{columns, 4, distinct_heights(4 * columns), padded, texture, {}};
        const SurfaceFile surface = parse(recipe);
        expect_heights(recipe, surface.field);
        EXPECT_EQ(surface.assumption, "");
      }
    }
  }
}

TEST(Al3d, TakesThePitchOfEachAxisFromTheHeader) {
  const SurfaceFile surface = parse({2, 2, distinct_heights(4), false, true, {}});
  EXPECT_NEAR(surface.field.grid().pitch_x.um(), 0.438027, 1e-12);  // decimal text to double
  EXPECT_NEAR(surface.field.grid().pitch_y.um(), 0.876054, 1e-12);
  EXPECT_FALSE(surface.field.periodic());
  EXPECT_EQ(surface.format, "al3d");
}

TEST(Al3d, SaysThatItAssumedPaddingWhereTheOffsetsDoNotTell) {
  Al3dRecipe recipe{3, 4, distinct_heights(12), true, false, {}};
  std::string bytes = build_al3d(recipe) + std::string(100, 'x');  // a block that no offset announces
  const SurfaceFile surface = parse_al3d("test.al3d", as_bytes(bytes));
  expect_heights(recipe, surface.field);
  EXPECT_NE(surface.assumption.find("padding"), std::string::npos);
}

TEST(Al3d, RefusesADepthImageThatFitsNeitherStride) {
  Al3dRecipe recipe{3, 4, distinct_heights(12), true, false, {}};
  std::string bytes = build_al3d(recipe);
  bytes.resize(bytes.size() - 2);
  EXPECT_THROW(static_cast<void>(parse_al3d("test.al3d", as_bytes(bytes))), FileError);
}

TEST(Al3d, TheTextureMayLieAheadOfTheDepthImage) {
  Al3dRecipe recipe{3, 4, distinct_heights(12), false, false, {{"TextureImageOffset", "17"}}};
  expect_heights(recipe, parse(recipe).field);
}

void expect_only_first_missing(float marked_m, const std::string& marker) {
  SCOPED_TRACE(marker);
  auto heights_m = distinct_heights(6);
  heights_m[0] = marked_m;
  const SurfaceFile surface = parse({3, 2, heights_m, false, true, {{"InvalidPixelValue", marker}}});
  EXPECT_EQ(surface.field.missing_count(), 1U);
  EXPECT_TRUE(std::isnan(surface.field.at(0, 1)));
  const double mean_um = (2.0 + 5.0 + 10.0 + 17.0 + 26.0) / 5.0;  // of the other five
  EXPECT_NEAR(surface.field.datum().um(), mean_um, 1e-6);         // heights stand as floats in the file
}

TEST(Al3d, FindsTheMarkedSamplesUnderEveryKindOfMarker) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  expect_only_first_missing(3.000000028082e+15F, "3.000000028082e+15");
  expect_only_first_missing(3.0000002e+15F, "3.000000e+15");  // the text has fewer digits than the float
  expect_only_first_missing(nan, "NaN");
  expect_only_first_missing(nan, "1.#QNAN");
  expect_only_first_missing(nan, "3.000000028082e+15");
  expect_only_first_missing(std::numeric_limits<float>::infinity(), "3.000000028082e+15");
  expect_only_first_missing(-1.0F, "-1");
  expect_only_first_missing(-3e15F, "-3e15");
  expect_only_first_missing(-3e15F, "3e15");
  expect_only_first_missing(0.0F, "0");
  expect_only_first_missing(-0.0765F, "-0.0765");
}

// The one scan of MeasureSuite that we know lies 76 mm above the stage.
TEST(Al3d, KeepsTheReliefOfAScanFarFromTheStage) {
  std::vector<float> heights_m;
  double mean_m = 0.0;
  for (int i = 0; i < 400; ++i) {
    heights_m.push_back(static_cast<float>(0.07634 + 2e-6 * std::sin(0.37 * i)));
    mean_m += static_cast<double>(heights_m.back()) / 400.0;
  }
  const SurfaceFile surface = parse({20, 20, heights_m, false, true, {}});
  EXPECT_NEAR(surface.field.datum().m(), mean_m, 1e-14);  // doubles near 0.08
  for (std::size_t i = 0; i < 400; ++i) {
    const double relief_um = (static_cast<double>(heights_m[i]) - mean_m) * 1e6;
    // A float of at most 2 µm is right to 1.2e-7 µm; 76 mm as a float of micrometres would be off by 4e-3 µm.
    EXPECT_NEAR(surface.field.at(i % 20, 19 - i / 20), relief_um, 2e-7);
  }
}

TEST(Al3d, RefusesAPromiseOfMoreSamplesThanBytes) {
  const Al3dRecipe whole{4, 4, distinct_heights(16), false, true, {}};
  for (const auto& [columns, rows] : {std::pair{"1000000000", "1000000000"},
                                      {"30000", "30000"},
                                      {"5", "4"},
                                      {"18446744073709551615", "2"},
                                      {"99999999999999999999", "1"},
                                      {"-4", "4"},
                                      {"0", "4"}}) {
    Al3dRecipe recipe = whole;
    recipe.tags = {{"Cols", columns}, {"Rows", rows}};
    EXPECT_NE(complaint(recipe), "no complaint") << columns << " × " << rows;
  }
}

TEST(Al3d, NamesThePlaceAndWhatWouldBeRight) {
  Al3dRecipe recipe{4, 4, distinct_heights(16), false, true, {{"PixelSizeXMeter", "wide"}}};
  EXPECT_EQ(complaint(recipe), "test.al3d: header: PixelSizeXMeter is \"wide\"; a number belongs there");
  recipe.tags = {{"TextureImageOffset", "999999"}};
  EXPECT_NE(complaint(recipe).find("cut short"), std::string::npos);
  recipe.tags = {{"DepthImageOffset", "0"}};
  EXPECT_NE(complaint(recipe).find("without a depth image"), std::string::npos);
  recipe.tags = {{"MezzotintDatum", "nan"}};
  EXPECT_EQ(complaint(recipe), "test.al3d: header: MezzotintDatum is nan m");
  recipe.tags = {{"PixelSizeYMeter", "0"}};
  EXPECT_NE(complaint(recipe).find("pitch"), std::string::npos);
}

TEST(Al3d, RefusesTheHeaderOfARealScanWithoutItsData) {
  const auto path = test::external_data_folder() / "surface" / "al3d-1.header_only_truncated.al3d";
  MEZZOTINT_NEEDS_DATA(path);
  try {
    static_cast<void>(read_surface(path));
    FAIL() << "read heights that are not there";
  } catch (const FileError& error) {
    EXPECT_NE(std::string(error.what()).find("TextureImageOffset is 238061"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace mezzotint
