#include <cmath>
#include <fstream>
#include <string>

#include "forward/base/error.h"
#include "measurement/correction/plane.h"
#include "measurement/formats/parsers.h"
#include "measurement/texture/roughness.h"
#include "tests/measurement/formats/instrument_builders.h"
#include "tests/test_data.h"

namespace mezzotint {
namespace {

using test::as_bytes;
using test::build_sur;
using test::SurRecipe;

SurfaceFile parse(const SurRecipe& recipe) { return parse_sur("test.sur", as_bytes(build_sur(recipe))); }

std::string complaint(const std::string& bytes) {
  try {
    static_cast<void>(parse_sur("test.sur", as_bytes(bytes)));
  } catch (const FileError& error) {
    return error.what();
  }
  return "no complaint";
}

SurRecipe three_by_two() {
  SurRecipe recipe;
  recipe.columns = 3;
  recipe.rows = 2;
  recipe.counts = {2000, 4000, 6000, 8000, 10000, 12000};
  return recipe;
}

// 1 … 6 µm in nanometres of half a step, the top row first.
void expect_one_to_six(const HeightField& field) {
  ASSERT_EQ(field.grid().size(), 6U);
  for (std::size_t i = 0; i < 6; ++i) {
    // Floats of micrometres about their mean.
    EXPECT_NEAR(field.at(i % 3, 1 - i / 3) + field.datum().um(), static_cast<double>(i + 1), 1e-6) << i;
  }
}

TEST(Sur, ReadsBothWidthsPlainAndCompressed) {
  for (const std::int16_t bits : {std::int16_t{16}, std::int16_t{32}}) {
    for (const int streams : {0, 1, 2, 3}) {
      SCOPED_TRACE(testing::Message() << bits << " bits, streams " << streams);
      SurRecipe recipe = three_by_two();
      recipe.bits = bits;
      recipe.streams = streams;
      const SurfaceFile surface = parse(recipe);
      expect_one_to_six(surface.field);
      EXPECT_EQ(surface.assumption, "");
    }
  }
}

TEST(Sur, TakesStepsUnitsAndOffsetButNotTheRatiosOfTheDisplay) {
  SurRecipe recipe = three_by_two();
  recipe.unit_xy = "\xB5m";  // Latin-1
  recipe.step_x = 2.0F;
  recipe.step_y = 4.0F;
  recipe.unit_z = "\xC2\xB5m";  // UTF-8
  recipe.step_z = 0.0005F;
  recipe.offset_z = -0.5F;
  const SurfaceFile surface = parse(recipe);
  EXPECT_NEAR(surface.field.grid().pitch_x.um(), 2.0, 1e-12);
  EXPECT_NEAR(surface.field.grid().pitch_y.um(), 4.0, 1e-12);
  // The step stands as a float, which 0.0005 is to 6e-8.
  EXPECT_NEAR(surface.field.datum().um(), 3.5 - 0.5, 3.5 * 6e-8);
  EXPECT_EQ(surface.title, "coin");
  EXPECT_EQ(surface.provenance.at("operator"), "J\xC3\xB6rg");
  EXPECT_EQ(surface.provenance.at("date"), "2019-12-31 23:59:30");
}

TEST(Sur, TheMarkerIsTwoBelowTheLowestAndOnlyWhereItIsUsed) {
  for (const std::int32_t lowest : {1002, -30000}) {
    SurRecipe recipe = three_by_two();
    recipe.bits = 16;
    recipe.lowest = lowest;
    recipe.counts[1] = lowest - 2;
    EXPECT_EQ(parse(recipe).field.missing_count(), 0U);
    recipe.marked = true;
    const HeightField field = parse(recipe).field;
    EXPECT_EQ(field.missing_count(), 1U);
    EXPECT_TRUE(std::isnan(field.at(1, 1)));
  }
}

// Counts of 1 nm at 76 mm fit into 32 bits.
TEST(Sur, KeepsTheReliefFarFromTheStage) {
  SurRecipe recipe = three_by_two();
  recipe.step_z = 1.0F;
  recipe.counts = {76000001, 76000002, 76000003, 76000004, 76000005, 76000006};
  const HeightField field = parse(recipe).field;
  EXPECT_NEAR(field.datum().um(), 76000.0035, 1e-9);  // doubles
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_NEAR(field.at(i % 3, 1 - i / 3), 1e-3 * (static_cast<double>(i) - 2.5), 1e-9) << i;
  }
}

TEST(Sur, SurfacesWithPicturesAreReadAndOtherStudiablesRefused) {
  SurRecipe recipe = three_by_two();
  recipe.type = 16;
  recipe.objects = 5;
  EXPECT_EQ(parse(recipe).assumption, "the first of 5 objects is the relief");
  recipe.type = 1;
  recipe.objects = 1;
  EXPECT_NE(parse(recipe).assumption.find("says that it is a profile"), std::string::npos);
  for (const int type : {4, 5, 10, 12, 21}) {
    recipe.type = static_cast<std::int16_t>(type);
    EXPECT_NE(complaint(build_sur(recipe)).find("a studiable of type " + std::to_string(type)), std::string::npos);
  }
}

TEST(Sur, RefusesWhatContradictsItself) {
  SurRecipe recipe = three_by_two();
  recipe.byte_order = 257;
  EXPECT_NE(complaint(build_sur(recipe)).find("byte order is 257"), std::string::npos);
  recipe = three_by_two();
  recipe.unit_z = "bar";
  EXPECT_NE(complaint(build_sur(recipe)).find("unit of the z step is \"bar\""), std::string::npos);
  recipe = three_by_two();
  recipe.bits = 24;
  EXPECT_NE(complaint(build_sur(recipe)).find("24 bits"), std::string::npos);
  recipe = three_by_two();
  std::string bytes = build_sur(recipe);
  bytes[116] = 7;
  EXPECT_NE(complaint(bytes).find("7 points, but 3 × 2 are 6"), std::string::npos);
  recipe.streams = 2;
  bytes = build_sur(recipe);
  bytes[324] = static_cast<char>(bytes[324] + 1);
  EXPECT_NE(complaint(bytes).find("packed bytes"), std::string::npos);
}

TEST(Sur, RefusesStreamsThatHoldOtherThanTheyClaim) {
  SurRecipe recipe = three_by_two();
  recipe.streams = 1;
  const std::string whole = build_sur(recipe);
  const std::size_t directory = 512 + 3;
  std::string damaged = whole;
  damaged[directory + 4] = 23;  // of 24
  EXPECT_NE(complaint(damaged).find("the points need 24"), std::string::npos);
  damaged = whole;
  damaged.back() = static_cast<char>(damaged.back() ^ 1);  // the stream's own checksum
  EXPECT_NE(complaint(damaged).find("stream 1 of 1"), std::string::npos);
  recipe.columns = recipe.rows = 20000;
  EXPECT_NE(complaint(build_sur(recipe)), "no complaint");
}

double cell(const std::string& line, int column) {
  std::size_t begin = 0;
  for (; column > 0; --column) begin = line.find(',', begin) + 1;
  return std::stod(line.substr(begin));
}

// Gwyddion takes the points that were not measured for heights; these values leave them out.
void expect_reference(const HeightField& field, const std::string& line) {
  const AreaRoughness roughness = area_roughness(field);
  EXPECT_EQ(static_cast<double>(field.missing_count()), cell(line, 4));
  // Nine digits are given, seven of the two shape figures.
  EXPECT_NEAR(roughness.Sa.value * 1e-6 / cell(line, 6), 1.0, 1e-6);
  EXPECT_NEAR(roughness.Sq.value * 1e-6 / cell(line, 7), 1.0, 1e-6);
  EXPECT_NEAR(roughness.Ssk.value / cell(line, 8), 1.0, 1e-6);
  EXPECT_NEAR(roughness.Sku.value / (cell(line, 9) + 3.0), 1.0, 1e-6);
  EXPECT_NEAR(roughness.Sz.value * 1e-6 / (cell(line, 11) - cell(line, 10)), 1.0, 1e-6);
}

TEST(Sur, ARealFileAgreesWithItsReferenceWhereMissingPointsAreLeftOut) {
  const auto folder = test::external_data_folder() / "surface";
  MEZZOTINT_NEEDS_DATA(folder / "sur-2.sur");
  const SurfaceFile surface = read_surface(folder / "sur-2.sur");
  EXPECT_EQ(surface.field.columns(), 563U);
  EXPECT_EQ(surface.field.rows(), 484U);
  std::ifstream stream(folder / "reference_sur_nonmeasured_excluded.csv");
  std::string line;
  std::getline(stream, line);
  std::getline(stream, line);
  expect_reference(surface.field, line);
  EXPECT_NEAR(surface.field.datum().m() / cell(line, 5), 1.0, 1e-8);
  std::getline(stream, line);
  expect_reference(level(surface.field), line);
}

}  // namespace
}  // namespace mezzotint
