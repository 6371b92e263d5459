#include <filesystem>
#include <sstream>

#include <gtest/gtest.h>
#include <unistd.h>
#include <csignal>

#include "tests/loop/workplace.h"

namespace mezzotint::test {
namespace {

// A box of 0.6 × 0.5 × 0.2 mm, as an OBJ with its lid in a group.
constexpr const char* box = R"(v 0 0 0
v .6 0 0
v 0 .5 0
v .6 .5 0
v 0 0 .2
v .6 0 .2
v 0 .5 .2
v .6 .5 .2
g body
f 1 3 2
f 2 3 4
f 1 2 5
f 2 6 5
f 3 7 4
f 4 7 8
f 1 5 3
f 3 5 7
f 2 4 6
f 4 8 6
g lid
f 5 6 7
f 6 8 7
)";

constexpr const char* noise = "[pattern]\nkind = \"noise\"\nheight_um = 16\n";

nlohmann::json slice(const Workplace& here, const std::string& options) {
  const Ending ending = here.mezzotint(words("slice box.obj -o job.uvj --json --quiet " + options));
  EXPECT_EQ(ending.status, 0) << ending.err;
  return nlohmann::json::parse(ending.out);
}

TEST(Appearance, GrowsThePartByItsRelief) {
  const Workplace here;
  here.write("box.obj", box);
  here.write("noise.toml", noise);
  const double plain = slice(here, "").at("volume").at("value");
  const auto clothed = slice(here, "--appearance noise.toml");
  EXPECT_EQ(clothed.at("relief").at("highest").at("value"), 16.0);
  // Half of 16 µm on average, on lid and walls.
  const double surface = 0.6 * 0.5 + 2.0 * 0.2 * (0.6 + 0.5);
  EXPECT_NEAR(clothed.at("volume").at("value").get<double>() - plain, 0.008 * surface, 0.25 * 0.008 * surface);
  EXPECT_EQ(clothed.at("open_rows"), 0);
  EXPECT_EQ(here.mezzotint(words("job job.uvj --json --quiet")).status, 0);

  const auto corrected = slice(here, "--appearance noise.toml --proximity-correction").at("proximity_correction");
  EXPECT_LT(corrected.at("error_after").at("value").get<double>(),
            corrected.at("error_before").at("value").get<double>());

  here.write("lid.toml", "[[region]]\ngroup = \"lid\"\nkind = \"ridges\"\nheight_um = 10\n");
  const auto lid = slice(here, "--appearance lid.toml");
  EXPECT_NEAR(lid.at("volume").at("value").get<double>() - plain, 0.005 * 0.3, 0.1 * 0.005 * 0.3);
  EXPECT_LT(lid.at("relief").at("waves").at(0).at("wavelength_error").at("value"), 0.01);
}

TEST(Appearance, TakesThePatternOfADesign) {
  const Workplace here;
  here.write("box.obj", box);
  const Ending designed = here.mezzotint(words("design small.toml --out design --quiet"));
  ASSERT_TRUE(designed.status == 0 || designed.status == 3) << designed.err;
  const auto pattern = nlohmann::json::parse(here.read("design/design.json")).at("pattern");
  const double plain = slice(here, "").at("volume").at("value");
  const auto clothed = slice(here, "--design design");
  EXPECT_NEAR(clothed.at("relief").at("highest").at("value").get<double>(), pattern.at("height_um").get<double>(),
              1e-9);
  EXPECT_GT(clothed.at("volume").at("value").get<double>(), 1.01 * plain);
}

TEST(Appearance, SaysWhatIsWrong) {
  const Workplace here;
  here.write("box.obj", box);
  here.write("wrong.toml", "[pattern]\nkind = \"noise\"\n[feild]\n");
  here.write("group.toml", "[[region]]\ngroup = \"side\"\nkind = \"noise\"\n");
  const auto complaint = [&](const std::string& options) {
    const Ending ending = here.mezzotint(words("slice box.obj -o job.uvj " + options));
    EXPECT_EQ(ending.status, 2) << ending.err;
    EXPECT_FALSE(std::filesystem::exists(here / "job.uvj"));
    return ending.err;
  };
  EXPECT_NE(complaint("--appearance wrong.toml").find("feild"), std::string::npos);
  EXPECT_NE(complaint("--appearance group.toml").find("\"lid\""), std::string::npos);
  EXPECT_NE(complaint("--appearance nothing.toml").find("nothing.toml"), std::string::npos);
  EXPECT_NE(complaint("--linear --proximity-correction").find("--linear"), std::string::npos);
}

TEST(Expose, ACorrectedPictureHalvesTheErrorOfItsPrint) {
  const Workplace here;
  for (const char* name : {"noise", "ridges", "brushed"}) {
    const std::string file = std::string(MEZZOTINT_SOURCE_DIR) + "/experiments/patterns/" + name + ".toml";
    const Ending ending = here.mezzotint(words("expose " + file +
                                               " -o gray.png --proximity-correction --residual left.gwy "
                                               "--set grid.columns=256 --set grid.rows=256 --json --quiet"));
    ASSERT_EQ(ending.status, 0) << ending.err;
    const auto json = nlohmann::json::parse(ending.out);
    EXPECT_EQ(json.at("columns"), 67);  // 512 µm by 7.54 µm
    EXPECT_LT(2.0 * json.at("proximity_correction").at("error_after").at("value").get<double>(),
              json.at("error").at("value").get<double>())
        << name;
    EXPECT_TRUE(std::filesystem::exists(here / "gray.png") && std::filesystem::exists(here / "left.gwy"));
  }
}

// Neither Ctrl-C nor a disk that fills up leaves a job behind, or a piece of one.
TEST(Appearance, LeavesNoBrokenJobBehind) {
  const Workplace here;
  here.write("box.obj", box);
  here.write("noise.toml", noise);
  const Files before = here.files();
  const auto command = words("slice box.obj -o job.uvj --appearance noise.toml --layer-mm 0.0002 --json");
  Conditions full;
  full.largest_file_bytes = 20'000;
  EXPECT_EQ(here.mezzotint(command, full).status, 1);
  EXPECT_EQ(here.files(), before);

  RunningProgram running(here.path(), command);
  ::usleep(700'000);
  running.send(SIGINT);
  const Ending ending = running.wait();
  EXPECT_EQ(ending.status, 1) << ending.err;
  EXPECT_EQ(here.files(), before);
}

}  // namespace
}  // namespace mezzotint::test
