#include <cstdlib>

#include "forward/base/error.h"
#include "forward/base/file_input.h"
#include "forward/base/file_output.h"
#include "tests/measurement/formats/victims.h"
#include "tests/test_data.h"

// The seeds of the fuzz targets, and what they found: each is read or refused, as any other file.

namespace mezzotint {
namespace {

namespace fs = std::filesystem;

const fs::path corpus = fs::path(MEZZOTINT_SOURCE_DIR) / "tests" / "measurement" / "formats" / "corpus";

std::string file_name(std::string name) {
  for (char& c : name) {
    if (c == ' ' || c == ',') c = '_';
  }
  return name + ".seed";
}

// MEZZOTINT_WRITE_CORPUS=1 makes the seeds anew from the victims.
void write_seeds() {
  for (const test::Victim& victim : test::victims()) {
    fs::create_directories(corpus / victim.format);
    write_file(corpus / victim.format / file_name(victim.name), victim.bytes);
  }
}

TEST(Corpus, EveryFileIsReadOrRefusedAndEverySeedIsRead) {
  if (std::getenv("MEZZOTINT_WRITE_CORPUS") != nullptr) write_seeds();
  for (const auto& [format, reader] : fuzzed::readers) {
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

TEST(Corpus, IsSmall) {
  std::uintmax_t bytes = 0;
  for (const auto& entry : fs::recursive_directory_iterator(corpus)) {
    if (entry.is_regular_file()) bytes += entry.file_size();
  }
  EXPECT_LT(bytes, 200U * 1024U);
}

}  // namespace
}  // namespace mezzotint
