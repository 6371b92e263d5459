#include <gtest/gtest.h>

#include "fabrication/projector/dlpc900_commands.h"
#include "forward/base/error.h"

namespace mezzotint::dlpc900 {
namespace {

using Bytes = std::vector<std::uint8_t>;

TEST(Frame, AsksAsInTheGuidesExample) {
  const auto reports = encode_message({.read = true, .sequence = 0x11, .command = 0x1100});
  ASSERT_EQ(reports.size(), 1U);
  EXPECT_EQ(Bytes(reports[0].begin(), reports[0].begin() + 6), (Bytes{0xc0, 0x11, 0x02, 0x00, 0x00, 0x11}));
  for (std::size_t i = 6; i < report_bytes; ++i) EXPECT_EQ(reports[0][i], 0);
}

TEST(Frame, ReadsTheAnswerOfTheGuidesExample) {
  Bytes report = {0xc0, 0x11, 0x06, 0x00, 0xff, 0x01, 0xff, 0x01, 0xff, 0x01};
  report.resize(report_bytes, 0);
  const auto header = parse_reply_header(report);
  ASSERT_TRUE(header);
  EXPECT_FALSE(header->error);
  EXPECT_EQ(header->sequence, 0x11);
  EXPECT_EQ(header->data_bytes, 6U);
  EXPECT_EQ(number_at(report, header_bytes, 2), 0x1ffU);
  report[0] = 0xe0;
  EXPECT_TRUE(parse_reply_header(report)->error);
  EXPECT_FALSE(parse_reply_header(Bytes(3)));
}

TEST(Frame, WritesWithAndWithoutAnAcknowledgement) {
  EXPECT_EQ(encode_message({.command = 0x1a1b, .data = {3}})[0][0], 0x40);
  EXPECT_EQ(encode_message({.wants_reply = false, .command = 0x1a1b, .data = {3}})[0][0], 0x00);
}

TEST(Frame, SplitsALongMessageWithOneHeader) {
  Bytes data(largest_data_bytes);
  for (std::size_t i = 0; i < data.size(); ++i) data[i] = static_cast<std::uint8_t>(i);
  const auto reports = encode_message({.sequence = 9, .command = 0x1a2b, .data = data});
  ASSERT_EQ(reports.size(), largest_message_bytes / report_bytes);
  EXPECT_EQ(number_at(reports[0], 2, 2), 2 + largest_data_bytes);
  EXPECT_EQ(reports[0][6], data[0]);
  EXPECT_EQ(reports[1][0], data[58]) << "no header in the second";
  EXPECT_EQ(reports[7][63], data.back());
  data.push_back(0);
  EXPECT_THROW(static_cast<void>(encode_message({.data = data})), InvalidInput);
}

TEST(Commands, PatternEntryOfAnEightBitLayer) {
  // 3 s, 8 bits (7 << 1), all LEDs (7 << 4), image 2, bit position 8.
  EXPECT_EQ(encode_pattern_entry({5, 3'000'000, 7, 2, 8}),
            (Bytes{5, 0, 0xc0, 0xc6, 0x2d, 0x7e, 0, 0, 0, 0, 0x02, 0x40}));
}

TEST(Commands, FirmwareDecidesWhatThePatternTableCounts) {
  EXPECT_EQ(encode_pattern_table(3, 2, {5, 0, 0}), (Bytes{3, 0, 2, 0, 0, 0})) << "rounds";
  EXPECT_EQ(encode_pattern_table(3, 2, {6, 0, 0}), (Bytes{3, 0, 6, 0, 0, 0})) << "patterns";
  EXPECT_EQ(encode_pattern_table(1, 4, {5, 0, 0}), encode_pattern_table(1, 4, {6, 0, 0}));
  EXPECT_EQ(encode_pattern_table(4, 0, {5, 0, 0}), encode_pattern_table(4, 0, {6, 0, 0})) << "for ever";
}

TEST(Commands, ExposuresAreSplitWhereTheTableHasNoRoom) {
  EXPECT_EQ(plan_exposure(3'000'000).rounds, 1U);
  EXPECT_EQ(plan_exposure(3'000'000).entry_us, 3'000'000U);
  EXPECT_EQ(plan_exposure(longest_entry_us).rounds, 1U);
  const auto split = plan_exposure(40'000'000);
  EXPECT_EQ(split.rounds, 3U);
  EXPECT_NEAR(1.0 * split.entry_us * split.rounds, 40e6, split.rounds);
  EXPECT_THROW(static_cast<void>(plan_exposure(shortest_8bit_us - 1)), InvalidInput);
}

TEST(Commands, StatusBytes) {
  const auto status = hardware_status(0xd1);
  EXPECT_TRUE(status.initialised && status.has_secondary && status.sequence_aborted && status.sequence_failed);
  EXPECT_FALSE(status.incompatible);
  EXPECT_TRUE(main_status(0x0a).sequence_runs && main_status(0x0a).source_is_locked);
  const auto version = firmware_version(0x05010002);
  EXPECT_EQ(version.major, 5U);
  EXPECT_EQ(version.minor, 1U);
  EXPECT_EQ(version.patch, 2U);
  EXPECT_EQ(error_code_text(9), "bad compression of the image");
  EXPECT_EQ(error_code_text(77), "unknown error");
}

}  // namespace
}  // namespace mezzotint::dlpc900
