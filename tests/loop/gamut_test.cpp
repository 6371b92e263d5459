#include <gtest/gtest.h>

#include "tests/loop/workplace.h"

namespace mezzotint::test {
namespace {

constexpr const char* small_gamut = "gamut printer.toml --pattern sinusoid --rays 2 --json --quiet -o out";

TEST(GamutCommand, SaysWhatCanBePrintedAndDrawsIt) {
  const Workplace here;
  const Ending ending = here.mezzotint(words(std::string(small_gamut) + " --target 0.3,0.2"));
  ASSERT_EQ(ending.status, 0) << ending.err;
  const auto said = nlohmann::json::parse(ending.out);
  EXPECT_EQ(said.at("targets").at(0).at("reached"), true);
  // √2 · (2/3 µm / 50 µm) · √(0.8365/2): the ground's octave of 50 µm alone.
  EXPECT_NEAR(said.at("formula").at("floor_alpha").at("value").get<double>(), 0.01219, 1e-5);
  const auto written = here.read_json("out/gamut.json");
  EXPECT_EQ(written.at("regions").size(), 3U) << "one kind at three blurs";
  EXPECT_NE(here.read("out/gamut.csv").find("sinusoid,1,steepest,"), std::string::npos);
  EXPECT_NE(here.read("out/gamut.svg").find("</svg>"), std::string::npos);
  EXPECT_NE(here.read("out/gamut.html").find("What dlp9000 can print"), std::string::npos);
}

TEST(GamutCommand, EndsWith3WhereATargetCannotBePrinted) {
  const Workplace here;
  const Ending ending = here.mezzotint(words(std::string(small_gamut) + " --target 0.3,0.2 --target 0.3,0.005"));
  EXPECT_EQ(ending.status, 3) << ending.err;
  const auto target = nlohmann::json::parse(ending.out).at("targets").at(1);
  EXPECT_EQ(target.at("reached"), false);
  const auto& verdict = target.at("verdicts").at(0);
  EXPECT_EQ(verdict.at("by_formula"), true);
  EXPECT_NE(verdict.at("why").get<std::string>().find("ratio 60 is above"), std::string::npos);
  EXPECT_GT(verdict.at("nearest").at("alpha_y").at("value"), 0.0121);
}

TEST(GamutCommand, RefusesBadInput) {
  const Workplace here;
  const auto refused = [&](const std::string& more, const char* says) {
    const Ending ending = here.mezzotint(words("gamut printer.toml -o out " + more));
    EXPECT_EQ(ending.status, 2) << ending.err;
    EXPECT_NE(ending.err.find(says), std::string::npos) << ending.err;
    EXPECT_FALSE(std::filesystem::exists(here / "out"));
  };
  refused("--target 0.3", "ALPHA_X,ALPHA_Y");
  refused("--target 0.1,0.3", "steeper axis");
  refused("--target 0.3,nan", "[0.001, 2]");
  refused("--target 0.3,0.1x", "is not");
  refused("--pattern waves", "--pattern");
  refused("--longest-um 20", "must exceed the shortest one");
  refused("--rays 1", "--rays");
}

}  // namespace
}  // namespace mezzotint::test
