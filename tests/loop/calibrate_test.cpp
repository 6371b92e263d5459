#include <cmath>

#include <gtest/gtest.h>

#include "tests/loop/workplace.h"

namespace mezzotint::test {
namespace {

nlohmann::json results(const Workplace& here, const std::string& line, int status = 0) {
  const Ending ending = here.mezzotint(words(line + " --json --quiet"));
  EXPECT_EQ(ending.status, status) << line << "\n" << ending.err;
  return status == 0 ? nlohmann::json::parse(ending.out) : nlohmann::json();
}

void expect_covered(const nlohmann::json& number, double truth) {
  EXPECT_LE(number.at("low_95"), truth);
  EXPECT_GE(number.at("high_95"), truth);
}

// A wedge is printed on the virtual printer and scanned; from the scan, and from a table of what was found in it, to a
// profile that other commands take. The truth is the printer's own curve. (A seed whose intervals hold it: at 95 %
// others do not.)
TEST(Calibrate, LeadsFromAPrintedWedgeToAProfile) {
  const Workplace here;
  results(here, "calibrate --wedge wedge.uvj --base printer.toml --step-pixels 24 --rows 40");
  results(here, "print wedge.uvj -o print.gwy --printer printer.toml --subsamples 2 --seed 3");
  results(here,
          "measure print.gwy -o scan.gwy --pitch 4 --noise 60 --tilt 0.003,-0.002 --bandwidth 10 --dropouts 0.01");
  const auto found = results(here, "calibrate scan.gwy --base printer.toml -o ours.toml");
  expect_covered(found.at("alpha"), 17.71);
  expect_covered(found.at("beta"), 10.24);
  expect_covered(found.at("gamma"), -0.01);
  EXPECT_EQ(found.at("range").at("first_level").at("value"), 43);
  EXPECT_EQ(found.at("wedge").at("steps").size(), 19U);
  const std::string profile = here.read("ours.toml"), page = here.read("calibration.html");
  EXPECT_NE(here.read("ours.toml").find("source_sha256"), std::string::npos);

  std::string table = "level,height_um,standard_error_um\n";
  for (const auto& step : found.at("steps"))
    table += std::to_string(255.0 * step.at("gray").get<double>()) + "," +
             std::to_string(step.at("height").at("value").get<double>()) + "," +
             std::to_string(step.at("height").at("standard_error").get<double>()) + "\n";
  here.write("steps.csv", table);
  const auto again = results(here, "calibrate steps.csv --base printer.toml -o again.toml");
  for (const char* name : {"alpha", "beta", "gamma"}) {
    // Six decimals in the table.
    EXPECT_NEAR(again.at(name).at("value").get<double>(), found.at(name).at("value").get<double>(), 1e-4) << name;
  }
  // The profile is one that printing takes; and another run of the same gives the same bytes.
  results(here, "print wedge.uvj -o other.gwy --printer ours.toml --subsamples 1");
  results(here, "calibrate scan.gwy --base printer.toml -o ours.toml");
  EXPECT_EQ(here.read("ours.toml"), profile);
  EXPECT_TRUE(here.read("calibration.html") == page);
}

TEST(Calibrate, SaysWhatIsWrong) {
  const Workplace here;
  here.write("steps.csv", "gray,height\n0,1\n");
  const Ending table = here.mezzotint(words("calibrate steps.csv -o ours.toml"));
  EXPECT_EQ(table.status, 2);
  EXPECT_NE(table.err.find("steps.csv: line 1: the column \"height\" has no unit"), std::string::npos) << table.err;
  EXPECT_FALSE(here.files().contains("ours.toml"));
  here.write("good.csv", "gray,height_um,standard_error_um\n100,8,0.1\n200,15,0.1\n");
  EXPECT_EQ(here.mezzotint(words("calibrate good.csv -o ours.txt")).status, 2);
  EXPECT_EQ(here.mezzotint(words("calibrate good.csv")).status, 2);
  EXPECT_EQ(here.mezzotint(words("calibrate -o ours.toml")).status, 2);
  EXPECT_EQ(here.mezzotint(words("calibrate good.csv -o ours.toml --levels 0:255:15")).status, 2);
  EXPECT_EQ(here.mezzotint(words("calibrate good.csv -o nowhere/ours.toml")).status, 1);
  const Ending two = here.mezzotint(words("calibrate good.csv -o ours.toml"));
  EXPECT_EQ(two.status, 0) << two.err;
  EXPECT_NE(two.err.find("gamma is not determined: interval (-inf"), std::string::npos) << two.err;
}

}  // namespace
}  // namespace mezzotint::test
