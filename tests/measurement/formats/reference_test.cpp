#include <cmath>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "measurement/correction/plane.h"
#include "measurement/formats/surface_file.h"
#include "measurement/texture/roughness.h"
#include "tests/test_data.h"

// Public measurements against the values that libgwyprocess 2.62 gives for them.

namespace mezzotint {
namespace {

using Row = std::map<std::string, std::string>;

std::vector<std::string> split(const std::string& line) {
  std::vector<std::string> cells;
  std::istringstream stream(line);
  for (std::string cell; std::getline(stream, cell, ',');) cells.push_back(cell);
  return cells;
}

std::vector<Row> read_table(const std::filesystem::path& path) {
  std::ifstream stream(path);
  std::string line;
  std::getline(stream, line);
  const auto names = split(line);
  std::vector<Row> rows;
  while (std::getline(stream, line)) {
    const auto cells = split(line);
    Row row;
    for (std::size_t i = 0; i < cells.size(); ++i) row[names[i]] = cells[i];
    rows.push_back(row);
  }
  return rows;
}

double number(const Row& row, const char* column) { return std::stod(row.at(column)); }

// Records the deviation, for `--gtest_output=xml`, and compares.
void expect_relative(const Row& row, const char* name, double actual, double expected, double tolerance) {
  const double deviation = actual / expected - 1.0;
  testing::Test::RecordProperty(row.at("file") + "." + row.at("levelling") + "." + name,
                                std::to_string(deviation * 1e9) + "e-9");
  EXPECT_LT(std::abs(deviation), tolerance) << name << ": " << actual << " instead of " << expected;
}

void expect_absolute(const Row& row, const char* name, double actual, double expected, double tolerance) {
  testing::Test::RecordProperty(row.at("file") + "." + row.at("levelling") + "." + name,
                                std::to_string((actual - expected) * 1e9) + "e-9 abs");
  EXPECT_NEAR(actual, expected, tolerance) << name;
}

// Nine digits are printed, and heights are floats about their mean (6e-8 of the largest).
constexpr double relative_tolerance = 1e-6;
// Six decimals are printed; the float heights add less.
constexpr double shape_tolerance = 1e-6;

void expect_roughness(const Row& row, const HeightField& field) {
  const AreaRoughness roughness = area_roughness(field);
  expect_relative(row, "Sa", roughness.Sa.value * 1e-6, number(row, "Sa"), relative_tolerance);
  expect_relative(row, "Sq", roughness.Sq.value * 1e-6, number(row, "Sq"), relative_tolerance);
  expect_relative(row, "Sz", roughness.Sz.value * 1e-6, number(row, "zmax") - number(row, "zmin"), relative_tolerance);
  expect_absolute(row, "Ssk", roughness.Ssk.value, number(row, "Ssk"), shape_tolerance);
  expect_absolute(row, "Sku", roughness.Sku.value, number(row, "Sku_minus_3") + 3.0, shape_tolerance);
}

void expect_grid(const Row& row, const HeightField& field) {
  EXPECT_EQ(std::to_string(field.columns()), row.at("nx"));
  EXPECT_EQ(std::to_string(field.rows()), row.at("ny"));
  EXPECT_EQ(std::to_string(field.missing_count()), row.at("masked_pixels"));
  const double width_m = field.grid().pitch_x.m() * static_cast<double>(field.columns());
  const double height_m = field.grid().pitch_y.m() * static_cast<double>(field.rows());
  // Nine digits are printed.
  EXPECT_NEAR(width_m / number(row, "xreal_m"), 1.0, 1e-8);
  EXPECT_NEAR(height_m / number(row, "yreal_m"), 1.0, 1e-8);
}

// Gwyddion's r0 is the first row of the file. Where the sample is missing it lists a filled-in value.
void expect_heights(const Row& row, const SurfaceFile& surface) {
  const HeightField& field = surface.field;
  const bool first_row_is_top = surface.format == "gwy" || surface.format == "opd";
  const auto at = [&](std::size_t column, std::size_t file_row) {
    return field.at(column, first_row_is_top ? field.rows() - 1 - file_row : file_row);
  };
  const double tolerance_m = 1e-7 * (number(row, "zmax") - number(row, "zmin"));  // float about the mean
  const auto expect_height = [&](const char* name, float z) {
    if (!std::isnan(z)) {
      EXPECT_NEAR(z * 1e-6 + field.datum().m(), number(row, name), tolerance_m) << name;
    }
  };
  expect_height("z_r0c0", at(0, 0));
  expect_height("z_r0c1", at(1, 0));
  expect_height("z_r1c0", at(0, 1));
  expect_height("z_last", at(field.columns() - 1, field.rows() - 1));
  EXPECT_NEAR(field.datum().m(), number(row, "mean"), tolerance_m);
}

TEST(GwyddionReference, EveryFileIsReadAlikeRawAndLevelled) {
  const auto folder = test::external_data_folder() / "surface";
  MEZZOTINT_NEEDS_DATA(folder / "reference_gwyddion_2.62.csv");
  std::size_t compared = 0;
  for (const Row& row : read_table(folder / "reference_gwyddion_2.62.csv")) {
    const std::filesystem::path path = folder / row.at("file");
    // Gwyddion takes the points of this file that were not measured for heights.
    if (path.filename() == "sur-2.sur") continue;
    SCOPED_TRACE(row.at("file") + ", " + row.at("levelling"));
    const SurfaceFile surface = read_surface(path);
    EXPECT_EQ("." + surface.format, path.extension());
    const bool raw = row.at("levelling") == "raw";
    expect_grid(row, surface.field);
    if (raw) expect_heights(row, surface);
    expect_roughness(row, raw ? surface.field : level(surface.field));
    ++compared;
  }
  EXPECT_EQ(compared, 14U);
}

TEST(GwyddionReference, AFileWithoutUnitsIsTakenForMetresAndSaysSo) {
  const auto path = test::external_data_folder() / "surface" / "tuxu_test.gwy";
  MEZZOTINT_NEEDS_DATA(path);
  const SurfaceFile surface = read_surface(path);
  EXPECT_DOUBLE_EQ(surface.field.grid().pitch_x.m(), 1.0);
  EXPECT_EQ(surface.assumption, "no lateral unit: metres assumed; no height unit: metres assumed");
  EXPECT_EQ(surface.title, "Test");
}

TEST(GwyddionReference, TheInstrumentIsPartOfTheProvenance) {
  const auto path = test::external_data_folder() / "surface" / "KautschukInfiniteFocus.x3p";
  MEZZOTINT_NEEDS_DATA(path);
  const SurfaceFile surface = read_surface(path);
  EXPECT_EQ(surface.provenance.at("manufacturer"), "Alicona Imaging GmbH");
  EXPECT_EQ(surface.provenance.count("checksum of main.xml"), 0U);  // it matches
  EXPECT_EQ(surface.assumption, "");
}

}  // namespace
}  // namespace mezzotint
