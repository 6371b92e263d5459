#include "experiments/run/run_folder.h"

#include <fstream>

#include <gtest/gtest.h>

#include "forward/base/error.h"
#include "forward/base/file_output.h"
#include "tests/test_data.h"

namespace mezzotint {
namespace {

TEST(RunFolder, RemembersFinishedStagesForAResume) {
  const test::TemporaryFolder folder;
  {
    RunFolder run(folder / "run", "digest", false);
    write_file(run / "design.json", "{}");
    run.finish("search", {"design.json"});
  }
  const RunFolder resumed(folder / "run", "digest", true);
  EXPECT_TRUE(resumed.is_finished("search"));
  EXPECT_FALSE(resumed.is_finished("print"));
}

TEST(RunFolder, DoesAStageAgainWhenItsFilesWereTouched) {
  const test::TemporaryFolder folder;
  RunFolder run(folder / "run", "digest", false);
  write_file(run / "design.json", "{}");
  run.finish("search", {"design.json"});
  write_file(run / "design.json", "{ }");
  EXPECT_FALSE(run.is_finished("search"));
  std::filesystem::remove(run / "design.json");
  EXPECT_FALSE(run.is_finished("search"));
}

TEST(RunFolder, KeepsTheEarlierRunWhenANewOneBegins) {
  const test::TemporaryFolder folder;
  { RunFolder first(folder / "run", "one", false); }
  { RunFolder second(folder / "run", "two", false); }
  EXPECT_TRUE(std::filesystem::exists(folder / "run.previous" / "run.json"));
}

TEST(RunFolder, RefusesToResumeAnotherExperiment) {
  const test::TemporaryFolder folder;
  { RunFolder first(folder / "run", "one", false); }
  EXPECT_THROW(RunFolder(folder / "run", "two", true), InvalidInput);
}

TEST(RunFolder, NeverTouchesAFolderThatIsNoRun) {
  const test::TemporaryFolder folder;
  std::filesystem::create_directories(folder / "thesis");
  write_file(folder / "thesis" / "chapter.tex", "years of work");
  EXPECT_THROW(RunFolder(folder / "thesis", "digest", false), InvalidInput);
  EXPECT_TRUE(std::filesystem::exists(folder / "thesis" / "chapter.tex"));
}

TEST(RunFolder, RemovesWhatAKilledRunLeftHalfWritten) {
  const test::TemporaryFolder folder;
  { RunFolder first(folder / "run", "digest", false); }
  std::ofstream(folder / "run" / ".job.part4711.uvj") << "half";
  const RunFolder resumed(folder / "run", "digest", true);
  EXPECT_FALSE(std::filesystem::exists(folder / "run" / ".job.part4711.uvj"));
}

TEST(RunFolder, SaysWhenItsRecordIsDamaged) {
  const test::TemporaryFolder folder;
  { RunFolder first(folder / "run", "digest", false); }
  std::ofstream(folder / "run" / "run.json") << "{\"experiment\": 3";
  EXPECT_THROW(RunFolder(folder / "run", "digest", true), FileError);
}

}  // namespace
}  // namespace mezzotint
