#include "fabrication/session/journal.h"

#include <fstream>
#include <iterator>

#include <gtest/gtest.h>

#include "forward/base/error.h"
#include "tests/test_data.h"

namespace mezzotint {
namespace {

std::string text_of(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

void write_text(const std::filesystem::path& path, const std::string& text) {
  std::ofstream(path, std::ios::binary) << text;
}

// Layer 0 done, layer 1 cut at a known time, then uncertain.
std::string sample(const std::filesystem::path& path) {
  Journal journal = Journal::begin(path, "job", "plan", 5);
  journal.exposing(0, 3.0);
  journal.done(0, 3.001);
  journal.exposing(1, 3.0);
  journal.cut(1, 0.99, 1.01, true);
  journal.exposing(1, 2.0);
  return text_of(path);
}

TEST(Journal, TellsAfterwardsWhatItWasTold) {
  const test::TemporaryFolder folder;
  sample(folder / "journal");
  const JournalState state = read_journal(folder / "journal");
  EXPECT_EQ(state.layers, 5U);
  EXPECT_EQ(state.done, 1U);
  ASSERT_EQ(state.lit_s.size(), 1U);
  EXPECT_DOUBLE_EQ(state.lit_s[0], 3.001);
  ASSERT_TRUE(state.open);
  EXPECT_EQ(state.open->index, 1U);
  EXPECT_FALSE(state.open->certain) << "an exposure that was begun and not ended is uncertain";
  EXPECT_DOUBLE_EQ(state.open->least_s, 0.99);
  EXPECT_DOUBLE_EQ(state.open->most_s, 3.01);
}

TEST(Journal, TornAtAnyByteIsThatOfAnEarlierMoment) {
  const test::TemporaryFolder folder;
  const std::string whole = sample(folder / "journal");
  std::size_t before = 0;
  for (std::size_t bytes = whole.find('\n') + 1; bytes <= whole.size(); ++bytes) {
    write_text(folder / "torn", whole.substr(0, bytes));
    Journal resumed = Journal::resume(folder / "torn", "job", "plan");
    const JournalState& state = resumed.state();
    const std::size_t rank = state.done * 10 + (state.open ? 1 + (state.open->most_s < 3.0) : 0);
    EXPECT_LE(state.done, 1U);
    EXPECT_GE(rank + 1, before > 0 ? 1U : 0U);
    before = rank;
    // What is appended after a torn line can be read.
    const std::size_t layer = state.done;
    resumed.exposing(layer, 1.0);
    resumed.done(layer, 1.0);
    EXPECT_EQ(read_journal(folder / "torn").done, layer + 1) << "torn at byte " << bytes;
  }
}

TEST(Journal, RefusesDamageBeforeItsLastLine) {
  const test::TemporaryFolder folder;
  const std::string whole = sample(folder / "journal");
  const std::size_t last_line = whole.rfind('\n', whole.size() - 2) + 1;
  for (std::size_t byte = 0; byte < last_line; ++byte) {
    std::string damaged = whole;
    damaged[byte] = damaged[byte] == 'x' ? 'y' : 'x';
    write_text(folder / "damaged", damaged);
    EXPECT_THROW(read_journal(folder / "damaged"), FileError) << "byte " << byte;
  }
}

TEST(Journal, IsNotMixedWithAnotherPrint) {
  const test::TemporaryFolder folder;
  sample(folder / "journal");
  EXPECT_THROW(Journal::resume(folder / "journal", "other job", "plan"), InvalidInput);
  EXPECT_THROW(Journal::resume(folder / "journal", "job", "other plan"), InvalidInput);
  EXPECT_THROW(Journal::begin(folder / "journal", "job", "plan", 5), InvalidInput) << "unfinished: --resume or delete";
  EXPECT_THROW(Journal::resume(folder / "none", "job", "plan"), InvalidInput);
  const Journal held = Journal::resume(folder / "journal", "job", "plan");
  EXPECT_THROW(Journal::resume(folder / "journal", "job", "plan"), DeviceError) << "two prints with one journal";
}

TEST(Journal, KeepsTheUsersWord) {
  const test::TemporaryFolder folder;
  for (const std::string word : {"repeat", "skip", "complete"}) {
    std::filesystem::remove(folder / "journal");
    sample(folder / "journal");
    {
      Journal journal = Journal::resume(folder / "journal", "job", "plan");
      journal.decide(1, word);
    }
    const JournalState state = read_journal(folder / "journal");
    EXPECT_EQ(state.decided, std::vector<std::size_t>{1});
    EXPECT_EQ(state.done, word == "skip" ? 2U : 1U);
    if (word == "complete") {
      EXPECT_DOUBLE_EQ(state.open->taken_s, 0.99);
      EXPECT_DOUBLE_EQ(state.open->most_s, 3.01) << "what it may have got is not forgotten";
      EXPECT_TRUE(state.open->certain);
    }
    if (word == "repeat") {
      EXPECT_FALSE(state.open);
    }
  }
}

}  // namespace
}  // namespace mezzotint
