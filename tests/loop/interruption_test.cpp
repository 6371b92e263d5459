#include <csignal>

#include <gtest/gtest.h>

#include "tests/loop/workplace.h"

namespace mezzotint::test {
namespace {

// Long enough to be stopped in the middle: the search and the tracing take half a second and more each.
std::vector<std::string> slow_run(const std::string& folder) {
  return {"run",   "small.toml",
          "--out", folder,
          "--set", "search.draws=48",
          "--set", "search.relative_tolerance=1e-12",
          "--set", "search.max_evaluations=100",
          "--set", "simulation.tolerance=1e-4",
          "--set", "simulation.samples=6000000"};
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
  int signal;
  const char* after;  ///< the file that is there when the signal comes
  int status;
};

// Ctrl-C in the search, a request to end and a power cut in the tracing, one after the other.
TEST(Resume, AfterEveryInterruptionEndsInTheSameBits) {
  const Workplace here;
  const Ending uninterrupted = here.mezzotint(slow_run("whole"));
  const Files whole = here.files("whole");
  for (const auto& [signal, after, status] :
       {Interruption{SIGINT, "target.json", 1}, Interruption{SIGTERM, "comparison.json", 1},
        Interruption{SIGKILL, "bsdf_printed_0.exr", 128 + SIGKILL}}) {
    RunningProgram program(here.path(), resumed(slow_run("run")));
    ASSERT_TRUE(program.wait_for(here / "run" / after)) << after;
    program.send(signal);
    EXPECT_EQ(program.wait().status, status) << after;
    const Files left = here.files("run");
    EXPECT_FALSE(left.contains("report.html")) << "it came too late to interrupt anything";
    expect_whole_files(signal == SIGKILL ? without_temporaries(left) : left, whole);
  }
  const Ending ending = here.mezzotint(resumed(slow_run("run")));
  EXPECT_EQ(ending.status, uninterrupted.status) << ending.err;
  EXPECT_EQ(differences(here.files("run"), whole), "");
  EXPECT_EQ(here.read_json("run/timing.json").size(), here.read_json("whole/timing.json").size())
      << "the seconds of all stages are kept";
}

TEST(Run, KeepsOutOfAFolderInWhichAnotherIsAtWork) {
  const Workplace here;
  // Its search goes on for as long as the test, which ends it.
  RunningProgram first(here.path(), {"run", "small.toml", "--out", "run", "--set", "search.draws=256", "--set",
                                     "search.relative_tolerance=1e-12", "--set", "search.algorithm=GN_CRS2_LM", "--set",
                                     "search.max_evaluations=1000000"});
  ASSERT_TRUE(first.wait_for(here / "run" / "target.json"));
  for (const char* line : {"run small.toml --out run", "run small.toml --out run --resume"}) {
    const Ending second = here.mezzotint(words(line));
    EXPECT_EQ(second.status, 1);
    EXPECT_NE(second.err.find("another run is at work"), std::string::npos) << second.err;
  }
  EXPECT_FALSE(std::filesystem::exists(here / "run.previous"));
}

TEST(Resume, OfAFinishedRunTouchesNothing) {
  const Workplace here;
  ASSERT_EQ(here.mezzotint({"run", "small.toml", "--out", "run"}).status, 0);
  std::map<std::filesystem::path, std::filesystem::file_time_type> times;
  for (const auto& entry : std::filesystem::directory_iterator(here / "run")) {
    times[entry.path()] = entry.last_write_time();
  }
  const Files files = here.files("run");
  const Ending again = here.mezzotint({"run", "small.toml", "--out", "run", "--resume"});
  EXPECT_EQ(again.status, 0);
  // Nothing is done twice: by what each stage says, not by a clock, which a busy machine turns round.
  for (const std::string stage : {"target", "gamut", "search", "print", "measure", "compare", "scatter", "report"}) {
    EXPECT_NE(again.err.find(stage + ": 100 %, took 0 s: finished before"), std::string::npos) << again.err;
    EXPECT_EQ(again.err.find(stage + ": 0 %"), std::string::npos) << again.err;
  }
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

// A budget stands in for the signal: what the short run kept is all that the long one finds.
TEST(ResumedTable, HasTheBitsOfOneThatNeverStopped) {
  const Workplace here;
  ASSERT_EQ(here.mezzotint(words("synthesize pattern.toml -o relief.gwy -q")).status, 0);
  const std::string table = "bsdf-table relief.gwy --symmetry isotropic --tolerance 0.02 --resolution 16 --json -q ";
  const auto computed = [&](const std::string& rest) {
    const Ending ending = here.mezzotint(words(table + rest));
    EXPECT_EQ(ending.status, 3) << ending.err;
    return nlohmann::json::parse(ending.out).at("computed").get<int>();
  };
  EXPECT_EQ(computed("--most 8 -o whole.exr"), 8);
  EXPECT_EQ(computed("--most 5 --resume -o parts.exr"), 5);
  EXPECT_EQ(computed("--most 8 --resume -o parts.exr"), 3);
  EXPECT_EQ(computed("--most 8 --resume -o parts.exr"), 0);
  EXPECT_EQ(computed("--most 8 --resume --material mirror -o parts.exr"), 8);
  EXPECT_EQ(computed("--most 8 --resume -o parts.exr"), 0);
  EXPECT_EQ(here.read("parts.exr"), here.read("whole.exr"));
}

}  // namespace
}  // namespace mezzotint::test
