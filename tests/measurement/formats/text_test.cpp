#include <cmath>
#include <ctime>
#include <functional>
#include <map>

#include <fmt/format.h>

#include "forward/base/error.h"
#include "measurement/formats/parsers.h"
#include "measurement/formats/plain_parsers.h"
#include "tests/measurement/formats/instrument_builders.h"
#include "tests/test_data.h"

namespace mezzotint {
namespace {

using test::as_bytes;

Sidecar csv_sidecar() {
  Sidecar sidecar;
  sidecar.width_um = 6.0;
  sidecar.value_um = 1e-3;
  return sidecar;
}

Sidecar xyz_sidecar() {
  Sidecar sidecar;
  sidecar.xy_um = 1e3;
  sidecar.value_um = 1.0;
  return sidecar;
}

SurfaceFile csv(std::string_view text, const Sidecar& sidecar = csv_sidecar()) {
  return parse_csv("test.csv", as_bytes(text), sidecar);
}
SurfaceFile xyz(std::string_view text, const Sidecar& sidecar = xyz_sidecar()) {
  return parse_xyz("test.xyz", as_bytes(text), sidecar);
}

template <class Read>
std::string complaint(const Read& read) {
  try {
    read();
  } catch (const FileError& error) {
    return error.what();
  }
  return "no complaint";
}

// 1, –, 3 over 4, 5, 6 thousand, in units of a nanometre.
void expect_five(const HeightField& field) {
  ASSERT_EQ(field.columns(), 3U);
  ASSERT_EQ(field.rows(), 2U);
  EXPECT_EQ(field.missing_count(), 1U);
  EXPECT_TRUE(std::isnan(field.at(1, 1)));
  EXPECT_NEAR(field.at(0, 1) + field.datum().um(), 1.0, 1e-6);
  EXPECT_NEAR(field.at(2, 0) + field.datum().um(), 6.0, 1e-6);
}

TEST(Csv, ReadsEverySeparatorAndLineEnd) {
  for (const char* text : {"1000,,3000\n4000,5000,6000\n", "1000;NaN;3000\r\n4000;5000;6000",
                           "1000\t\t3000\n4000\t5000\t6000\n", "  1000 nan 3000\n4000  5000 6000 \n",
                           "# nm\n1e3, BAD ,3E+3\r4000,5000,6000\r", "1000,,3000,\n4000,5000,6000,\n"}) {
    SCOPED_TRACE(text);
    expect_five(csv(text).field);
  }
}

TEST(Csv, TheFirstLineIsTheTopUnlessTheSidecarSaysOtherwise) {
  Sidecar sidecar = csv_sidecar();
  EXPECT_GT(csv("2000,2000\n1000,1000", sidecar).field.at(0, 1), 0.0F);
  sidecar.first_row_on_top = false;
  EXPECT_LT(csv("2000,2000\n1000,1000", sidecar).field.at(0, 1), 0.0F);
}

TEST(Csv, NamesTheLine) {
  EXPECT_EQ(complaint([] { csv("1,2\n3"); }), "test.csv: line 2: has 1 numbers; the lines before have 2");
  EXPECT_EQ(complaint([] { csv("1 2\n3 4,5"); }),
            "test.csv: line 2: \"4,5\" is no number; a decimal comma is not read");
  EXPECT_EQ(complaint([] { csv("# nothing\n\n"); }), "test.csv: line 2: holds no numbers");
  EXPECT_EQ(complaint([] { csv("x,y,z\n"); }), "test.csv: line 1: \"x\" is no number");
}

TEST(Xyz, PointsMayComeInAnyOrderAndWhatIsNotListedIsMissing) {
  const HeightField field = xyz("# x y z\n0.004 0.006 6\n0 0.003 1\n0 0.006 4\n0.002 0.006 5\n0.004 0.003 3\n").field;
  ASSERT_EQ(field.columns(), 3U);
  ASSERT_EQ(field.rows(), 2U);
  EXPECT_NEAR(field.grid().pitch_x.um(), 2.0, 1e-9);
  EXPECT_NEAR(field.grid().pitch_y.um(), 3.0, 1e-9);
  EXPECT_EQ(field.missing_count(), 1U);
  EXPECT_TRUE(std::isnan(field.at(1, 0)));  // y grows with the row
  EXPECT_NEAR(field.at(0, 0) + field.datum().um(), 1.0, 1e-6);
  EXPECT_NEAR(field.at(2, 1) + field.datum().um(), 6.0, 1e-6);
}

// A pitch of 1/3, printed with three digits, over 1000 columns.
TEST(Xyz, CoordinatesOfFewDigitsFindTheirPlace) {
  std::string text;
  for (int row = 0; row < 2; ++row) {
    for (int column = 0; column < 1000; ++column) text += fmt::format("{:.3f},{},{}\n", column / 3.0, row, column);
  }
  const HeightField field = xyz(text).field;
  EXPECT_EQ(field.columns(), 1000U);
  EXPECT_EQ(field.missing_count(), 0U);
  EXPECT_NEAR(field.grid().pitch_x.um(), 1e3 / 3.0, 1e-3);
}

TEST(Xyz, WholeColumnsMayBeMissing) {
  const HeightField field = xyz("0 0 1\n1 0 2\n2 0 3\n5 0 4\n0 1 1\n1 1 2\n2 1 3\n5 1 4\n").field;
  EXPECT_EQ(field.columns(), 6U);
  EXPECT_EQ(field.missing_count(), 4U);
}

TEST(Xyz, RefusesWhatIsNoGrid) {
  EXPECT_NE(complaint([] { xyz("0 0 1\n1 0 2\n2.5 1 3\n7.1 1 3\n"); }).find("not evenly spaced"), std::string::npos);
  EXPECT_NE(complaint([] { xyz("0 0 1\n0 1 2\n"); }).find("the same for all points"), std::string::npos);
  EXPECT_NE(complaint([] { xyz("0 0 1\n1 1 2\n0 0 1\n"); }).find("two points at (0, 0)"), std::string::npos);
  EXPECT_NE(complaint([] { xyz("0 0 1 4\n"); }).find("more than three numbers"), std::string::npos);
  EXPECT_NE(complaint([] { xyz("0 nan 1\n"); }).find("a point without a place"), std::string::npos);
  std::string diagonal;
  for (int i = 0; i < 1000; ++i) diagonal += fmt::format("{} {} 0\n", i, i);
  EXPECT_NE(complaint([&] { xyz(diagonal); }).find("filled to a sixteenth"), std::string::npos);
}

double seconds_of(const std::function<void()>& work) {
  const auto now = [] {
    timespec time{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
    return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
  };
  const double start = now();
  work();
  return now() - start;
}

std::string rows_of_numbers(int columns, int rows, const char* separator) {
  std::string text;
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      text += fmt::format("{}{:.6f}", column == 0 ? "" : separator, 1e-3 * ((column * 7919 + row * 104729) % 10007));
    }
    text += '\n';
  }
  return text;
}

// Quadratic parsing takes 16 times as long for 4 times the text; what is linear 4 times. 8 lies between, for the
// caches and the neighbours.
void expect_linear(const char* name, const std::function<void(int rows)>& read) {
  read(50);
  const double small = seconds_of([&] { read(100); }), large = seconds_of([&] { read(400); });
  testing::Test::RecordProperty(std::string(name) + ".seconds", std::to_string(large));
  EXPECT_LT(large, 8.0 * small + 0.01) << name;
}

TEST(TextSpeed, TimeGrowsWithTheTextAndNotWithItsSquare) {
  std::map<int, std::string> rows;
  for (const int count : {50, 100, 400}) rows[count] = rows_of_numbers(500, count, " ");
  expect_linear("csv", [&](int count) { csv(rows[count]); });
  expect_linear("sdf", [&](int count) {
    static_cast<void>(parse_sdf("test.sdf", as_bytes(test::build_text_sdf("aISO-1.0", 500, count, 7, rows[count]))));
  });
  std::map<int, std::string> points;
  for (const int count : {50, 100, 400}) {
    for (int i = 0; i < 500 * count; ++i) points[count] += fmt::format("{} {} {}\n", i % 500, i / 500, i % 101);
  }
  expect_linear("xyz", [&](int count) { xyz(points[count]); });
}

}  // namespace
}  // namespace mezzotint
