#include "fabrication/calibration/cure_table.h"

#include <cmath>
#include <fstream>

#include <gtest/gtest.h>

#include "forward/base/error.h"
#include "tests/test_data.h"

namespace mezzotint {
namespace {

class CureTable : public testing::Test {
protected:
  std::vector<CurePoint> read(const std::string& text) const {
    std::ofstream(folder_ / "steps.csv") << text;
    return read_cure_table(folder_ / "steps.csv", {3.0});
  }
  std::string complaint(const std::string& text) const {
    try {
      (void)read(text);
    } catch (const FileError& error) {
      return error.what();
    }
    return "";
  }

private:
  test::TemporaryFolder folder_;
};

TEST_F(CureTable, ReadsLevelsHeightsAndErrors) {
  const auto points =
      read("# a wedge\ngray,height_um,standard_error_um\n0,0.02,0.05\n128,10.9,0.1\n255,17.8,0.1 # top\n");
  ASSERT_EQ(points.size(), 3U);
  EXPECT_DOUBLE_EQ(points[1].gray, 128.0 / 255.0);
  EXPECT_DOUBLE_EQ(points[1].height_um, 10.9);
  EXPECT_DOUBLE_EQ(*points[1].standard_error_um, 0.1);
  EXPECT_EQ(points[1].exposure, 1.0);
  EXPECT_EQ(points[1].place, "line 4");
}

TEST_F(CureTable, TakesNamesAndUnitsAsTheyCome) {
  const auto points = read(
      "\xEF\xBB\xBF\"Height [\xC2\xB5m]\";Gray;Exposure (ms);SD nm;N\r\n3.5;0.25;6000;200;4\r\n;0.5;3000;200;4\r\n");
  ASSERT_EQ(points.size(), 1U);  // the second step was not measured
  EXPECT_DOUBLE_EQ(points[0].gray, 0.25);
  EXPECT_DOUBLE_EQ(points[0].exposure, 2.0);
  EXPECT_DOUBLE_EQ(*points[0].standard_error_um, 0.1);
  EXPECT_EQ(points[0].repeats, 4.0);
  // Levels stay levels, be they ever so low.
  EXPECT_DOUBLE_EQ(read("level height_nm\n1 500\n0 0\n")[0].gray, 1.0 / 255.0);
  EXPECT_DOUBLE_EQ(read("level height_nm\n1 500\n0 0\n")[0].height_um, 0.5);
}

TEST_F(CureTable, SaysWhatIsWrongAndWhere) {
  EXPECT_NE(complaint("gray,height\n0,1\n").find("line 1: the column \"height\" has no unit: name it height_um"),
            std::string::npos);
  EXPECT_NE(complaint("gray,height_um\n0,1\n10,x\n").find("line 3: \"x\" is no number"), std::string::npos);
  EXPECT_NE(complaint("gray,height_um\n0,1\n300,2\n").find("line 3: a gray value"), std::string::npos);
  EXPECT_NE(complaint("gray,height_um\n0\n").find("line 2: 2 cells"), std::string::npos);
  EXPECT_NE(complaint("gray,height_um\n0,1,2\n").find("line 2: more than the 2"), std::string::npos);
  EXPECT_NE(complaint("gray,height_um,colour\n0,1,2\n").find("\"colour\" is not known; known are height_um"),
            std::string::npos);
  EXPECT_NE(complaint("height_um\n1\n").find("one column of gray values"), std::string::npos);
  EXPECT_NE(complaint("gray,level,height_um\n1,1,1\n").find("one column of gray values"), std::string::npos);
  EXPECT_NE(complaint("gray,height_um,height_nm\n1,1,1\n").find("two columns mean the same"), std::string::npos);
  EXPECT_NE(complaint("gray,height_um,sd_um\n1,1,1\n").find("needs the number of repeats"), std::string::npos);
  EXPECT_NE(complaint("gray,height_um,exposure_s\n1,1,0\n").find("an exposure must be positive"), std::string::npos);
  EXPECT_NE(complaint("gray,height_um\n").find("there are no steps"), std::string::npos);
}

}  // namespace
}  // namespace mezzotint
