#include <chrono>
#include <csignal>

#include <gtest/gtest.h>

#include "tests/loop/workplace.h"

namespace mezzotint::test {
namespace {

// Long enough to be stopped in the middle: the search and the tracing take about a second each.
std::vector<std::string> slow_run(const std::string& folder) {
  return {"run",   "small.toml",
          "--out", folder,
          "--set", "search.draws=96",
          "--set", "search.relative_tolerance=1e-12",
          "--set", "search.max_evaluations=200",
          "--set", "simulation.tolerance=1e-3",
          "--set", "simulation.samples=1000000"};
}

std::vector<std::string> resumed(std::vector<std::string> arguments) {
  arguments.emplace_back("--resume");
  return arguments;
}

Files without_temporaries(Files files) {
  std::erase_if(files, [](const auto& file) { return file.first.starts_with('.'); });
  return files;
}

// What an interrupted run left must be what the whole run has: no file is half there.
void expect_whole_files(const Files& left, const Files& whole) {
  for (const auto& [name, bytes] : left) {
    if (name == "run.json" || name == "timing.json") {
      EXPECT_TRUE(nlohmann::json::accept(bytes)) << name;
    } else {
      EXPECT_TRUE(whole.contains(name) && whole.at(name) == bytes) << name;
    }
  }
}

struct Interruption {
  const char* name;
  int signal;
  const char* after;  ///< the file that is there when the signal comes
  int status;
};

class Interrupted : public testing::TestWithParam<Interruption> {};

TEST_P(Interrupted, LeavesNoHalfFileAndResumesToTheSameBits) {
  const Workplace here;
  const Interruption& interruption = GetParam();
  const Ending uninterrupted = here.mezzotint(slow_run("whole"));
  const Files whole = here.files("whole");

  RunningProgram program(here.path(), slow_run("run"));
  ASSERT_TRUE(program.wait_for(here / "run" / interruption.after));
  program.send(interruption.signal);
  EXPECT_EQ(program.wait().status, interruption.status);
  const Files left = here.files("run");
  EXPECT_FALSE(left.contains("report.html")) << "it came too late to interrupt anything";
  expect_whole_files(interruption.signal == SIGKILL ? without_temporaries(left) : left, whole);

  const Ending ending = here.mezzotint(resumed(slow_run("run")));
  EXPECT_EQ(ending.status, uninterrupted.status) << ending.err;
  EXPECT_EQ(differences(here.files("run"), whole), "");
}

INSTANTIATE_TEST_SUITE_P(Loop, Interrupted,
                         testing::Values(Interruption{"CtrlCInTheSearch", SIGINT, "target.json", 1},
                                         Interruption{"CtrlCInTheTracing", SIGINT, "bsdf_predicted_0.exr", 1},
                                         Interruption{"TermInTheTracing", SIGTERM, "comparison.json", 1},
                                         Interruption{"KillInTheTracing", SIGKILL, "bsdf_predicted_0.exr", 137}),
                         [](const auto& test) { return test.param.name; });

TEST(Resume, OfAFinishedRunTouchesNothing) {
  const Workplace here;
  using Clock = std::chrono::steady_clock;
  const auto begin = Clock::now();
  ASSERT_EQ(here.mezzotint({"run", "small.toml", "--out", "run"}).status, 0);
  const auto first = Clock::now() - begin;
  std::map<std::filesystem::path, std::filesystem::file_time_type> times;
  for (const auto& entry : std::filesystem::directory_iterator(here / "run")) {
    times[entry.path()] = entry.last_write_time();
  }
  const Files files = here.files("run");
  const auto again = Clock::now();
  EXPECT_EQ(here.mezzotint({"run", "small.toml", "--out", "run", "--resume"}).status, 0);
  EXPECT_LT(Clock::now() - again, first) << "nothing is done twice";
  EXPECT_EQ(here.files("run"), files);
  for (const auto& [path, time] : times) EXPECT_EQ(std::filesystem::last_write_time(path), time) << path;
}

TEST(Resume, RefusesChangedSettings) {
  const Workplace here;
  ASSERT_EQ(here.mezzotint({"design", "small.toml", "--out", "run"}).status, 0);
  const Files before = here.files("run");
  const Ending ending =
      here.mezzotint({"run", "small.toml", "--out", "run", "--resume", "--set", "target.alpha_x=0.28"});
  EXPECT_EQ(ending.status, 2);
  EXPECT_NE(ending.err.find("other settings"), std::string::npos) << ending.err;
  EXPECT_EQ(here.files("run"), before);
}

}  // namespace
}  // namespace mezzotint::test
