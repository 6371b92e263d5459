#include "inverse/search/minimize.h"

#include <cmath>
#include <limits>
#include <stdexcept>

#include <gtest/gtest.h>

#include "forward/base/error.h"

namespace mezzotint {
namespace {

const std::vector<Variable> plane = {{"length", 1.0, 100.0, 50.0, true}, {"angle", -90.0, 90.0, 10.0, false}};

// One valley, at length 7 and angle −30.
double valley(const std::vector<double>& p) {
  return std::pow(std::log(p[0] / 7.0), 2) + std::pow((p[1] + 30.0) / 90.0, 2);
}

class MinimizeByName : public testing::TestWithParam<const char*> {};

TEST_P(MinimizeByName, FindsTheValley) {
  const MinimizeResult result =
      minimize(plane, valley, {.algorithm = GetParam(), .max_evaluations = 1500, .relative_tolerance = 1e-5});
  // The tolerance is 1e-5 of the unit cube: 1e-5·ln 100 in the logarithm, 0.002°; a hundred times that is asked.
  EXPECT_NEAR(result.best.values[0], 7.0, 0.05) << result.outcome;
  EXPECT_NEAR(result.best.values[1], -30.0, 0.5) << result.outcome;
  EXPECT_LE(result.evaluations, 1500);
}

INSTANTIATE_TEST_SUITE_P(NloptsOwnNames, MinimizeByName,
                         testing::Values("LN_BOBYQA", "LN_SBPLX", "LN_COBYLA", "LN_NELDERMEAD", "LN_PRAXIS",
                                         "GN_DIRECT_L", "GN_CRS2_LM", "G_MLSL_LDS", "LD_SLSQP", "LD_LBFGS", "LD_MMA",
                                         "AUGLAG"));

TEST(Minimize, KeepsTheBestPointThatItEverSaw) {
  double lowest = std::numeric_limits<double>::infinity();
  const auto watched = [&](const std::vector<double>& p) {
    const double value = valley(p);
    lowest = std::min(lowest, value);
    return value;
  };
  // COBYLA returns its last point.
  const MinimizeResult result = minimize(plane, watched, {.algorithm = "LN_COBYLA", .max_evaluations = 25});
  EXPECT_EQ(result.best.objective, lowest);
}

TEST(Minimize, GivesTheSameBitsForTheSameSeed) {
  for (const char* algorithm : {"GN_CRS2_LM", "GN_ISRES", "GN_ESCH", "G_MLSL"}) {
    const MinimizeOptions options{.algorithm = algorithm, .max_evaluations = 200, .seed = 5};
    EXPECT_EQ(minimize(plane, valley, options).best.values, minimize(plane, valley, options).best.values) << algorithm;
  }
}

TEST(Minimize, HandsTheObjectivesOwnExceptionToTheCallerAndStopsCalling) {
  int calls_after_failure = -1;
  const auto failing = [&](const std::vector<double>&) -> double {
    ++calls_after_failure;
    throw std::domain_error("the printer is on fire");
  };
  EXPECT_THROW((void)minimize(plane, failing, {.algorithm = "GN_CRS2_LM"}), std::domain_error);
  EXPECT_EQ(calls_after_failure, 0);
}

TEST(Minimize, NeverExceedsItsBudget) {
  for (const char* algorithm : {"LN_BOBYQA", "GN_CRS2_LM", "G_MLSL_LDS", "LD_LBFGS", "AUGLAG"}) {
    int calls = 0;
    const auto counted = [&](const std::vector<double>& p) {
      ++calls;
      return valley(p);
    };
    const auto result = minimize(plane, counted, {.algorithm = algorithm, .max_evaluations = 17});
    EXPECT_LE(calls, 17) << algorithm;
    EXPECT_EQ(calls, result.evaluations) << algorithm;
  }
}

TEST(Minimize, TreatsWhatIsNotFiniteAsWorseThanEverything) {
  const auto half_blind = [](const std::vector<double>& p) {
    return p[0] > 60.0 ? std::numeric_limits<double>::quiet_NaN() : valley(p);
  };
  const auto result = minimize(plane, half_blind, {.algorithm = "LN_SBPLX", .max_evaluations = 400});
  EXPECT_NEAR(result.best.values[0], 7.0, 0.5);
  const auto blind = [](const std::vector<double>&) { return std::numeric_limits<double>::quiet_NaN(); };
  EXPECT_THROW((void)minimize(plane, blind, {.max_evaluations = 20}), MethodError);
}

TEST(Minimize, FollowsSlopesThatTheObjectiveKnows) {
  const auto steep = [](const std::vector<double>& p, std::vector<double>& slopes) {
    slopes = {2.0 * std::log(p[0] / 7.0) / p[0], 2.0 * (p[1] + 30.0) / 8100.0};
    return valley(p);
  };
  for (const char* name : {"LD_MMA", "LD_LBFGS", "LD_SLSQP", "LD_CCSAQ"}) {
    const MinimizeOptions options{.algorithm = name, .max_evaluations = 200, .relative_tolerance = 1e-6};
    const MinimizeResult result = minimize_with_slopes(plane, steep, options);
    EXPECT_NEAR(result.best.values[0], 7.0, 0.01) << name;
    EXPECT_NEAR(result.best.values[1], -30.0, 0.1) << name;
    // Differences would take five evaluations a step.
    EXPECT_LT(result.evaluations, minimize(plane, valley, options).evaluations) << name;
  }
  EXPECT_THROW((void)minimize_with_slopes(plane, steep, {.algorithm = "LN_BOBYQA"}), InvalidInput);
}

TEST(Minimize, RefusesWhatMakesNoSense) {
  EXPECT_THROW((void)minimize({}, valley, {}), InvalidInput);
  EXPECT_THROW((void)minimize(plane, valley, {.algorithm = "BOBYQA"}), InvalidInput);
  EXPECT_THROW((void)minimize(plane, valley, {.max_evaluations = 0}), InvalidInput);
  EXPECT_THROW((void)minimize({{"length", 0.0, 1.0, 0.5, true}}, valley, {}), InvalidInput);
  EXPECT_THROW((void)minimize({{"length", 1.0, 2.0, 3.0, true}}, valley, {}), InvalidInput);
}

}  // namespace
}  // namespace mezzotint
