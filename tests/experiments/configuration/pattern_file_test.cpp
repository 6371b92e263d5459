#include "experiments/configuration/pattern_table.h"

#include <fstream>

#include <gtest/gtest.h>

#include "experiments/configuration/experiment_file.h"
#include "forward/pattern/pattern_parameters.h"
#include "tests/test_data.h"

namespace mezzotint {
namespace {

const std::filesystem::path shipped = std::filesystem::path(MEZZOTINT_SOURCE_DIR) / "experiments" / "patterns";

class PatternFileOf : public testing::Test {
protected:
  PatternFile read(const std::string& text) {
    std::ofstream(folder_ / "pattern.toml") << text;
    return read_pattern_file(folder_ / "pattern.toml");
  }
  std::string complaint(const std::string& text) {
    try {
      (void)read(text);
    } catch (const ConfigurationError& error) {
      const std::string message = error.what();
      return message.substr(message.find("pattern.toml"));
    }
    return "no complaint";
  }
  // As a part, where the place in the file still counts.
  std::string complaint_of_part(const std::string& part) {
    return complaint("[pattern]\nkind = \"sum\"\nparts = [{ kind = \"noise\" },\n" + part + "]\n");
  }
  void expect_complaint(const std::string& found, const std::string& place, const std::string& words) {
    EXPECT_TRUE(found.starts_with("pattern.toml:" + place)) << found;
    EXPECT_NE(found.find(words), std::string::npos) << found;
  }
  test::TemporaryFolder folder_;
};

TEST_F(PatternFileOf, EveryKindIsShippedAndSurvivesItsText) {
  std::set<std::string_view> kinds;
  for (const auto& entry : std::filesystem::directory_iterator(shipped)) {
    if (entry.path().extension() != ".toml") continue;
    const PatternFile file = read_pattern_file(entry.path());
    kinds.insert(kind_name(file.pattern));
    for (const PatternPart& part : parts_of(file.pattern) ? *parts_of(file.pattern) : std::vector<PatternPart>{}) {
      kinds.insert(kind_name(part.pattern));
      if (const auto* below = parts_of(part.pattern)) kinds.insert(kind_name(below->front().pattern));
    }
    const PatternFile again = read(pattern_file_text(file, "written again"));
    EXPECT_EQ(again.continuation, file.continuation);
    const HeightField one = synthesize(file.pattern, {40, 40, 9.0_um, 9.0_um});
    const HeightField two = synthesize(again.pattern, {40, 40, 9.0_um, 9.0_um});
    EXPECT_TRUE(std::ranges::equal(one.heights_um(), two.heights_um())) << entry.path();
  }
  EXPECT_EQ(kinds.size(), 11U);
}

TEST_F(PatternFileOf, APictureIsReadWithItsTopAtTheLargestY) {
  const PatternFile file = read_pattern_file(shipped / "regions.toml");
  const auto& regions = std::get<PatternRegions>(file.pattern);
  ASSERT_EQ(regions.columns, 64U);
  ASSERT_EQ(regions.rows, 64U);
  const auto label = [&](std::size_t column, std::size_t row) { return int{regions.labels[row * 64 + column]}; };
  EXPECT_EQ(label(42, 41), 255) << "the right eye is above the middle";
  EXPECT_EQ(label(32, 17), 255) << "the mouth is below it";
  EXPECT_EQ(label(32, 48), 0);
}

TEST_F(PatternFileOf, ACompositionSaysWhereItIsWrong) {
  expect_complaint(complaint("[pattern]\nkind = \"moire\"\n"), "2:8", "is not known");
  expect_complaint(complaint_of_part("{ kind = \"nosie\" }"), "4:10", "did you mean \"noise\"");
  expect_complaint(complaint_of_part("{ kind = \"noise\", ptich = 1.0 }"), "4:", "unknown key \"ptich\"");
  expect_complaint(complaint_of_part("{ kind = \"noise\", stretch = nan }"), "4:", "out of range");
  expect_complaint(complaint_of_part("{ kind = \"noise\", scale_um = { free = [30.0, 90.0] } }"),
                   "4:", "searches nothing; give it a value");
  expect_complaint(complaint_of_part("{ kind = \"product\" }"), "4:1", "2 parts or more");
  expect_complaint(complaint_of_part("{ kind = \"rotate\", rotation_deg = 3.0 }"), "4:1", "\"part\" is missing");
  expect_complaint(complaint_of_part("{ kind = \"mask\", inside = {}, outside = {} }"), "4:1", "\"mask\" is missing");
  expect_complaint(complaint("[pattern]\nkind = \"sum\"\nparts = []\n"), "3:", "2 parts or more");
  expect_complaint(complaint("[pattern]\nkind = \"sum\"\nparts = 7\n"), "3:", "list of tables");
  expect_complaint(complaint("[pattern]\nkind = \"product\"\nparts = [{}, { height_um = 3.0 }]\n"),
                   "3:", "shape alone");
  std::string many = "[pattern]\nkind = \"sum\"\nparts = [{}";
  for (int i = 0; i < 16; ++i) many += ", {}";
  expect_complaint(complaint(many + "]\n"), "2:8", "2 to 16 parts, not 17");
}

TEST_F(PatternFileOf, IsNotFollowedDeeperThanEightLevels) {
  std::string part = "{ kind = \"noise\" }";
  for (int level = 0; level < 7; ++level) part = "{ kind = \"rotate\", part = " + part + " }";
  EXPECT_EQ(complaint("[pattern]\nkind = \"rotate\"\npart = " + part + "\n").find("pattern.toml:3:"), 0U);
  EXPECT_NE(complaint("[pattern]\nkind = \"rotate\"\npart = " + part + "\n").find("8 levels"), std::string::npos);
  for (int level = 0; level < 2000; ++level) part = "{ part = " + part + " }";
  EXPECT_NE(complaint("[pattern]\nkind = \"rotate\"\npart = " + part + "\n"), "no complaint");
}

TEST_F(PatternFileOf, APictureThatIsMissingOrNoneIsNamed) {
  const std::string regions = "[pattern]\nkind = \"regions\"\nlabels = \"face.png\"\nparts = [{ label = 0 }]\n";
  expect_complaint(complaint(regions), "3:10", "face.png: no such file");
  std::ofstream(folder_ / "face.png") << "no picture";
  expect_complaint(complaint(regions), "3:10", "is no PNG picture");
  std::filesystem::copy_file(shipped / "smiley.png", folder_ / "face.png",
                             std::filesystem::copy_options::overwrite_existing);
  expect_complaint(complaint(regions), "2:8", "no part has the label 255");
  std::filesystem::resize_file(folder_ / "face.png", 200);
  expect_complaint(complaint(regions), "3:10", "PNG picture");
}

TEST_F(PatternFileOf, WholeNumbersStayWhole) {
  EXPECT_EQ(std::get<Turbulence>(read("[pattern]\nkind = \"turbulence\"\noctaves = 7\n").pattern).octaves, 7);
  expect_complaint(complaint("[pattern]\nkind = \"turbulence\"\noctaves = 2.5\n"), "3:11", "whole number");
  expect_complaint(complaint("[pattern]\nkind = \"fbm\"\noctaves = 17\n"), "3:11", "out of range");
}

TEST_F(PatternFileOf, ALineFieldHasItsSingularities) {
  const std::string lines = "[pattern]\nkind = \"line_integral_convolution\"\n";
  const auto file = read(lines + "singularities = [{ x_um = 5.0, y_um = -7.0, index = -0.5 }]\n");
  const auto& points = std::get<LineIntegralConvolution>(file.pattern).singularities;
  ASSERT_EQ(points.size(), 1U);
  EXPECT_EQ(points[0].place.y, -7.0_um);
  EXPECT_EQ(points[0].index, -0.5);
  expect_complaint(complaint(lines + "singularities = [{ x_um = 5.0, y_um = 0.0, index = 0.3 }]\n"),
                   "3:", "multiple of 0.5");
  expect_complaint(complaint(lines + "singularities = [{ x_um = 5.0 }]\n"), "3:", "\"y_um\" is missing");
}

TEST_F(PatternFileOf, ASearchRefusesWhatItCannotChange) {
  const auto search = [&](const std::string& pattern) -> std::string {
    std::ofstream(folder_ / "run.toml") << "[target]\nkind = \"beckmann\"\nalpha_x = 0.2\nalpha_y = 0.1\n" + pattern;
    try {
      (void)read_experiment(folder_ / "run.toml");
    } catch (const ConfigurationError& error) {
      return error.what();
    }
    return "no complaint";
  };
  const std::string sum = "[pattern]\nkind = \"sum\"\nparts = [{ kind = \"ridges\" }, { ";
  EXPECT_NE(search(sum + "seed = 5 }]\n").find("its seed is that of [search]"), std::string::npos);
  EXPECT_NE(search(sum + "kind = \"fbm\", octaves = { free = [2, 5] } }]\n").find("a search cannot change"),
            std::string::npos);
  EXPECT_NE(search(sum + "kind = \"ridges\", phase = 0.5 }]\n").find("drawn anew by a search"), std::string::npos);
  EXPECT_NE(search(sum + "}]\n").find("no parameter of the pattern is free"), std::string::npos);
  EXPECT_NE(search("[pattern]\nkind = \"fbm\"\noctaves = { free = [2, 5] }\n").find("a search cannot change"),
            std::string::npos);
  for (const std::string kind : {"noise", "fbm", "turbulence", "line_integral_convolution"}) {
    EXPECT_EQ(search("[pattern]\nkind = \"" + kind + "\"\nscale_um = { free = [30.2, 400.0] }\n"), "no complaint");
  }
}

TEST_F(PatternFileOf, WhatIsFreeInAPartHasItsPath) {
  std::ofstream(folder_ / "run.toml") << R"([target]
kind = "beckmann"
alpha_x = 0.2
alpha_y = 0.1
[pattern]
kind = "product"
height_um = { free = [4.0, 17.0] }
[[pattern.parts]]
kind = "rotate"
rotation_deg = { free = [-90.0, 90.0], start = 5.0 }
part = { kind = "ridges", skew = { free = [0.3, 0.7] } }
[[pattern.parts]]
kind = "mask"
inside = { scale_um = { free = [40.0, 90.0] }, height_um = 3.0 }
outside = {}
mask = { kind = "sinusoid", wavelength_u_um = { free = [200.0, 900.0] } }
)";
  const PatternSpecification read = read_experiment(folder_ / "run.toml").pattern;
  std::vector<std::string> names;
  for (const FreeParameter& free : read.free) {
    names.push_back(free.name);
    const PatternParameter entry = find_parameter(read.pattern, free.name);
    EXPECT_GE(free.low, entry.lowest) << free.name;
  }
  const std::vector<std::string> expected = {"height_um", "parts[0].rotation_deg", "parts[0].part.skew",
                                             "parts[1].inside.scale_um", "parts[1].mask.wavelength_u_um"};
  EXPECT_EQ(names, expected);
  EXPECT_EQ(read.free[1].start, 5.0);
  EXPECT_EQ(get_parameter(read.pattern, "parts[1].inside.height_um"), 3.0);
}

}  // namespace
}  // namespace mezzotint
