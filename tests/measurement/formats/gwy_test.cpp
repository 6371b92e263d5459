#include <cmath>
#include <fstream>
#include <iterator>
#include <limits>
#include <numbers>

#include "forward/base/error.h"
#include "forward/base/file_output.h"
#include "measurement/formats/parsers.h"
#include "tests/measurement/formats/file_builders.h"
#include "tests/test_data.h"

namespace mezzotint {
namespace {

using test::as_bytes;
using test::gwy_field;
using test::GwyBuilder;

SurfaceFile parse(const GwyBuilder& container) { return parse_gwy("test.gwy", as_bytes(container.file())); }

std::string complaint(const GwyBuilder& container) {
  try {
    parse(container);
  } catch (const FileError& error) {
    return error.what();
  }
  return "no complaint";
}

GwyBuilder with_field(const GwyBuilder& field) { return GwyBuilder().object("/0/data", "GwyDataField", field); }

// Three columns, two rows; the first row is the top.
const std::vector<double> six_heights_m = {1e-6, 2e-6, 3e-6, 7e-6, 8e-6, 9e-6};

std::string bytes_of(const std::filesystem::path& path) {
  std::ifstream stream(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

TEST(Gwy, TheFirstRowOfTheFileIsTheTopOfTheField) {
  const SurfaceFile surface = parse(with_field(gwy_field(3, 2, 6e-6, 8e-6, six_heights_m)));
  const HeightField& field = surface.field;
  EXPECT_NEAR(field.datum().um(), 5.0, 1e-12);
  // Small integers: floats hold them, the mean is right to double rounding.
  EXPECT_NEAR(field.at(0, 1), 1.0 - 5.0, 1e-6);
  EXPECT_NEAR(field.at(2, 1), 3.0 - 5.0, 1e-6);
  EXPECT_NEAR(field.at(0, 0), 7.0 - 5.0, 1e-6);
  EXPECT_NEAR(field.grid().pitch_x.um(), 2.0, 1e-12);
  EXPECT_NEAR(field.grid().pitch_y.um(), 4.0, 1e-12);
}

// Crests of wave vector at +30° as a picture: y grows upward, so that the first row has the largest y.
TEST(Gwy, ARidgeAtThirtyDegreesStaysThere) {
  const double kx = 0.2 * std::cos(std::numbers::pi / 6), ky = 0.2 * std::sin(std::numbers::pi / 6);
  std::vector<double> picture_m;
  for (int line = 0; line < 16; ++line) {
    for (int column = 0; column < 24; ++column) picture_m.push_back(1e-6 * std::sin(kx * column + ky * (15 - line)));
  }
  const HeightField field = parse(with_field(gwy_field(24, 16, 24e-6, 16e-6, picture_m))).field;
  for (std::size_t row = 0; row < 16; ++row) {
    for (std::size_t column = 0; column < 24; ++column) {
      const double expected = std::sin(kx * static_cast<double>(column) + ky * static_cast<double>(row));
      EXPECT_NEAR(field.at(column, row) + field.datum().um(), expected, 3e-7);  // float about the mean
    }
  }
}

TEST(Gwy, KnowsTheUnitsOfLength) {
  const std::pair<const char*, double> units[] = {{"m", 1e6},       {"mm", 1e3},  {"um", 1.0}, {"\u00b5m", 1.0},
                                                  {"\u03bcm", 1.0}, {"nm", 1e-3}, {"pm", 1e-6}};
  for (const auto& [unit, um] : units) {
    const HeightField field = parse(with_field(gwy_field(2, 1, 40.0, 20.0, {1.0, 3.0}, unit, unit))).field;
    // A few roundings of doubles, and one of a float.
    EXPECT_NEAR(field.grid().pitch_x.um() / (20.0 * um), 1.0, 1e-14) << unit;
    EXPECT_NEAR(field.datum().um() / (2.0 * um), 1.0, 1e-14) << unit;
    EXPECT_NEAR(field.at(1, 0) / um, 1.0, 1e-7) << unit;
  }
}

TEST(Gwy, AssumesMetresWhereNoUnitIsGivenAndSaysSo) {
  const SurfaceFile surface = parse(with_field(gwy_field(3, 2, 6e-6, 8e-6, six_heights_m, "", "m")));
  EXPECT_EQ(surface.assumption, "no lateral unit: metres assumed");
  EXPECT_NEAR(surface.field.grid().pitch_x.um(), 2.0, 1e-12);
}

TEST(Gwy, RefusesHeightsThatAreNoLengths) {
  const std::string message = complaint(with_field(gwy_field(3, 2, 1.0, 1.0, six_heights_m, "m", "V")));
  EXPECT_NE(message.find("the height unit is \"V\"; m, mm, µm, nm or pm is needed"), std::string::npos) << message;
}

TEST(Gwy, MaskedSamplesAreMissing) {
  auto container = with_field(gwy_field(3, 2, 6e-6, 8e-6, six_heights_m));
  container.object("/0/mask", "GwyDataField", gwy_field(3, 2, 1.0, 1.0, {0.5, 0.49, 0.0, 0.0, 0.0, 1.0}));
  const HeightField field = parse(container).field;
  EXPECT_TRUE(std::isnan(field.at(0, 1)));
  EXPECT_TRUE(std::isnan(field.at(2, 0)));
  EXPECT_EQ(field.missing_count(), 2U);
  EXPECT_NEAR(field.datum().um(), (2.0 + 3.0 + 7.0 + 8.0) / 4.0, 1e-12);
}

TEST(Gwy, RefusesAMaskOfAnotherSize) {
  auto container = with_field(gwy_field(3, 2, 6e-6, 8e-6, six_heights_m));
  container.object("/0/mask", "GwyDataField", gwy_field(2, 2, 1.0, 1.0, {0.0, 0.0, 0.0, 0.0}));
  EXPECT_NE(complaint(container).find("the 3 × 2 of the heights are needed"), std::string::npos);
}

TEST(Gwy, TakesTheLowestChannelAndWalksOverWhatItDoesNotKnow) {
  GwyBuilder container;
  container.texts("/names", {"one", "two"}).reals("/numbers", {1.0, 2.0});
  container.objects("/selections", "GwySelectionPoint", {GwyBuilder().real("x", 1.0), GwyBuilder()});
  container.object("/12/data", "GwyDataField", gwy_field(1, 1, 1.0, 1.0, {5.0}));
  container.object("/03/data", "GwyDataField", gwy_field(1, 1, 1.0, 1.0, {5.0}));  // Gwyddion writes no such name
  container.text("/3/data/title", "the third").text("/12/data/title", "the twelfth");
  container.object("/3/data", "GwyDataField", gwy_field(3, 2, 6e-6, 8e-6, six_heights_m));
  container.object("/3/meta", "GwyContainer", GwyBuilder().text("Objective", "50x"));
  const SurfaceFile surface = parse(container);
  EXPECT_EQ(surface.title, "the third");
  EXPECT_EQ(surface.field.columns(), 3U);
  EXPECT_EQ(surface.provenance.at("Objective"), "50x");
}

TEST(Gwy, RefusesFieldsThatContradictThemselves) {
  EXPECT_NE(complaint(with_field(gwy_field(3, 3, 1.0, 1.0, six_heights_m))).find("holds 6 values"), std::string::npos);
  EXPECT_NE(complaint(with_field(gwy_field(-3, -2, 1.0, 1.0, six_heights_m))).find("positive"), std::string::npos);
  EXPECT_NE(complaint(with_field(gwy_field(1000000000, 1000000000, 1.0, 1.0, six_heights_m))).find("must agree"),
            std::string::npos);
  EXPECT_NE(complaint(with_field(gwy_field(3, 2, 0.0, 1.0, six_heights_m))).find("pitch"), std::string::npos);
  EXPECT_NE(complaint(with_field(gwy_field(3, 2, 1.0, 1.0, {1e300, 0, 0, 0, 0, 0}))).find("height"), std::string::npos);
  EXPECT_NE(complaint(GwyBuilder().text("/0/data", "nothing")).find("no height image"), std::string::npos);
}

HeightField awkward_field(Continuation continuation) {
  const Grid grid{5, 3, Length::from_um(0.7), Length::from_um(1.3)};
  std::vector<float> heights_um;
  for (int i = 0; i < 15; ++i) heights_um.push_back(static_cast<float>(std::sin(1.7 * i)));
  return HeightField(grid, continuation, heights_um, Length::from_um(76340.25));
}

void expect_same_surface(const HeightField& actual, const HeightField& expected) {
  EXPECT_EQ(actual.columns(), expected.columns());
  EXPECT_EQ(actual.rows(), expected.rows());
  EXPECT_NEAR(actual.grid().pitch_x.um(), expected.grid().pitch_x.um(), 1e-12);
  EXPECT_NEAR(actual.grid().pitch_y.um(), expected.grid().pitch_y.um(), 1e-12);
  EXPECT_EQ(actual.continuation(), expected.continuation());
  for (std::size_t i = 0; i < expected.grid().size(); ++i) {
    const float z = actual.heights_um()[i], wanted = expected.heights_um()[i];
    EXPECT_EQ(std::isnan(z), std::isnan(wanted));
    if (std::isnan(wanted)) continue;
    // Two float roundings of heights of 1 µm, one of a double of 76 mm.
    EXPECT_NEAR(z + actual.datum().um(), wanted + expected.datum().um(), 2e-7);
  }
}

TEST(Gwy, WhatIsWrittenComesBack) {
  const test::TemporaryFolder folder;
  HeightField field = awkward_field(Continuation::Mirrored);
  field.at(1, 2) = std::numeric_limits<float>::quiet_NaN();
  write_gwy(field, "a title", {{"creator", "Mezzotint"}, {"note", "two\nlines \xFF"}}, folder / "field.gwy");
  const SurfaceFile back = read_surface(folder / "field.gwy");
  expect_same_surface(back.field, field);
  EXPECT_EQ(back.title, "a title");
  EXPECT_EQ(back.provenance.at("creator"), "Mezzotint");
  EXPECT_EQ(back.provenance.at("note"), "two lines ?");
  EXPECT_EQ(back.assumption, "");
}

TEST(Gwy, APeriodicFieldComesBackPeriodic) {
  const test::TemporaryFolder folder;
  const HeightField field = awkward_field(Continuation::Periodic);
  write_gwy(field, "", {}, folder / "field.gwy");
  const SurfaceFile back = read_surface(folder / "field.gwy");
  expect_same_surface(back.field, field);
  EXPECT_TRUE(back.provenance.empty());
}

TEST(Gwy, ACropThatStillClaimsToBePeriodicIsNotBelieved) {
  auto container = with_field(gwy_field(3, 2, 6e-6, 8e-6, six_heights_m));
  container.object("/0/meta", "GwyContainer",
                   GwyBuilder().text("Mezzotint continuation", "periodic, 256 x 256 samples"));
  const SurfaceFile surface = parse(container);
  EXPECT_FALSE(surface.field.periodic());
  EXPECT_NE(surface.assumption.find("taken as not periodic"), std::string::npos);
}

// The very bytes, by the format's description: what Gwyddion will see.
TEST(Gwy, WritesTheBytesThatTheFormatAsksFor) {
  const test::TemporaryFolder folder;
  const HeightField field({2, 2, Length::from_um(1.0), Length::from_um(2.0)}, Continuation::Periodic,
                          {1.0F, 2.0F, 3.0F, 4.0F});
  write_gwy(field, "t", {{"k", "v"}}, folder / "field.gwy");
  const auto expected =
      GwyBuilder()
          .object("/0/data", "GwyDataField",
                  gwy_field(2, 2, 1e-6 * 2.0, 2.0 * 1e-6 * 2.0, {3.0 * 1e-6, 4.0 * 1e-6, 1.0 * 1e-6, 2.0 * 1e-6}))
          .text("/0/data/title", "t")
          .object("/0/meta", "GwyContainer",
                  GwyBuilder().text("k", "v").text("Mezzotint continuation", "periodic, 2 x 2 samples"));
  EXPECT_EQ(bytes_of(folder / "field.gwy"), expected.file());
}

TEST(Gwy, OneOfSeveralChannelsIsReadByItsName) {
  const auto channel = [](double height_m) { return gwy_field(1, 1, 1e-6, 1e-6, {height_m}); };
  const auto file = GwyBuilder()
                        .object("/12/data", "GwyDataField", channel(12e-6))
                        .object("/1/data", "GwyDataField", channel(1e-6))
                        .object("/1/mask", "GwyDataField", gwy_field(1, 1, 1, 1, {1.0}))
                        .object("/3/data", "GwyDataField", channel(3e-6));
  const test::TemporaryFolder folder;
  write_file(folder / "scan.gwy", file.file());
  const SurfaceFile first = read_surface(folder / "scan.gwy");
  EXPECT_EQ(first.field.missing_count(), 1U);
  EXPECT_NE(first.assumption.find("the first of 3 channels is read (/1/data, /3/data, /12/data)"), std::string::npos);
  const SurfaceFile third = read_surface(folder / "scan.gwy#/3/data");
  EXPECT_NEAR(third.field.datum().um(), 3.0, 1e-12);
  EXPECT_EQ(third.assumption, "");
  EXPECT_EQ(third.field.missing_count(), 0U);  // the mask is that of another channel
  EXPECT_NEAR(read_surface(folder / "scan.gwy#/12").field.datum().um(), 12.0, 1e-12);
  for (const char* name : {"scan.gwy#/2/data", "scan.gwy#/x/data", "scan.gwy#/", "scan.gwy#/3/mask"}) {
    EXPECT_THROW(static_cast<void>(read_surface(folder / name)), FileError) << name;
  }
}

TEST(Gwy, RefusesToWriteIntoAFolderThatIsNotThere) {
  const test::TemporaryFolder folder;
  EXPECT_THROW(write_gwy(awkward_field(Continuation::Mirrored), "", {}, folder / "missing" / "field.gwy"), DeviceError);
}

}  // namespace
}  // namespace mezzotint
