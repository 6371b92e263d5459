#include <csignal>

#include <gtest/gtest.h>

#include "tests/loop/workplace.h"

namespace mezzotint::test {
namespace {

std::string small_target(std::string_view target) {
  return small_experiment(
      "kind      = \"beckmann\"\nalpha_x   = 0.30\nalpha_y   = 0.15\ntolerance = 0.5\nrotation_tolerance_deg = 15.0\n",
      target);
}

constexpr std::string_view square = R"([target]
kind       = "image"
shape      = "square"
half_width = 0.2

[pattern]
kind              = "free_form"
pixels            = 32
evaluations       = 40
start_evaluations = 4

[simulation]
resolution = 24

[search]
fresh_draws = 4
)";

TEST(Design, LeavesEveryPromisedFile) {
  const Workplace here;
  const Ending ending = here.mezzotint({"design", "small.toml", "-o", "d", "--set", "search.draws=4"});
  ASSERT_EQ(ending.status, 0) << ending.err;
  const Files files = here.files("d");
  for (const char* name : {"design.json", "pattern.toml", "gray.png", "relief.gwy", "predicted_0.exr", "target_0.exr",
                           "gamut.json", "evaluations.jsonl", "report.html"})
    EXPECT_TRUE(files.contains(name)) << name;
  const auto design = here.read_json("d/design.json");
  for (const char* draws : {"search_draws", "fresh_draws", "traced"}) {
    const auto& error = design.at("figures").at(draws).at("cube_root_error");
    EXPECT_GT(error.at("value"), 0.0) << draws;
    EXPECT_GT(error.at("standard_error"), 0.0) << draws;
    EXPECT_GT(error.at("floor"), 0.0) << draws;
  }
  EXPECT_EQ(design.at("gamut").at("place"), "inside");
  EXPECT_EQ(design.at("gray").at("first_line"), "largest y");
  EXPECT_EQ(design.at("blur").at("prints").size(), 3U);
  EXPECT_GT(design.at("blur").at("prints").at(0).at("alpha_x").at("value"),
            design.at("blur").at("prints").at(2).at("alpha_x").at("value"))
      << "less blur is steeper";
  const Ending info = here.mezzotint({"info", "d/predicted_0.exr", "--json"});
  EXPECT_EQ(info.status, 0) << info.err;
}

TEST(Design, SaysBeforeTheSearchThatATargetIsOutOfReach) {
  const Workplace here;
  here.write("steep.toml", small_experiment("alpha_x   = 0.30\nalpha_y   = 0.15", "alpha_x = 0.6\nalpha_y = 0.02"));
  const Ending ending = here.mezzotint({"design", "steep.toml", "-o", "d"});
  EXPECT_EQ(ending.status, 3) << ending.err;
  const auto said = ending.out.find("cannot be printed with noise");
  EXPECT_LT(said, ending.out.find("Target missed")) << ending.out;
  EXPECT_NE(ending.out.find("ridges+sinusoid", said), std::string::npos) << "the kinds that would reach it";
  EXPECT_EQ(here.read_json("d/design.json").at("gamut").at("place"), "outside");
}

TEST(Design, TakesEveryKindOfTarget) {
  const Workplace here;
  here.write("small.toml", small_experiment("draws           = 2", "draws = 4"));
  ASSERT_EQ(here.mezzotint(words("design small.toml -o first -q")).status, 0);
  std::filesystem::copy_file(here / "first/relief.gwy", here / "relief.gwy");
  for (const std::string target :
       {"kind = \"ggx\"\nalpha_x = 0.25\nalpha_y = 0.12\n", "kind = \"anisotropy\"\nratio = 2.0\nmean_alpha = 0.15\n",
        "kind = \"image\"\nshape = \"ring\"\nradius = 0.2\n", "kind = \"bsdf\"\nfiles = [\"first/predicted_0.exr\"]\n",
        "kind = \"scan\"\nscan = \"relief.gwy\"\n"}) {
    here.write("any.toml", small_target(target));
    const Ending ending =
        here.mezzotint(words("design any.toml -o any -q --set search.max_evaluations=150 --set "
                             "search.traced_evaluations=0"));
    EXPECT_TRUE(ending.status == 0 || ending.status == 3) << target << ending.err;
    EXPECT_TRUE(here.files("any").contains("predicted_0.exr")) << target;
    EXPECT_TRUE(here.files("any").contains("report.html")) << target;
  }
}

// Stops as soon as the search has left a trace, goes on, and is to be what one that never stopped is.
void expect_same_after_an_interruption(const Workplace& here, const std::string& line, const char* trace) {
  const Ending whole = here.mezzotint(words(line + " -o whole"));
  ASSERT_TRUE(whole.status == 0 || whole.status == 3) << whole.err;
  RunningProgram program(here.path(), words(line + " -o cut"));
  ASSERT_TRUE(program.wait_for(here / "cut" / trace));
  program.send(SIGINT);
  EXPECT_EQ(program.wait().status, 1);
  EXPECT_FALSE(here.files("cut").contains("design.json")) << "it came too late to interrupt anything";
  const Ending resumed = here.mezzotint(words(line + " -o cut --resume"));
  EXPECT_EQ(resumed.status, whole.status) << resumed.err;
  EXPECT_EQ(differences(here.files("cut"), here.files("whole")), "");
}

TEST(Design, InterruptedInTheSearchEndsInTheSameBits) {
  const Workplace here;
  expect_same_after_an_interruption(
      here,
      "design small.toml --set search.draws=48 --set search.max_evaluations=60 --set search.relative_tolerance=1e-12",
      "evaluations.jsonl");
}

TEST(Design, InterruptedInAFreeFormEndsInTheSameBits) {
  const Workplace here;
  here.write("square.toml", square);
  expect_same_after_an_interruption(here, "design square.toml", "free_form.state");
}

TEST(Design, RefusesFreeFormsThatCannotBe) {
  const Workplace here;
  here.write("square.toml", square);
  const auto refused = [&](const std::string& line) {
    const Ending ending = here.mezzotint(words(line));
    EXPECT_EQ(ending.status, 2) << line;
    return ending.err;
  };
  EXPECT_NE(refused("run square.toml -o no").find("mezzotint design"), std::string::npos);
  EXPECT_NE(refused("design square.toml -o no --set pattern.algorithm=LN_BOBYQA").find("LD_MMA"), std::string::npos);
  here.write("ratio.toml", std::string("[target]\nkind = \"anisotropy\"\nratio = 2.0\nmean_alpha = 0.15\n") +
                               "[pattern]\nkind = \"free_form\"\npixels = 32\n");
  EXPECT_NE(refused("design ratio.toml -o no").find("an anisotropy alone names none"), std::string::npos);
}

TEST(Design, OfRegionsHasOneDesignEachAndOneLayer) {
  const Workplace here;
  std::filesystem::copy_file(std::filesystem::path(MEZZOTINT_SOURCE_DIR) / "experiments/patterns/smiley.png",
                             here / "face.png");
  here.write("face.toml", small_target("kind = \"regions\"\nlabels = \"face.png\"\npixel_um = 7.54\n\n"
                                       "[[target.region]]\nlabel = 0\nkind = \"beckmann\"\nalpha_x = 0.3\n"
                                       "alpha_y = 0.15\n\n[[target.region]]\nlabel = 255\nkind = \"beckmann\"\n"
                                       "alpha_x = 0.2\nalpha_y = 0.15\n"));
  const Ending ending = here.mezzotint(words("design face.toml -o face"));
  ASSERT_TRUE(ending.status == 0 || ending.status == 3) << ending.err;
  const auto design = here.read_json("face/design.json");
  EXPECT_EQ(design.at("regions").size(), 2U);
  EXPECT_EQ(design.at("gray").at("columns"), 64);
  for (const char* name : {"face/region_0/design.json", "face/region_255/report.html", "face/gray.png",
                           "face/relief.gwy", "face/report.html"})
    EXPECT_TRUE(std::filesystem::exists(here / name)) << name;
  EXPECT_EQ(here.mezzotint(words("run face.toml -o other")).status, 2) << "a run has one patch";
}

TEST(Designs, OfOneNameAreRefused) {
  const Workplace here;
  EXPECT_EQ(here.mezzotint(words("design small.toml ./small.toml -o both")).status, 2);
}

}  // namespace
}  // namespace mezzotint::test
