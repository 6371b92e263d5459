#include <gtest/gtest.h>

#include "tests/loop/workplace.h"

namespace mezzotint::test {
namespace {

constexpr const char* pattern = R"([pattern]
kind = "noise"
scale_um = 10.0
height_um = 6.0
seed = 17

[grid]
columns = 200
rows = 200
pitch_um = 2.0
)";

nlohmann::json results(const Workplace& here, const std::string& line, int status = 0) {
  const Ending ending = here.mezzotint(words(line + " --json --quiet"));
  EXPECT_EQ(ending.status, status) << line << "\n" << ending.err;
  return nlohmann::json::parse(ending.out);
}

// 40 × 40 cells: heights and slopes of a draw scatter by 1 % and 0.8 %, and the fitted ones as much (study of the
// texture fit): four times √2 of that. Another pattern than the fitted one would differ by more.
TEST(TextureFit, LeadsFromAReliefToAPatternThatGivesItsLikeAgain) {
  const Workplace here;
  here.write("noise.toml", pattern);
  results(here, "synthesize noise.toml -o scan.gwy");
  const auto fit = results(here, "texture-fit scan.gwy -o fitted.toml --kinds noise,ridges");
  EXPECT_EQ(fit.at("fits"), true);
  EXPECT_EQ(fit.at("kind"), "noise");
  const auto& scale = fit.at("parameters").at("scale_um");
  EXPECT_EQ(scale.at("unit"), "µm");
  EXPECT_GT(scale.at("standard_error"), 0.0);
  EXPECT_LT(scale.at("low_95"), 10.0);
  EXPECT_GT(scale.at("high_95"), 10.0);
  EXPECT_NE(here.read("fitted.toml").find("# scale_um = "), std::string::npos);
  results(here, "synthesize fitted.toml -o again.gwy --seed 4");
  const auto before = results(here, "roughness scan.gwy"), after = results(here, "roughness again.gwy");
  for (const char* name : {"Sq", "Sdq"}) {
    const double was = before.at(name).at("value"), is = after.at(name).at("value");
    EXPECT_NEAR(is / was, 1.0, 0.06) << name;
  }
}

TEST(TextureFit, WritesNothingWhereNoPatternFits) {
  const Workplace here;
  here.write("noise.toml", pattern);
  here.write("turbulence.toml",
             std::string(pattern).replace(std::string(pattern).find("\"noise\""), 7, "\"turbulence\""));
  results(here, "synthesize turbulence.toml -o scan.gwy");
  const auto fit = results(here, "texture-fit scan.gwy -o fitted.toml --kinds noise,fbm", 3);
  EXPECT_EQ(fit.at("fits"), false);
  EXPECT_TRUE(fit.at("written").is_null());
  EXPECT_FALSE(here.files().contains("fitted.toml"));
}

TEST(TextureFit, SaysHowLargeAPatchShouldBe) {
  const Workplace here;
  here.write("noise.toml", pattern);
  ASSERT_EQ(here.mezzotint(words("synthesize noise.toml -o scan.gwy --set pattern.scale_um=70")).status, 0);
  const Ending ending = here.mezzotint(words("texture-fit scan.gwy -o fitted.toml --kinds noise"));
  EXPECT_EQ(ending.status, 2) << ending.out;
  EXPECT_NE(ending.err.find("8 are needed: measure"), std::string::npos) << ending.err;
}

}  // namespace
}  // namespace mezzotint::test
