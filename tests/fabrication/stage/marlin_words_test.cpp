#include "fabrication/stage/marlin_words.h"

#include <gtest/gtest.h>

namespace mezzotint {
namespace {

using Kind = MarlinReply::Kind;

// Marlin's own documentation of the checksum has "N123 [...G Code in here...]*71"; this one is RepRap's G-code page's.
TEST(MarlinWords, NumberAndChecksumOfALine) {
  EXPECT_EQ(numbered_line(3, "T0"), "N3 T0*57\n");
  EXPECT_EQ(numbered_line(4, "G92 E0"), "N4 G92 E0*67\n");
  EXPECT_EQ(numbered_line(5, "G28"), "N5 G28*22\n");
}

TEST(MarlinWords, MicrometresAreWrittenAndReadExactly) {
  EXPECT_EQ(millimetres(0), "0.000");
  EXPECT_EQ(millimetres(18), "0.018");
  EXPECT_EQ(millimetres(-5), "-0.005");
  for (std::int64_t um = -3000; um < 300000; um += 7) EXPECT_EQ(parse_micrometres(millimetres(um)), um);
  for (const char* text : {"", "x", "nan", "inf", "99999999"}) EXPECT_FALSE(parse_micrometres(text)) << text;
}

TEST(MarlinWords, WhatTheBoardSays) {
  const std::pair<const char*, Kind> lines[] = {
      {"ok", Kind::Acknowledged},
      {"ok P15 B3", Kind::Acknowledged},
      {"okay", Kind::Remark},
      {"echo:busy: processing", Kind::Busy},
      {"start", Kind::Restarted},
      {"echo:start", Kind::Remark},
      {"Error:checksum mismatch, Last Line: 3", Kind::LineDamaged},
      {"Error:Line Number is not Last Line Number+1, Last Line: 3", Kind::LineDamaged},
      {"Error:Printer halted. kill() called!", Kind::Refused},
      {"Error:Homing Failed", Kind::HomingFailed},
      {"echo:Unknown command: \"G999\"", Kind::Refused},
      {"Resend: x", Kind::LineDamaged},
      {"FIRMWARE_NAME:Marlin", Kind::Remark},
      {"", Kind::Remark}};
  for (const auto& [line, kind] : lines) EXPECT_EQ(parse_marlin_reply(line).kind, kind) << line;
  EXPECT_EQ(parse_marlin_reply("Resend: 17").number, 17);
  EXPECT_EQ(parse_marlin_reply("rs N17").number, 17);
  EXPECT_EQ(parse_marlin_reply("X:0.00 Y:0.00 Z:12.02 E:0.00 Count X:0 Y:0 Z:4807").height_um, 12020);
  EXPECT_EQ(parse_marlin_reply("Count X:0 Y:0 Z:4807").kind, Kind::Remark) << "steps are no height";
}

}  // namespace
}  // namespace mezzotint
