#include <cmath>

#include <gtest/gtest.h>

#include "tests/loop/workplace.h"

namespace mezzotint::test {
namespace {

// 6 µm · ½ sin(2πu/32 µm) sin(2πv/64 µm) has an RMS height of 1.5 µm; 64 samples of 2 µm hold whole periods.
TEST(Commands, LeadFromAPatternToItsLobe) {
  const Workplace here;
  const auto json = [&](const std::string& line) {
    const Ending ending = here.mezzotint(words(line + " --json --quiet"));
    EXPECT_EQ(ending.status, 0) << line << "\n" << ending.err;
    return nlohmann::json::parse(ending.out);
  };
  EXPECT_EQ(json("synthesize pattern.toml -o relief.gwy").at("written"), "relief.gwy");
  EXPECT_EQ(json("info relief.gwy").at("columns"), 64);
  EXPECT_EQ(json("info relief.gwy").at("width").at("value"), 128.0);
  EXPECT_NEAR(json("roughness relief.gwy --level none").at("Sq").at("value"), 1.5, 1e-6);

  // 128 µm hold four and two waves: made periodic, nothing of it is changed.
  EXPECT_NEAR(json("synthesize pattern.toml -o tile.gwy --set grid.periodic=true").at("periodic_change").at("value"),
              0.0, 1e-12);
  EXPECT_EQ(json("info tile.gwy").at("periodic"), true);
  EXPECT_EQ(json("info relief.gwy").at("periodic"), false);

  EXPECT_EQ(json("info relief.gwy").at("range").at("unit"), "µm");
  EXPECT_EQ(json("info relief.gwy").at("missing_share").at("value"), 0.0);
  const auto copy = json("convert tile.gwy copy.sur");
  EXPECT_EQ(copy.at("rows"), 64);
  EXPECT_EQ(copy.at("period_lost"), true);
  EXPECT_LT(copy.at("height_rounding").at("value"), 1e-8);

  const auto corrected = json("correct relief.gwy -o corrected.gwy --level plane --outliers 5 --fill");
  EXPECT_EQ(corrected.at("missing_after"), 0);
  EXPECT_EQ(json("correct relief.gwy -o part.gwy --crop 8,8,32,16").at("written"), "part.gwy");
  EXPECT_EQ(json("info part.gwy").at("rows"), 16);
  // Steps are done in the order in which they are given: a quarter turn exchanges the sides of what was cropped.
  EXPECT_EQ(json("correct relief.gwy -o turned.gwy --crop 8,8,32,16 --turn 90").at("steps").size(), 2U);
  EXPECT_EQ(json("info turned.gwy").at("rows"), 32);
  EXPECT_EQ(json("correct relief.gwy -o cropped.gwy --turn 90 --crop 8,8,32,16").at("warnings").size(), 0U);
  EXPECT_EQ(json("info cropped.gwy").at("rows"), 16);

  // Along x at the height of a crest of the other wave: 3 µm · sin(2πx/32 µm), Pq = 3/√2, but for the samples' 16 a
  // wave, and its line.
  const auto profile = json("roughness relief.gwy --level none --profile 0,16,124,16");
  EXPECT_NEAR(profile.at("Pq").at("value"), 3.0 / std::sqrt(2.0), 0.1);
  // As long as the filter's cut-off, half of a wave is left: 0.75 µm of 1.5.
  EXPECT_NEAR(json("roughness tile.gwy --level none --l-filter 28.6216701").at("Sq").at("value"), 0.75, 1e-3);

  // The optics pass half of a wave as long as the bandwidth, the tilt is levelled, the offset is the scan's datum.
  const auto scan = json("measure tile.gwy -o scan.al3d --bandwidth 28.6216701 --tilt -0.01,0.02 --offset 76");
  EXPECT_EQ(scan.at("missing"), 0);
  EXPECT_NEAR(json("info scan.al3d").at("datum").at("value"), 76000.0, 5.0);
  EXPECT_NEAR(json("roughness scan.al3d").at("Sq").at("value"), 0.75, 5e-3);  // the plane takes a little of the waves
  EXPECT_EQ(json("measure pattern.toml -o scan.al3d --pitch 4 --dropouts 0.1").at("columns"), 32);

  EXPECT_EQ(json("mesh relief.gwy -o relief.obj").at("vertices"), 64 * 64);
  EXPECT_NE(here.read("relief.mtl").find("Ni 1.5"), std::string::npos);
  EXPECT_NE(here.read("relief.mtl").find("illum 4"), std::string::npos);

  const auto lobe = json("bsdf relief.gwy --incidence 20,0 --resolution 16 --samples 1e5 -o lobe.exr");
  EXPECT_NEAR(lobe.at("albedo").at("value"), 0.04, 0.01) << "Fresnel at an index of 1.5";
  EXPECT_NEAR(lobe.at("albedo").at("value").get<double>() + lobe.at("transmitted").at("value").get<double>() +
                  lobe.at("cut_off").at("value").get<double>() + lobe.at("left_sideways").at("value").get<double>(),
              1.0, 1e-6);  // weights of paths are single
  EXPECT_EQ(json("info lobe.exr").at("incidence_theta").at("value"), 20.0);

  // Heights are floats about the field's mean, so a copy may differ by their rounding: 1e-7 of 6 µm. The 65535 levels
  // of a PNG are 1e-4 µm apart; their error averages out to half of its square over Sq.
  std::string before = "relief.gwy";
  for (const std::string ending : {"gwy", "x3p", "sur", "al3d", "exr", "png"}) {
    json("convert " + before + " again." + ending);
    before = "again." + ending;
    EXPECT_EQ(json("info " + before).at("format"), ending);
    EXPECT_NEAR(json("roughness " + before + " --level none").at("Sq").at("value"), 1.5, 1e-6) << ending;
  }
  EXPECT_EQ(json("info relief.gwy#/0/data").at("columns"), 64);
  json("convert relief.gwy mesh.obj");
  EXPECT_EQ(here.read("mesh.obj").substr(0, 1), "#");
}

class FinishedRun : public testing::Test {
protected:
  void SetUp() override { ASSERT_EQ(here.mezzotint({"run", "small.toml", "--out", "run"}).status, 0); }
  Workplace here;
};

TEST_F(FinishedRun, HasAJobThatCanBeCheckedAndPrintedAgain) {
  const Ending job = here.mezzotint(words("job run/job.uvj --json"));
  ASSERT_EQ(job.status, 0) << job.err;
  const auto checked = nlohmann::json::parse(job.out);
  EXPECT_EQ(checked.at("columns"), 48 + 2 * 8) << "the patch and its margin";
  EXPECT_EQ(checked.at("layers"), 1 + 1) << "base and patch";

  ASSERT_EQ(here.mezzotint(words("print run/job.uvj -o printed.gwy --subsamples 2 --json")).status, 0);
  const Ending info = here.mezzotint(words("info printed.gwy --json"));
  EXPECT_EQ(nlohmann::json::parse(info.out).at("columns"), 2 * (48 + 2 * 8));
}

TEST_F(FinishedRun, HasAJobWhoseDamageIsNoticed) {
  std::string bytes = here.read("run/job.uvj");
  bytes.resize(bytes.size() / 2);
  here.write("half.uvj", bytes);
  const Ending job = here.mezzotint({"job", "half.uvj"});
  EXPECT_EQ(job.status, 2);
  EXPECT_NE(job.err.find("half.uvj"), std::string::npos) << job.err;
}

// Five standard errors, and 0.1 µm or 0.02° for what the pixels' edges and the printer's ground noise move: the
// design does not know the ground.
void expect_found(const nlohmann::json& quantity, double true_value, double systematic) {
  const double error = quantity.at("standard_error");
  EXPECT_GT(error, 0.0);
  EXPECT_NEAR(quantity.at("value"), true_value, 5.0 * error + systematic);
}

TEST_F(FinishedRun, IsRegisteredWhereTheSampleLayUnderTheInstrument) {
  const Ending ending =
      here.mezzotint(words("validate run/design.gwy --measured run/measured.gwy -o validation --json"));
  ASSERT_EQ(ending.status, 0) << ending.err;
  const auto comparison = here.read_json("validation/comparison.json");
  EXPECT_EQ(comparison, nlohmann::json::parse(ending.out));
  const auto& registration = comparison.at("registration");
  expect_found(registration.at("shift_x"), 4.0, 0.1);
  expect_found(registration.at("shift_y"), -3.0, 0.1);
  expect_found(registration.at("rotation"), 0.5, 0.02);
  EXPECT_GT(registration.at("correlation"), 0.99);
  EXPECT_TRUE(here.files("validation").contains("registered.gwy"));
  EXPECT_TRUE(here.files("validation").contains("residual.gwy"));
}

TEST_F(FinishedRun, HasADesignThatCanBeSynthesized) {
  ASSERT_EQ(here.mezzotint(words("synthesize run/pattern.toml -o design.gwy")).status, 0);
  const Ending info = here.mezzotint(words("info design.gwy --json"));
  EXPECT_EQ(nlohmann::json::parse(info.out).at("columns"), 48);
}

}  // namespace
}  // namespace mezzotint::test
