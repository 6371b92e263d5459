#include <set>
#include <sstream>

#include <gtest/gtest.h>

#include "tests/loop/workplace.h"

namespace mezzotint::test {
namespace {

// One line a command, each with what the ones before it left.
const std::vector<std::string> every_command = {
    "run small.toml --out run",
    "design small.toml --out design",
    "job run/job.uvj",
    "print run/job.uvj -o printed.gwy --subsamples 2",
    "validate run/design.gwy --measured run/measured.gwy -o validation",
    "synthesize pattern.toml -o relief.gwy",
    "expose pattern.toml -o gray.png --pixels 32,32 --proximity-correction --steps 3 --residual residual.gwy",
    "info relief.gwy",
    "roughness relief.gwy --profile 0,16,124,16 --report texture.html",
    "measure relief.gwy -o scan.al3d --bandwidth 30 --noise 20 --outliers 0.01,5 --offset 76",
    "synthesize pattern.toml -o waves.gwy --set grid.columns=128 --set grid.rows=128",
    "texture-fit waves.gwy -o fitted.toml",
    "correct relief.gwy -o corrected.gwy --level plane",
    "convert relief.gwy relief.obj",
    "mesh relief.gwy -o mesh.obj",
    "chart --families sinusoid --cells 64 --resolution 8 --gradients 0.1 --incidences 0 -o chart",
    "calibrate " MEZZOTINT_SOURCE_DIR "/experiments/printers/wedge-steps.csv -o calibrated.toml",
    "gamut printer.toml --pattern ridges --rays 2 --target 0.3,0.0122 -o gamut",
    "bsdf relief.gwy --incidence 20,0 --samples 1e4 -o lobe.exr --report lobe.html",
    "bsdf mesh.obj --incidence 20,0 --samples 1e4 --material conductor:0.2,3.9/0.9,2.4/1.1,1.9 -o colour.exr",
    "info mesh.obj",
    "repair part.obj -o part.stl",
    "slice part.obj -o part.sl1",
    "job part.sl1",
    "info part.stl --unit in",
    "info colour.exr",
    "bsdf-table relief.gwy --symmetry isotropic --tolerance 1 --resolution 16 -o table.exr",
    "info table.exr"};

// The first word of each line under "Subcommands:".
std::set<std::string> commands_in_the_help(const std::string& help) {
  std::istringstream stream(help.substr(help.find("Subcommands:")));
  std::set<std::string> names;
  std::string line;
  std::getline(stream, line);
  while (std::getline(stream, line) && line.starts_with("  ")) names.insert(words(line).front());
  return names;
}

TEST(Output, OfEveryCommandIsTriedHere) {
  const Ending help = Workplace().mezzotint({"--help"});
  EXPECT_EQ(help.status, 0);
  std::set<std::string> tried;
  for (const auto& line : every_command) tried.insert(words(line).front());
  EXPECT_EQ(commands_in_the_help(help.out), tried);
}

TEST(Output, IsOneJsonObjectWhereJsonIsAskedFor) {
  const Workplace here;
  for (const auto& line : every_command) {
    const Ending ending = here.mezzotint(words(line + " --json"));
    ASSERT_EQ(ending.status, 0) << line << "\n" << ending.err;
    EXPECT_TRUE(nlohmann::json::accept(ending.out)) << line << "\n" << ending.out;
    EXPECT_EQ(ending.out.front(), '{') << line;
    std::istringstream progress(ending.err);
    for (std::string event; std::getline(progress, event);) EXPECT_TRUE(nlohmann::json::accept(event)) << event;
  }
}

// A budget that cannot meet the tolerance: the file is written, and the user is told on either way.
TEST(Output, HoldsWhatMustBeKnownBeforeItIsTrusted) {
  const Workplace here;
  ASSERT_EQ(here.mezzotint(words("synthesize pattern.toml -o relief.gwy")).status, 0);
  const std::string line = "bsdf relief.gwy --incidence 20,0 --samples 1e3 --tolerance 1e-5 -o lobe.exr";
  const Ending text = here.mezzotint(words(line));
  EXPECT_EQ(text.status, 3);
  EXPECT_NE(text.err.find("warning: the tolerance of 1e-05 was not met"), std::string::npos) << text.err;
  const Ending json = here.mezzotint(words(line + " --json -q"));
  EXPECT_TRUE(json.err.empty()) << json.err;
  const nlohmann::json object = nlohmann::json::parse(json.out);
  bool told = false;
  for (const auto& warning : object.at("warnings"))
    told = told || warning.get<std::string>().starts_with("the tolerance of 1e-05 was not met");
  EXPECT_TRUE(told) << json.out;
}

TEST(Output, IsOneJsonObjectWhereTheTargetIsMissedToo) {
  const Ending ending = Workplace().mezzotint(words("run small.toml --set target.alpha_x=1.8 --json -q"));
  EXPECT_EQ(ending.status, 3);
  ASSERT_TRUE(nlohmann::json::accept(ending.out)) << ending.out;
  EXPECT_FALSE(nlohmann::json::parse(ending.out).at("met"));
}

TEST(Output, OnStandardErrorIsNothingWhenQuiet) {
  const Workplace here;
  for (const auto& line : every_command) {
    const Ending ending = here.mezzotint(words(line + " --quiet"));
    ASSERT_EQ(ending.status, 0) << line << "\n" << ending.err;
    EXPECT_EQ(ending.err, "") << line;
    EXPECT_NE(ending.out, "") << line;
  }
}

TEST(Output, ThatCannotBePrintedIsAFailure) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "needs /dev/full";
  const Workplace here;
  ASSERT_EQ(here.mezzotint(words("synthesize pattern.toml -o relief.gwy")).status, 0);
  for (const char* line : {"info relief.gwy", "info relief.gwy --json", "--help", "--version"}) {
    const Ending ending = here.mezzotint(words(line), {.standard_output = "/dev/full"});
    EXPECT_EQ(ending.status, 1) << line;
    EXPECT_NE(ending.err.find("standard output"), std::string::npos) << line << "\n" << ending.err;
  }
}

// A file stands where a folder is needed: nobody may write there, root included.
TEST(Output, IntoAPlaceThatCannotBeWrittenFailsInWords) {
  const Workplace here;
  ASSERT_EQ(here.mezzotint(words("run small.toml --out run")).status, 0);
  ASSERT_EQ(here.mezzotint(words("synthesize pattern.toml -o relief.gwy")).status, 0);
  const Files before = here.files();
  for (const char* line : {"run small.toml --out small.toml/run", "design small.toml --out small.toml/run",
                           "synthesize pattern.toml -o small.toml/relief.gwy",
                           "synthesize pattern.toml -o missing/relief.gwy", "convert relief.gwy missing/relief.obj",
                           "repair part.obj -o missing/part.stl", "slice part.obj -o missing/part.sl1",
                           "correct relief.gwy -o missing/relief.gwy", "mesh relief.gwy -o missing/relief.obj",
                           "measure relief.gwy -o missing/scan.al3d", "print run/job.uvj -o missing/printed.gwy",
                           "bsdf relief.gwy --incidence 20,0 --samples 1e4 -o missing/lobe.exr",
                           "validate run/design.gwy --measured run/measured.gwy -o small.toml"}) {
    const Ending ending = here.mezzotint(words(std::string(line) + " --quiet"));
    EXPECT_EQ(ending.status, 1) << line << "\n" << ending.err;
    EXPECT_EQ(ending.out, "") << line;
    EXPECT_TRUE(ending.err.find("cannot") != std::string::npos) << line << "\n" << ending.err;
  }
  EXPECT_EQ(differences(here.files(), before), "");
}

TEST(Output, ToAFullDiskFailsInWordsAndLeavesNoHalfFile) {
  const Workplace here;
  ASSERT_EQ(here.mezzotint(words("synthesize pattern.toml -o relief.gwy")).status, 0);
  const Files before = here.files();
  for (const char* line :
       {"synthesize pattern.toml -o second.gwy", "convert relief.gwy relief.obj", "mesh relief.gwy -o relief.obj",
        "bsdf relief.gwy --incidence 20,0 --samples 1e4 -o lobe.exr", "run small.toml --out run"}) {
    const Ending ending = here.mezzotint(words(std::string(line) + " --quiet"), {.largest_file_bytes = 1000});
    EXPECT_EQ(ending.status, 1) << line;
    EXPECT_NE(ending.err.find("cannot write"), std::string::npos) << line << "\n" << ending.err;
    Files left = here.files();
    // What was whole before the disk was full stays: a mesh's material file, and stages of a run for --resume.
    left.erase("relief.mtl");
    std::erase_if(left,
                  [](const auto& file) { return file.first.starts_with("run/") && file.first.ends_with(".json"); });
    EXPECT_EQ(differences(left, before), "") << line;
  }
}

TEST(Output, OfARunGoesOnWhenTheDiskHasRoomAgain) {
  const Workplace here;
  ASSERT_EQ(here.mezzotint(words("run small.toml --out whole")).status, 0);
  // 20 kB hold the design, but no relief; 200 kB the reliefs and the job, but not the report.
  for (const rlim_t bytes : {20'000, 500'000}) {
    const Ending ending = here.mezzotint(words("run small.toml --out run --resume"), {.largest_file_bytes = bytes});
    EXPECT_EQ(ending.status, 1) << ending.err;
  }
  EXPECT_EQ(here.mezzotint(words("run small.toml --out run --resume")).status, 0);
  EXPECT_EQ(differences(here.files("run"), here.files("whole")), "");
}

}  // namespace
}  // namespace mezzotint::test
