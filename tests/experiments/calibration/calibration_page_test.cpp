#include "experiments/calibration/calibration_page.h"

#include <gtest/gtest.h>

#include "tests/fabrication/calibration/cure_samples.h"

namespace mezzotint {
namespace {

CalibrationFindings findings_of(std::vector<double> grays) {
  CalibrationFindings findings{.source = "steps.csv", .source_sha256 = std::string(64, '0')};
  findings.fit = fit_cure(test::draw({.grays = std::move(grays)}, 3));
  findings.printer.cure = findings.fit.curve;
  findings.printer.name = "ours";
  findings.range = reachable_range(findings.fit, findings.printer);
  return findings;
}

TEST(CalibrationPage, ShowsCurveResidualsAndSteps) {
  const CalibrationFindings findings = findings_of(test::every_level(0, 255, 15));
  const auto page = to_report_json(calibration_page(findings));
  EXPECT_EQ(page.at("title"), "Calibration of ours");
  ASSERT_EQ(page.at("sections").size(), 3U);  // no scan
  EXPECT_NE(page.dump().find("Residuals"), std::string::npos);
  EXPECT_NE(page.dump().find("step 18"), std::string::npos);
}

TEST(CalibrationPage, ShowsNoBoundWhereThereIsNone) {
  const CalibrationFindings findings = findings_of(test::every_level(170, 255, 17));
  ASSERT_FALSE(findings.fit.gamma_is_determined);
  const auto page = to_report_json(calibration_page(findings));
  EXPECT_NE(page.dump().find("no bound"), std::string::npos);
  EXPECT_NE(page.dump().find("not determined"), std::string::npos);
  const auto json = to_json(findings);
  EXPECT_TRUE(json.at("gamma").at("low_95").is_null());
  EXPECT_FALSE(json.at("gamma_determined"));
  EXPECT_FALSE(record_of(findings).gamma.low.has_value());
}

TEST(CalibrationFindings, TellEveryNumberWithItsInterval) {
  const CalibrationFindings findings = findings_of(test::every_level(0, 255, 15));
  const auto json = to_json(findings);
  for (const char* name : {"alpha", "beta", "gamma"}) {
    EXPECT_LT(json.at(name).at("low_95"), json.at(name).at("value")) << name;
    EXPECT_GT(json.at(name).at("high_95"), json.at(name).at("value")) << name;
  }
  EXPECT_EQ(json.at("steps").size(), 18U);
  EXPECT_EQ(json.at("range").at("first_level").at("value"), findings.range.first_level.level);
  EXPECT_NE(in_words(findings).find("curing begins at gray 0.16"), std::string::npos) << in_words(findings);
}

}  // namespace
}  // namespace mezzotint
