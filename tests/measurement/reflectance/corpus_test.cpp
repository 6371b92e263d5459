#include <cstdlib>

#include <gtest/gtest.h>

#include "forward/base/file_input.h"
#include "forward/base/file_output.h"
#include "tests/fuzz/reflectance_readers.h"
#include "tests/measurement/reflectance/small_files.h"
#include "tests/test_data.h"

// The seeds of the fuzz targets, and what they found: each is read or refused, as any other file.

namespace mezzotint {
namespace {

namespace fs = std::filesystem;

const fs::path corpus = fs::path(MEZZOTINT_SOURCE_DIR) / "tests" / "measurement" / "reflectance" / "corpus";

// MEZZOTINT_WRITE_CORPUS=1 makes the seeds anew.
void write_seeds() {
  for (const auto& [format, text] : test::small_files()) {
    fs::create_directories(corpus / format);
    write_file(corpus / format / "small.seed", text);
  }
}

TEST(ReflectanceCorpus, EveryFileIsReadOrRefusedAndEverySeedIsRead) {
  if (std::getenv("MEZZOTINT_WRITE_CORPUS") != nullptr) write_seeds();
  for (const auto& [format, reader] : fuzzed::reflectance_readers) {
    std::size_t seeds = 0;
    for (const auto& entry : fs::directory_iterator(corpus / format)) {
      SCOPED_TRACE(entry.path().string());
      const bool seed = entry.path().extension() == ".seed";
      seeds += seed ? 1 : 0;
      try {
        reader(read_file(entry.path()));
      } catch (const FileError& error) {
        EXPECT_FALSE(seed) << error.what();
      }
    }
    EXPECT_GE(seeds, 1U) << format;
  }
}

// Whatever is cut off: read or refused.
TEST(ReflectanceCorpus, EveryBeginningOfAFileIsReadOrRefused) {
  const auto files = test::small_files();
  for (const auto& [format, reader] : fuzzed::reflectance_readers) {
    const std::string& whole = files.at(std::string(format));
    for (std::size_t length = 0; length <= whole.size(); length += whole.size() > 2000 ? 31 : 1) {
      try {
        reader(std::as_bytes(std::span(whole).first(length)));
      } catch (const FileError&) {
      }
    }
  }
}

}  // namespace
}  // namespace mezzotint
