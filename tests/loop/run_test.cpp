#include <gtest/gtest.h>

#include "tests/loop/workplace.h"

namespace mezzotint::test {
namespace {

const std::vector<std::string> promised_files = {"target.json",        "design.json",
                                                 "pattern.toml",       "design.gwy",
                                                 "predicted.gwy",      "job.uvj",
                                                 "printed.gwy",        "measured.gwy",
                                                 "registered.gwy",     "residual.gwy",
                                                 "comparison.json",    "bsdf_predicted_0.exr",
                                                 "bsdf_printed_0.exr", "bsdf_measured_0.exr",
                                                 "report.html",        "summary.json",
                                                 "run.json",           "timing.json",
                                                 "gamut.json",         "gray.png",
                                                 "relief.gwy",         "predicted_0.exr",
                                                 "target_0.exr",       "evaluations.jsonl"};

void expect_promised_files(const Files& files) {
  for (const auto& name : promised_files) {
    ASSERT_TRUE(files.contains(name)) << name;
    EXPECT_FALSE(files.at(name).empty()) << name;
  }
  EXPECT_EQ(files.size(), promised_files.size());
}

TEST(Run, ClosesTheLoopAndLeavesEveryPromisedFile) {
  const Workplace here;
  const Ending ending = here.mezzotint({"run", "small.toml", "--out", "run"});
  EXPECT_EQ(ending.status, 0) << ending.err;
  expect_promised_files(here.files("run"));
  EXPECT_NE(ending.out.find("run/report.html"), std::string::npos) << "the way to the report is told";
}

TEST(Run, NamesItsFolderAfterTheExperiment) {
  const Workplace here;
  EXPECT_EQ(here.mezzotint({"run", "small.toml"}).status, 0);
  expect_promised_files(here.files("runs/small"));
}

TEST(Run, ReachesAPlaceWithSpacesAndAccents) {
  const Workplace here;
  std::filesystem::create_directory(here / "ein Ordner für μm");
  here.write("ein Ordner für μm/böse \"Probe\".toml", small_experiment());
  EXPECT_EQ(here.mezzotint({"run", "ein Ordner für μm/böse \"Probe\".toml", "--out", "名前 1"}).status, 0);
  expect_promised_files(here.files("名前 1"));
}

void expect_quantity(const nlohmann::json& quantity, const std::string& unit) {
  EXPECT_TRUE(quantity.at("value").is_number()) << quantity;
  EXPECT_EQ(quantity.at("unit"), unit) << quantity;
  EXPECT_GT(quantity.at("standard_error"), 0.0) << quantity;
}

TEST(Run, SummaryGivesEachQuantityWithItsUnitAndStandardError) {
  const Workplace here;
  ASSERT_EQ(here.mezzotint({"run", "small.toml", "--out", "run"}).status, 0);
  const auto summary = here.read_json("run/summary.json");
  EXPECT_TRUE(summary.at("met"));
  expect_quantity(summary.at("fresh_draws").at("alpha_x"), "1");
  expect_quantity(summary.at("fresh_draws").at("rotation"), "°");
  const auto& comparison = summary.at("comparison");
  expect_quantity(comparison.at("registration").at("shift_x"), "µm");
  expect_quantity(comparison.at("roughness").at("measured").at("Sa"), "µm");
  expect_quantity(comparison.at("roughness").at("measured").at("Sdq"), "1");
  const auto& bsdf = summary.at("bsdf").at(0);
  expect_quantity(bsdf.at("albedo_printed"), "1");
  expect_quantity(bsdf.at("printed_to_target").at("relative_l2"), "1");
}

TEST(Run, ReportIsOnePageThatLoadsNothingFromElsewhere) {
  const Workplace here;
  ASSERT_EQ(here.mezzotint({"run", "small.toml", "--out", "run"}).status, 0);
  const std::string page = here.read("run/report.html");
  EXPECT_NE(page.find("A small loop"), std::string::npos);
  EXPECT_NE(page.find("</html>"), std::string::npos);
  for (const char* load : {"src=\"http", "href=\"http", "url(http", "<link rel=\"stylesheet\"", "src=\"./"}) {
    EXPECT_EQ(page.find(load), std::string::npos) << load;
  }
}

TEST(Run, ExitsWith3WhereTheTargetIsOutOfReach) {
  const Workplace here;
  const Ending ending = here.mezzotint({"run", "small.toml", "--out", "run", "--set", "target.alpha_x=1.8"});
  EXPECT_EQ(ending.status, 3);
  EXPECT_NE(ending.out.find("missed"), std::string::npos) << ending.out;
  expect_promised_files(here.files("run"));
  EXPECT_FALSE(here.read_json("run/summary.json").at("met"));
}

TEST(Run, GivesTheSameBitsWithAnyNumberOfThreads) {
  const Workplace here;
  ASSERT_EQ(here.mezzotint({"run", "small.toml", "--out", "one", "--threads", "1"}).status, 0);
  ASSERT_EQ(here.mezzotint({"run", "small.toml", "--out", "two", "--threads", "2"}).status, 0);
  EXPECT_EQ(differences(here.files("one"), here.files("two")), "");
}

TEST(Run, TakesChangedSettingsAndASeedFromTheCommandLine) {
  const Workplace here;
  here.write("changed.toml", small_experiment("draws           = 2", "draws = 3\nseed = 7"));
  ASSERT_EQ(here.mezzotint({"design", "changed.toml", "--out", "file"}).status, 0);
  ASSERT_EQ(here.mezzotint({"design", "small.toml", "--out", "line", "--set", "search.draws=3", "--seed", "7"}).status,
            0);
  EXPECT_EQ(here.read("file/design.json"), here.read("line/design.json"));
}

TEST(Run, GoesOnWhereADesignEnded) {
  const Workplace here;
  ASSERT_EQ(here.mezzotint({"design", "small.toml", "--out", "run"}).status, 0);
  const Files design = here.files("run");
  EXPECT_TRUE(design.contains("pattern.toml"));
  EXPECT_FALSE(design.contains("job.uvj"));
  ASSERT_EQ(here.mezzotint({"run", "small.toml", "--out", "run", "--resume"}).status, 0);
  expect_promised_files(here.files("run"));
  EXPECT_EQ(here.files("run").at("design.json"), design.at("design.json"));
}

TEST(Run, KeepsTheEarlierRunBesideTheNewOne) {
  const Workplace here;
  ASSERT_EQ(here.mezzotint({"design", "small.toml", "--out", "run"}).status, 0);
  const Files earlier = here.files("run");
  ASSERT_EQ(here.mezzotint({"design", "small.toml", "--out", "run/", "--seed", "7"}).status, 0);
  EXPECT_EQ(differences(earlier, here.files("run.previous")), "");
  EXPECT_NE(differences(earlier, here.files("run")), "");
}

// What stands in FOLDER.previous may be somebody's work: only an earlier run gives way.
TEST(Run, RefusesToReplaceAPreviousFolderThatIsNoRun) {
  const Workplace here;
  ASSERT_EQ(here.mezzotint({"design", "small.toml", "--out", "run"}).status, 0);
  std::filesystem::create_directory(here / "run.previous");
  here.write("run.previous/thesis.txt", "three years of work");
  EXPECT_EQ(here.mezzotint({"design", "small.toml", "--out", "run"}).status, 2);
  EXPECT_EQ(here.read("run.previous/thesis.txt"), "three years of work");
}

}  // namespace
}  // namespace mezzotint::test
