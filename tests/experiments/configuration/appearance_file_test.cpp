#include <filesystem>
#include <fstream>
#include <string>

#include <gtest/gtest.h>

#include "experiments/configuration/appearance_file.h"
#include "experiments/configuration/toml_table.h"
#include "tests/test_data.h"

namespace mezzotint {
namespace {

Appearance read(const std::string& text) {
  const test::TemporaryFolder folder;
  const auto path = folder.path() / "appearance.toml";
  std::ofstream(path) << text;
  return read_appearance(path);
}

std::string complaint(const std::string& text) {
  try {
    (void)read(text);
  } catch (const ConfigurationError& error) {
    return error.what();
  }
  return "";
}

TEST(AppearanceFile, EveryExampleIsRead) {
  int count = 0;
  for (const auto& file :
       std::filesystem::directory_iterator(std::filesystem::path(MEZZOTINT_SOURCE_DIR) / "experiments/appearances")) {
    EXPECT_NO_THROW((void)read_appearance(file.path())) << file.path();
    ++count;
  }
  EXPECT_GE(count, 4);
}

TEST(AppearanceFile, HasPatternFieldAndRegions) {
  const Appearance appearance = read(R"(
[surface]
crease_deg = 25
[pattern]
kind = "ridges"
wavelength_um = 90
[field]
follow = "axis"
axis = [0, 0, 2]
turn_deg = 90
smoothing_mm = 0.25
[[region]]
group = "lid"
kind = "noise"
height_um = 3
[[region]]
group = "floor"
kind = "none"
)");
  EXPECT_NEAR(appearance.crease.degrees(), 25.0, 1e-12);
  EXPECT_EQ(appearance.field.kind, FieldGuide::Kind::Axis);
  EXPECT_EQ(appearance.field.axis.z(), 2.0);
  EXPECT_NEAR(appearance.field.turn.degrees(), 90.0, 1e-12);
  EXPECT_EQ(appearance.field.smoothing, 0.25_mm);
  EXPECT_EQ(std::get<Ridges>(*appearance.pattern).wavelength, 90.0_um);
  ASSERT_EQ(appearance.regions.size(), 2U);
  EXPECT_EQ(appearance.regions[0].group, "lid");
  EXPECT_EQ(height_of(*appearance.regions[0].pattern), 3.0_um);
  EXPECT_FALSE(appearance.regions[1].pattern.has_value());
}

TEST(AppearanceFile, ComplainsOfWhatItDoesNotKnow) {
  const std::string noise = "[pattern]\nkind = \"noise\"\n";
  EXPECT_NE(complaint(noise + "[field]\nfolow = \"axis\"\n").find("folow"), std::string::npos);
  EXPECT_NE(complaint(noise + "[field]\naxis = [0, 0]\n").find("3 numbers"), std::string::npos);
  EXPECT_NE(complaint(noise + "[field]\naxis = [0, 0, 0]\n").find("no length"), std::string::npos);
  EXPECT_NE(complaint(noise + "[field]\nfollow = \"curvature\"\naxis = [1, 0, 0]\n").find("axis"), std::string::npos);
  EXPECT_NE(complaint("[surface]\n").find("[pattern]"), std::string::npos);
  EXPECT_NE(complaint(noise + "[[region]]\nlabel = 1\nkind = \"noise\"\n").find("[picture]"), std::string::npos);
  EXPECT_NE(complaint(noise + "[[region]]\ngroup = \"lid\"\n").find("kind"), std::string::npos);
  EXPECT_NE(complaint(noise + "[picture]\nlabels = \"none.png\"\n").find("none.png"), std::string::npos);
  EXPECT_NE(complaint(noise + "scale_um = { free = [30.0, 60.0] }\n").find("free"), std::string::npos);
}

}  // namespace
}  // namespace mezzotint
