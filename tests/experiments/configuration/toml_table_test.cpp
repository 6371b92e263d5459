#include "experiments/configuration/toml_table.h"

#include <fstream>

#include <gtest/gtest.h>

#include "experiments/configuration/suggestion.h"
#include "tests/test_data.h"

namespace mezzotint {
namespace {

class TomlTableTest : public testing::Test {
protected:
  TomlFile parse(const std::string& text, const std::vector<std::string>& settings = {}) {
    std::ofstream(folder_ / "run.toml") << text;
    return TomlFile(folder_ / "run.toml", settings);
  }
  // The complaint about a file, without the folder's name.
  template <typename Use>
  std::string complaint(const Use& use) {
    try {
      use();
    } catch (const ConfigurationError& error) {
      const std::string message = error.what();
      const auto name = message.find("run.toml");
      return name == std::string::npos ? message : message.substr(name);
    }
    return "no complaint";
  }
  test::TemporaryFolder folder_;
};

TEST_F(TomlTableTest, NamesFileLineColumnAndASuggestionForAnUnknownKey) {
  const TomlFile file = parse("[grid]\n\n  ptich_um = 2.0\n");
  const auto read = [&] {
    TomlTable root(file);
    TomlTable grid = root.table("grid");
    (void)grid.number("pitch_um", {0.1, 10.0}, 1.0);
    grid.finish();
  };
  EXPECT_EQ(complaint(read), "run.toml:3:3: unknown key \"ptich_um\" in [grid]; did you mean \"pitch_um\"?");
}

TEST_F(TomlTableTest, RecognisesAWrongUnit) {
  const TomlFile file = parse("[pattern]\nscale_mm = 0.09\n");
  const auto read = [&] {
    TomlTable root(file);
    TomlTable pattern = root.table("pattern");
    (void)pattern.number("scale_um", {0.1, 1e5}, 90.0);
    pattern.finish();
  };
  EXPECT_EQ(complaint(read),
            "run.toml:2:1: unknown key \"scale_mm\" in [pattern]; the unit is part of the key: \"scale_um\"");
}

TEST_F(TomlTableTest, RecognisesAWrongTypeAndSaysTheUnit) {
  const TomlFile file = parse("[pattern]\nscale_um = \"90 um\"\n");
  const auto read = [&] {
    TomlTable root(file);
    (void)root.table("pattern").number("scale_um", {0.1, 1e5});
  };
  EXPECT_EQ(complaint(read), "run.toml:2:12: \"scale_um\" must be a number in micrometres, not a text");
}

TEST_F(TomlTableTest, RefusesNumbersOutOfRangeAndNotANumber) {
  const TomlFile file = parse("alpha = 7.0\nbeta = nan\n");
  TomlTable root(file);
  EXPECT_EQ(complaint([&] {
              (void)root.number("alpha", {0.0, 2.0});
            }),
            "run.toml:1:9: \"alpha\" = 7 is out of range; it must be in [0, 2]");
  EXPECT_NE(complaint([&] { (void)root.number("beta", {0.0, 2.0}); }), "no complaint");
}

TEST_F(TomlTableTest, SaysWhatIsMissing) {
  const TomlFile file = parse("[target]\nkind = \"beckmann\"\n");
  TomlTable root(file);
  EXPECT_EQ(complaint([&] {
              (void)root.table("target").number("alpha_x", {0.0, 2.0});
            }),
            "run.toml:1:1: \"alpha_x\" is missing in [target]");
}

TEST_F(TomlTableTest, ReadsFixedAndGamutParameters) {
  const TomlFile file = parse("a = 5.0\nb = { free = [1.0, 4.0], start = 2.0 }\nc = { free = [4.0, 1.0] }\n");
  TomlTable root(file);
  EXPECT_EQ(root.number_or_free("a", {0.0, 10.0}).fixed, 5.0);
  const NumberOrFree free = root.number_or_free("b", {0.0, 10.0});
  EXPECT_FALSE(free.fixed);
  EXPECT_EQ(free.low, 1.0);
  EXPECT_EQ(free.high, 4.0);
  EXPECT_EQ(free.start, 2.0);
  EXPECT_NE(complaint([&] { (void)root.number_or_free("c", {0.0, 10.0}); }), "no complaint");
}

TEST_F(TomlTableTest, TakesSettingsOfTheCommandLineAndSaysWhenTheyAreWrong) {
  const TomlFile file = parse("[target]\nkind = \"beckmann\"\n", {"target.kind=scan", "target.alpha_x=0.5"});
  TomlTable root(file);
  TomlTable target = root.table("target");
  EXPECT_EQ(target.text("kind"), "scan");
  EXPECT_EQ(target.number("alpha_x", {0.0, 1.0}), 0.5);
  const TomlFile wrong = parse("[target]\n", {"target.alpha_z=0.5"});
  const auto read = [&] {
    TomlTable other(wrong);
    TomlTable table = other.table("target");
    (void)table.has("alpha_x");
    table.finish();
  };
  EXPECT_EQ(complaint(read),
            "--set target.alpha_z=0.5: unknown key \"alpha_z\" in [target]; did you mean \"alpha_x\"?");
  EXPECT_NE(complaint([&] { (void)parse("", {"nothing"}); }), "no complaint");
}

TEST_F(TomlTableTest, FindsFilesBesideTheOneThatNamesThem) {
  const TomlFile file = parse("near = \"printers/p.toml\"\n", {"far=scan.x3p"});
  TomlTable root(file);
  EXPECT_EQ(root.file("near"), folder_.path() / "printers/p.toml");
  EXPECT_EQ(root.file("far"), "scan.x3p");  // relative to where the user stands
}

TEST_F(TomlTableTest, PointsToTheLineThatIsNotToml) {
  EXPECT_EQ(complaint([&] { (void)parse("a = 1\nb = = 2\n"); }).substr(0, 11), "run.toml:2:");
  EXPECT_NE(complaint([&] { (void)TomlFile(folder_ / "missing.toml"); }), "no complaint");
  EXPECT_NE(complaint([&] { (void)TomlFile(folder_.path()); }), "no complaint");
}

TEST(Suggestion, CountsASwapAsOneSlip) {
  EXPECT_EQ(closest_match("ptich_um", {"pitch_um", "width_um"}), "pitch_um");
  EXPECT_EQ(closest_match("LN_BOBYQ", {"LN_BOBYQA", "LN_COBYLA"}), "LN_BOBYQA");
  EXPECT_FALSE(closest_match("zzz", {"pitch_um"}));
}

}  // namespace
}  // namespace mezzotint
