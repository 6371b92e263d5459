#include <cmath>
#include <limits>

#include "forward/base/error.h"
#include "measurement/formats/parsers.h"
#include "tests/measurement/formats/instrument_builders.h"
#include "tests/test_data.h"

namespace mezzotint {
namespace {

using test::as_bytes;
using test::build_sdf_header;
using test::build_text_sdf;

SurfaceFile parse(const std::string& bytes) { return parse_sdf("test.sdf", as_bytes(bytes)); }

std::string complaint(const std::string& bytes) {
  try {
    parse(bytes);
  } catch (const FileError& error) {
    return error.what();
  }
  return "no complaint";
}

// Six numbers of which the second is missing: 10, –, 30, 40, 50, 60 nm.
void expect_second_missing(const HeightField& field, bool first_row_on_top) {
  ASSERT_EQ(field.grid().size(), 6U);
  EXPECT_EQ(field.missing_count(), 1U);
  for (std::size_t i = 0; i < 6; ++i) {
    const float z = field.at(i % 3, first_row_on_top ? 1 - i / 3 : i / 3);
    if (i == 1) {
      EXPECT_TRUE(std::isnan(z));
    } else {
      EXPECT_NEAR(z + field.datum().um(), 0.01 * static_cast<double>(i + 1), 1e-8) << i;  // floats about their mean
    }
  }
}

template <class Number>
std::string six(Number marker) {
  std::string data;
  for (const int value : {10, 0, 30, 40, 50, 60}) test::append(data, value == 0 ? marker : static_cast<Number>(value));
  return data;
}

template <class Number>
void expect_type(std::uint8_t type, Number iso_marker, Number bcr_marker) {
  SCOPED_TRACE(testing::Message() << "type " << int{type});
  if (std::numeric_limits<Number>::is_signed) {
    for (const char* version : {"bISO-1.0", "bISO-2.0"}) {
      expect_second_missing(parse(build_sdf_header({version, 3, 2, type}) + six(iso_marker)).field, false);
    }
  }
  const SurfaceFile surface = parse(build_sdf_header({"bBCR-1.0", 3, 2, type}) + six(bcr_marker));
  expect_second_missing(surface.field, true);
  EXPECT_NE(surface.assumption.find("BCR-1.0"), std::string::npos);
}

TEST(Sdf, ReadsEveryBinaryTypeWithTheMarkerOfItsVersion) {
  expect_type<std::uint8_t>(0, 0, 255);
  expect_type<std::uint16_t>(1, 0, 65535);
  expect_type<std::uint32_t>(2, 0, 4294967295U);
  expect_type<float>(3, -std::numeric_limits<float>::max(), 3.402823466e38F);
  expect_type<std::int8_t>(4, -128, 127);
  expect_type<std::int16_t>(5, -32768, 32767);
  expect_type<std::int32_t>(6, std::numeric_limits<std::int32_t>::min(), std::numeric_limits<std::int32_t>::max());
  expect_type<double>(7, -std::numeric_limits<double>::max(), 1.7976e308);
}

TEST(Sdf, ReadsTextOverAnyLinesAndBadAsMissing) {
  expect_second_missing(parse(build_text_sdf("aISO-1.0", 3, 2, 7, "10 BAD 30\r\n40 50 60")).field, false);
  expect_second_missing(parse(build_text_sdf("aISO-2.0", 3, 2, 5, "10\nBAD\n30\t40\n\n 50 60")).field, false);
  expect_second_missing(parse(build_text_sdf("aISO-1.0", 3, 2, 7, "1E+1 NaN 3.0e1 40 +50 60")).field, false);
  expect_second_missing(parse(build_text_sdf("aBCR-1.0", 3, 2, 5, "10 32767 30 40 50 60")).field, true);
}

TEST(Sdf, TakesScalesAndProvenance) {
  const SurfaceFile surface = parse(build_text_sdf("aISO-1.0", 3, 2, 7, "1 2 3 4 5 6"));
  EXPECT_NEAR(surface.field.grid().pitch_x.um(), 2.0, 1e-12);
  EXPECT_NEAR(surface.field.grid().pitch_y.um(), 4.0, 1e-12);
  EXPECT_EQ(surface.provenance.at("manufacturer"), "maker");
  EXPECT_EQ(surface.provenance.at("created"), "311220192359");
  EXPECT_EQ(surface.assumption, "");
}

TEST(Sdf, NamesTheLineAndWhatWouldBeRight) {
  EXPECT_EQ(complaint(build_text_sdf("aISO-1.0", 3, 2, 7, "1 2 3\r\n4 five 6")),
            "test.sdf: line 16: \"five\" is no number");
  EXPECT_EQ(complaint(build_text_sdf("aISO-1.0", 3, 2, 7, "1 2 3\r\n4 1,5 6")),
            "test.sdf: line 16: \"1,5\" is no number; a decimal comma is not read");
  EXPECT_NE(complaint(build_text_sdf("aISO-1.0", 3, 2, 7, "1 2 3 4 5")).find("the data end after 5 numbers"),
            std::string::npos);
  EXPECT_NE(complaint(build_text_sdf("aISO-1.0", 3, 2, 7, "1 2 3 4 5 6 7")).find("do not end in a *"),
            std::string::npos);
  EXPECT_NE(complaint(build_text_sdf("aISO-3.0", 3, 2, 7, "1")).find("\"ISO-3.0\"; ISO-1.0"), std::string::npos);
}

TEST(Sdf, RefusesWhatItCannotRead) {
  const std::string data = six<std::int32_t>(1);
  EXPECT_NE(complaint(build_sdf_header({"bISO-1.0", 3, 2, 6, 1e-9, 1}) + data).find("compression 1"),
            std::string::npos);
  EXPECT_NE(complaint(build_sdf_header({"bISO-1.0", 3, 2, 6, 1e-9, 0, 1}) + data).find("checksum"), std::string::npos);
  EXPECT_NE(complaint(build_sdf_header({"bISO-1.0", 3, 2, 9}) + data).find("type 9"), std::string::npos);
  EXPECT_NE(complaint(build_sdf_header({"bISO-1.0", 3, 2, 6, 0.0}) + data).find("Zscale is 0"), std::string::npos);
  EXPECT_NE(complaint(build_sdf_header({"bISO-1.0", 3, 3, 6}) + data).find("needs 36 bytes"), std::string::npos);
  EXPECT_NE(complaint(build_sdf_header({"bISO-2.0", 30000, 30000, 6}) + data), "no complaint");
  EXPECT_NE(complaint(build_text_sdf("aISO-1.0", 30000, 30000, 7, "1 2")).find("30000 × 30000"), std::string::npos);
}

}  // namespace
}  // namespace mezzotint
