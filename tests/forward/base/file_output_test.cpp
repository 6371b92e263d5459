#include "forward/base/file_output.h"

#include <algorithm>
#include <fstream>
#include <iterator>

#include <gtest/gtest.h>

#include "forward/base/error.h"
#include "forward/base/file_input.h"
#include "tests/test_data.h"

namespace mezzotint {
namespace {

std::string text_of(const std::filesystem::path& path) {
  std::ifstream stream(path);
  return {std::istreambuf_iterator<char>(stream), {}};
}

std::ptrdiff_t files_in(const std::filesystem::path& folder) {
  return std::distance(std::filesystem::directory_iterator(folder), {});
}

TEST(FileOutput, WritesWhatItIsGiven) {
  const test::TemporaryFolder folder;
  write_file(folder / "note.txt", "relief");
  write_file(folder / "note.txt", "relief and lobe");
  EXPECT_EQ(text_of(folder / "note.txt"), "relief and lobe");
  EXPECT_EQ(files_in(folder.path()), 1);
}

TEST(FileOutput, KeepsTheOldFileWhenAWriterFails) {
  const test::TemporaryFolder folder;
  write_file(folder / "map.exr", "old");
  const auto failing = [](const std::filesystem::path& temporary) {
    std::ofstream(temporary) << "half";
    throw MethodError("no answer");
  };
  EXPECT_THROW(write_aside(folder / "map.exr", failing), MethodError);
  EXPECT_EQ(text_of(folder / "map.exr"), "old");
  EXPECT_EQ(files_in(folder.path()), 1);
}

TEST(FileOutput, SaysThatADiskIsFull) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "needs /dev/full";
  const test::TemporaryFolder folder;
  const auto full = [](const std::filesystem::path& temporary) {
    std::filesystem::create_symlink("/dev/full", temporary);
    std::FILE* file = std::fopen(temporary.c_str(), "wb");
    ASSERT_NE(file, nullptr);
    std::fputs("data", file);
    if (std::fclose(file) != 0) throw DeviceError("cannot write: no space left");
  };
  EXPECT_THROW(write_aside(folder / "map.exr", full), DeviceError);
  EXPECT_EQ(files_in(folder.path()), 0);
}

TEST(FileOutput, RefusesAFolderThatIsNotThere) {
  EXPECT_THROW(write_file("/nowhere/at/all/file.txt", "x"), DeviceError);
}

TEST(FileInput, RefusesWhatIsNoFile) {
  const test::TemporaryFolder folder;
  EXPECT_THROW((void)read_file(folder / "missing"), FileError);
  EXPECT_THROW((void)read_file(folder.path()), FileError);
  std::ofstream(folder / "empty");
  EXPECT_THROW((void)read_file(folder / "empty"), FileError);
}

}  // namespace
}  // namespace mezzotint
