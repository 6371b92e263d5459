#include "fabrication/calibration/cure_fit.h"

#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include "fabrication/calibration/quantiles.h"
#include "forward/base/error.h"
#include "tests/fabrication/calibration/cure_samples.h"

namespace mezzotint {
namespace {

using test::draw;
using test::every_level;
using test::WedgeSample;

bool covers(const FittedNumber& number, double truth) { return number.low_95 <= truth && truth <= number.high_95; }

std::string all_notes(const CureFit& fit) {
  std::string text;
  for (const std::string& note : fit.notes) text += note + "\n";
  return text;
}

TEST(Quantiles, AreThoseOfTheTables) {
  EXPECT_NEAR(normal_quantile(0.975), 1.959964, 1e-6);
  EXPECT_NEAR(student_quantile(0.975, 1.0), 12.7062, 1e-4);
  EXPECT_NEAR(student_quantile(0.975, 9.0), 2.262157, 1e-6);
  EXPECT_NEAR(student_quantile(0.025, 30.0), -2.042272, 1e-6);
  EXPECT_NEAR(chi_squared_chance(18.307, 10.0), 0.05, 1e-5);
  EXPECT_NEAR(log_normal_probability(0.0).log_probability, std::log(0.5), 1e-15);
  EXPECT_NEAR(log_normal_probability(-10.0).log_probability, -53.23128515, 1e-6);
  // From both sides of the change of formula.
  EXPECT_NEAR(log_normal_probability(-30.0 - 1e-9).log_probability,
              log_normal_probability(-30.0 + 1e-9).log_probability, 1e-5);
}

TEST(CureFit, FindsTheSlidesCurveInExactHeights) {
  WedgeSample sample{.grays = every_level(0, 255, 15), .error_um = 1e-5};
  std::vector<CurePoint> points = draw(sample, 1);
  const CureFit fit = fit_cure(points);
  // Errors of 1e-5 µm, times the curve's own condition (γ: a thousandth of a µm per 2e-5).
  EXPECT_NEAR(fit.curve.alpha.um(), 17.71, 1e-3);
  EXPECT_NEAR(fit.curve.beta.um(), 10.24, 1e-3);
  EXPECT_NEAR(fit.curve.gamma, -0.01, 2e-5);
  EXPECT_TRUE(fit.gamma_is_determined);
  ASSERT_EQ(fit.points.size(), 18U);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(fit.points[i].role, PointRole::BelowCure) << i;
  EXPECT_EQ(fit.points[3].role, PointRole::Measured);
}

// The only things that decide are the points and their errors: an exposure k times as long is a curve whose α is
// β ln k larger.
TEST(CureFit, MovesAlphaByBetaLogOfTheExposure) {
  const WedgeSample sample{.grays = every_level(0, 255, 15), .error_um = 0.05};
  std::vector<CurePoint> points = draw(sample, 3);
  const CureFit before = fit_cure(points);
  for (CurePoint& point : points) point.exposure = 1.7;
  const CureFit after = fit_cure(points);
  EXPECT_NEAR(before.curve.alpha.um() - after.curve.alpha.um(), before.curve.beta.um() * std::log(1.7), 1e-5);
  EXPECT_NEAR(after.curve.beta.um(), before.curve.beta.um(), 1e-5);
  EXPECT_NEAR(after.curve.gamma, before.curve.gamma, 1e-7);
}

TEST(CureFit, JoinsGrayLevelsAndExposureTimes) {
  WedgeSample sample{.grays = every_level(60, 255, 15), .error_um = 0.08};
  std::vector<CurePoint> points = draw(sample, 5);
  const double alone = fit_cure(points).beta_um.standard_error;
  const RandomStream stream(8, RandomPurpose::Test);
  for (std::uint64_t i = 0; i < 8; ++i) {
    CurePoint point{.gray = 0.5, .exposure = 0.4 + 0.2 * static_cast<double>(i)};
    point.height_um = 17.71 + 10.24 * std::log(point.exposure * 0.51) + 0.08 * stream.normal4(i)[0];
    point.standard_error_um = 0.08;
    points.push_back(point);
  }
  const CureFit joint = fit_cure(points);
  EXPECT_LT(joint.beta_um.standard_error, 0.8 * alone);
  EXPECT_TRUE(covers(joint.alpha_um, 17.71));
  EXPECT_TRUE(covers(joint.beta_um, 10.24));
  EXPECT_TRUE(covers(joint.gamma, -0.01));
}

TEST(CureFit, SaysWhereExposuresAtOneLevelCannotTellGamma) {
  std::vector<CurePoint> points;
  const RandomStream stream(2, RandomPurpose::Test);
  for (std::uint64_t i = 0; i < 8; ++i) {
    CurePoint point{.gray = 0.5, .exposure = 0.4 + 0.2 * static_cast<double>(i), .standard_error_um = 0.05};
    point.height_um = 17.71 + 10.24 * std::log(point.exposure * 0.51) + 0.05 * stream.normal4(i)[0];
    points.push_back(point);
  }
  const CureFit fit = fit_cure(points);
  EXPECT_FALSE(fit.gamma_is_determined);
  EXPECT_EQ(fit.gamma.low_95, -INFINITY);
  EXPECT_EQ(fit.curve.gamma, -0.01);
  EXPECT_NE(all_notes(fit).find("gamma is not determined: interval (-inf"), std::string::npos) << all_notes(fit);
  EXPECT_TRUE(covers(fit.beta_um, 10.24));
  EXPECT_TRUE(covers(fit.alpha_um, 17.71));
}

TEST(CureFit, SaysWhereHighLevelsAloneCannotTellGamma) {
  const WedgeSample sample{.grays = every_level(170, 255, 17), .error_um = 0.1};
  CureFitOptions options;
  options.base.gamma = -0.03;
  const CureFit fit = fit_cure(draw(sample, 4), options);
  EXPECT_FALSE(fit.gamma_is_determined);
  EXPECT_EQ(fit.curve.gamma, -0.03);
  EXPECT_NE(all_notes(fit).find("the base profile's"), std::string::npos);
}

// A spike in one step, and a step that was torn off, barely move the curve; least squares would move α by more than
// its interval.
TEST(CureFit, TrustsOutliersLessAndSaysSo) {
  const WedgeSample sample{.grays = every_level(0, 255, 15), .error_um = 0.1};
  const std::vector<CurePoint> clean = draw(sample, 6);
  std::vector<CurePoint> points = clean;
  points[9].height_um += 4.0;
  points[14].height_um = 0.0;
  const CureFit with = fit_cure(points), without = fit_cure(clean);
  EXPECT_NEAR(with.curve.alpha.um(), without.curve.alpha.um(), 0.15);
  EXPECT_NEAR(with.curve.beta.um(), without.curve.beta.um(), 0.3);
  EXPECT_LT(with.points[9].weight, 0.1);
  EXPECT_LT(with.points[14].weight, 0.1);
  EXPECT_NE(all_notes(with).find("step 10 lies"), std::string::npos);
  EXPECT_NE(all_notes(with).find("step 15 lies"), std::string::npos);
  EXPECT_TRUE(covers(with.alpha_um, 17.71));
  // On the first step that cures hangs γ: where it lies off, the rest still decide.
  points = clean;
  points[3].height_um += 3.0;
  const CureFit first = fit_cure(points);
  EXPECT_LT(first.points[3].weight, 0.1);
  EXPECT_TRUE(covers(first.gamma, -0.01)) << first.gamma.low_95 << " " << first.gamma.high_95;
}

TEST(CureFit, TakesSaturatedStepsAsSuch) {
  WedgeSample sample{.grays = every_level(0, 255, 15), .layer_um = 14.0, .error_um = 0.1};
  const std::vector<CurePoint> points = draw(sample, 7);
  CureFitOptions options;
  options.layer = 14.0_um;
  const CureFit fit = fit_cure(points, options);
  EXPECT_TRUE(covers(fit.beta_um, 10.24)) << fit.beta_um.low_95 << " " << fit.beta_um.high_95;
  EXPECT_EQ(fit.points.back().role, PointRole::Saturated);
  // As heights of the curve they would bend it.
  options.layer = 18.0_um;
  EXPECT_FALSE(covers(fit_cure(points, options).beta_um, 10.24));
}

TEST(CureFit, ScalesErrorsThatAreTooSmall) {
  WedgeSample sample{.grays = every_level(0, 255, 15), .error_um = 0.1};
  std::vector<CurePoint> points = draw(sample, 11);
  for (CurePoint& point : points) *point.standard_error_um = 0.02;
  const CureFit fit = fit_cure(points);
  EXPECT_LT(fit.probability, 0.01);
  EXPECT_NEAR(fit.scale, 5.0, 2.5);
  EXPECT_NE(all_notes(fit).find("errors were scaled"), std::string::npos);
  EXPECT_TRUE(covers(fit.alpha_um, 17.71));
}

// A common offset of all heights belongs to α, and widens its interval by as much.
TEST(CureFit, CarriesTheErrorOfTheBaseIntoAlpha) {
  const std::vector<CurePoint> points = draw({.grays = every_level(0, 255, 15)}, 12);
  CureFitOptions options;
  const CureFit before = fit_cure(points, options);
  options.common_error_um = 0.3;
  const CureFit after = fit_cure(points, options);
  EXPECT_NEAR(after.alpha_um.standard_error, std::hypot(before.alpha_um.standard_error, 0.3), 1e-9);
  EXPECT_EQ(after.beta_um.high_95, before.beta_um.high_95);
  EXPECT_NEAR(after.alpha_um.high_95 - after.alpha_um.value,
              std::hypot(before.alpha_um.high_95 - before.alpha_um.value, 0.3 * 1.959964), 1e-6);
}

// Of 100 wedges each interval should hold 95 ± 2.2: fewer than 87 (3.6 of these) has a chance of 2e-3 in all six.
// Errors that were a third too small would give 81. A study counts thousands.
TEST(CureFit, IntervalsCoverTheTruthAsOftenAsTheySay) {
  for (const bool say_error : {true, false}) {
    const WedgeSample sample{.grays = every_level(0, 255, 15), .error_um = 0.15, .say_error = say_error};
    std::array<int, 3> held{};
    for (std::uint64_t seed = 0; seed < 100; ++seed) {
      const CureFit fit = fit_cure(draw(sample, 100 + seed));
      EXPECT_TRUE(fit.gamma_is_determined) << seed;
      held[0] += covers(fit.alpha_um, 17.71) ? 1 : 0;
      held[1] += covers(fit.beta_um, 10.24) ? 1 : 0;
      held[2] += covers(fit.gamma, -0.01) ? 1 : 0;
    }
    for (const int count : held) EXPECT_GE(count, 87) << say_error;
  }
}

TEST(CureFit, RefusesWhatCannotGiveACurve) {
  const WedgeSample sample{.grays = every_level(0, 255, 15)};
  std::vector<CurePoint> points = draw(sample, 1);
  points[3].gray = 15.0;
  EXPECT_THROW((void)fit_cure(points), InvalidInput);
  points = draw(sample, 1);
  points[3].standard_error_um.reset();
  EXPECT_THROW((void)fit_cure(points), InvalidInput);
  EXPECT_THROW((void)fit_cure({}), InvalidInput);
  points = draw({.grays = {0.0, 0.1, 0.5}}, 1);  // a single step that cured
  EXPECT_THROW((void)fit_cure(points), InvalidInput);
  points = draw({.grays = {0.0, 0.1, 0.5, 0.8}, .say_error = false}, 1);  // two, and nothing of how they scatter
  EXPECT_THROW((void)fit_cure(points), InvalidInput);
  EXPECT_NO_THROW((void)fit_cure(draw({.grays = {0.0, 0.1, 0.5, 0.8}}, 1)));
}

}  // namespace
}  // namespace mezzotint
