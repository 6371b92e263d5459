#include <csignal>
#include <thread>

#include <gtest/gtest.h>

#include "fabrication/part/part_file.h"
#include "tests/fabrication/slicing/shapes.h"
#include "tests/loop/workplace.h"

namespace mezzotint {
namespace {

using namespace test;

struct PartPlace : Workplace {
  PartPlace() { write_stl(gear(0.0, 0.0, 1.2, 1.5, 12), "gear.stl"); }
  void write_stl(const Outline& outline, const char* name) const {
    mezzotint::write_stl(prism(outline, 0.0, 0.5), *this / name);
  }
  [[nodiscard]] nlohmann::json json(const std::string& line) const {
    const Ending ending = mezzotint(words(line + " --json"));
    EXPECT_EQ(ending.status, 0) << ending.err;
    return nlohmann::json::parse(ending.out);
  }
};

TEST(Slice, MakesAJobOfEveryFormatThatChecks) {
  const PartPlace here;
  for (const char* name : {"gear.sl1", "gear.uvj", "gear/"}) {
    const auto sliced = here.json(std::string("slice gear.stl --printer printer.toml -o ") + name);
    EXPECT_EQ(sliced["layers"], 28);
    EXPECT_NEAR(sliced["volume"]["value"], area(gear(0.0, 0.0, 1.2, 1.5, 12)) * 0.5, 2e-5);
    EXPECT_EQ(sliced["open_rows"], 0);
    ASSERT_EQ(sliced["warnings"].size(), 1U);  // a full layer of the slides' printer saturates
    const auto checked = here.json(std::string("job ") + name);
    EXPECT_EQ(checked["layers"], 28);
    EXPECT_EQ(checked["columns"], 2560);
    EXPECT_EQ(checked["lit_pixels"], sliced["lit_pixels"]);
    EXPECT_EQ(checked["hashes"], "SHA-256 of every member verified");
  }
}

TEST(Slice, GivesTheSameBytesWithOneThreadAndTwo) {
  const PartPlace here;
  ASSERT_EQ(here.mezzotint(words("slice gear.stl -o one.sl1 --threads 1")).status, 0);
  ASSERT_EQ(here.mezzotint(words("slice gear.stl -o two.sl1 --threads 2")).status, 0);
  EXPECT_TRUE(here.read("one.sl1") == here.read("two.sl1"));
}

TEST(Slice, RefusesWhatCannotBe) {
  const PartPlace here;
  here.write_stl(disc(0.0, 0.0, 20.0, 60), "large.stl");
  here.write("text.stl", "no mesh");
  const Files before = here.files();
  const auto refuses = [&](const std::string& line, std::string_view why) {
    const Ending ending = here.mezzotint(words(line));
    EXPECT_EQ(ending.status, 2) << line;
    EXPECT_NE(ending.err.find(why), std::string::npos) << ending.err;
  };
  refuses("slice large.stl -o job.sl1", "40 x 40 mm");
  refuses("slice gear.stl -o job.sl1 --offset-mm 9,0", "Turn it, move it or make it smaller");
  refuses("slice gear.stl -o job.zip", "a job is a .uvj, a .sl1 or a folder");
  refuses("slice text.stl -o job.sl1", "text.stl");
  refuses("slice absent.stl -o job.sl1", "absent.stl");
  refuses("job gear.stl", "a job is a .uvj, a .sl1 or a folder");
  EXPECT_TRUE(here.files() == before);
}

TEST(Slice, LeavesNothingAfterCtrlCOrOnAFullDisk) {
  const PartPlace here;
  const Files before = here.files();
  for (const char* name : {"job.sl1", "job.uvj", "job/"}) {
    // Fifty thousand layers: it is at work when the signal comes.
    RunningProgram program(here.path(),
                           {"slice", "gear.stl", "-o", name, "--layer-mm", "0.0001", "--offset-mm", "1,1"});
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
    program.send(SIGINT);
    const Ending ending = program.wait();
    EXPECT_EQ(ending.status, 1) << ending.err;
    EXPECT_NE(ending.err.find("interrupted"), std::string::npos) << ending.err;
    EXPECT_TRUE(here.files() == before) << name;
    const Ending full = here.mezzotint({"slice", "gear.stl", "-o", name}, {.largest_file_bytes = 4000});
    EXPECT_EQ(full.status, 1) << full.err;
    EXPECT_TRUE(here.files() == before) << name;
  }
}

}  // namespace
}  // namespace mezzotint
