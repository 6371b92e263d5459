#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <stdexcept>

#include <nlopt.h>

#include "forward/base/random.h"
#include "inverse/search/evaluation_log.h"
#include "inverse/search/minimize.h"
#include "tests/stability/scene.h"

namespace mezzotint {
namespace {

using Point = std::vector<double>;

constexpr const char* theme = "Inverse design";
constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

constexpr std::array every_algorithm = {
    "GN_DIRECT",
    "GN_DIRECT_L",
    "GN_DIRECT_L_RAND",
    "GN_DIRECT_NOSCAL",
    "GN_ORIG_DIRECT",
    "GN_ORIG_DIRECT_L",
    "GN_DIRECT_L_RAND_NOSCAL",
    "GN_DIRECT_L_NOSCAL",
    "GD_STOGO",
    "GD_STOGO_RAND",
    "LD_LBFGS",
    "LN_PRAXIS",
    "LD_VAR1",
    "LD_VAR2",
    "LD_TNEWTON",
    "LD_TNEWTON_RESTART",
    "GN_CRS2_LM",
    "LD_TNEWTON_PRECOND",
    "LD_TNEWTON_PRECOND_RESTART",
    "GN_MLSL",
    "GD_MLSL",
    "GN_MLSL_LDS",
    "GD_MLSL_LDS",
    "G_MLSL",
    "G_MLSL_LDS",
    "LD_MMA",
    "LD_CCSAQ",
    "LD_SLSQP",
    "LN_COBYLA",
    "LN_NEWUOA",
    "LN_NEWUOA_BOUND",
    "LN_BOBYQA",
    "LN_NELDERMEAD",
    "LN_SBPLX",
    "AUGLAG",
    "AUGLAG_EQ",
    "LN_AUGLAG",
    "LD_AUGLAG",
    "LN_AUGLAG_EQ",
    "LD_AUGLAG_EQ",
    "GN_ISRES",
    "GN_ESCH",
    "GN_AGS",
};

std::vector<Variable> box(std::size_t count) {
  return std::vector<Variable>(count, {"length", 1.0, 100.0, 20.0, true});
}

// One valley, where every length is 7.
double valley(const Point& point) {
  double sum = 0.0;
  for (const double length : point) sum += std::pow(std::log(length / 7.0), 2);
  return sum;
}

struct OnFire : std::runtime_error {
  OnFire() : std::runtime_error("the printer is on fire") {}
};

std::filesystem::path fresh_file(const std::string& name) {
  const auto file = std::filesystem::temp_directory_path() / ("mezzotint_where_searches_fail_" + name + ".jsonl");
  std::filesystem::remove(file);
  return file;
}

TEST(Search, HandsOnAnExceptionFromUnderEveryAlgorithmAndCallsNoMore) {
  int algorithms = 0;
  for (const char* name : every_algorithm) {
    int calls = 0, seen = 0;
    double best = HUGE_VAL;
    const auto objective = [&](const Point& point) {
      if (++calls == 5) throw OnFire();
      return valley(point);
    };
    const auto observer = [&](int, const SearchStep& step) {
      ++seen;
      best = std::min(best, step.objective);
    };
    try {
      (void)minimize(box(3), objective, {.algorithm = name, .max_evaluations = 200}, observer);
      ADD_FAILURE() << name << " swallowed the exception";
    } catch (const OnFire& error) {
      EXPECT_STREQ(error.what(), "the printer is on fire") << name;
    }
    EXPECT_EQ(calls, 5) << name;
    EXPECT_EQ(seen, 4) << name;
    EXPECT_LT(best, HUGE_VAL) << name;
    ++algorithms;
  }
  test::record(
      {theme, "every algorithm of NLopt", "the objective throws at its fifth evaluation",
       fmt::format(
           "{} algorithms, AUGLAG and MLSL with their local searches among them: the exception comes "
           "through as it was thrown, no evaluation follows it, and the four before it were told (a log has them). "
           "(NLopt by itself says “nlopt failure”, and some go on asking.)",
           algorithms),
       "Caught at the border of NLopt and thrown again behind it.", "—"});
}

TEST(Search, OfAnObjectiveThatIsNoNumberInPlacesGoesOnWithoutThem) {
  int worse = 0, met = 0;
  for (const char* name : every_algorithm) {
    // From the start most steps up lead to where there is no number.
    const auto objective = [](const Point& point) { return point[0] > 22.0 ? not_a_number : valley(point); };
    const auto result = minimize(box(3), objective, {.algorithm = name, .max_evaluations = 400});
    EXPECT_TRUE(std::isfinite(result.best.objective)) << name;
    EXPECT_LE(result.best.values[0], 22.0) << name;
    met += result.not_finite > 0 ? 1 : 0;
    worse += result.best.objective > 0.01 ? 1 : 0;
  }
  EXPECT_GT(met, 20);
  test::record({theme, "every algorithm of NLopt", "an objective that is NaN in a third of the box, next to the start",
                fmt::format("{} of {} algorithms asked there. All end with a finite best that they saw themselves; {} "
                            "of them farther than 0.1 in the logarithm from the valley after 400 evaluations.",
                            met, every_algorithm.size(), worse),
                "Counted (`not_finite`), as worse than everything; a search of a design warns with the number.", "—"});
}

TEST(Search, OfNoNumberAtAllSaysSo) {
  const auto nowhere = [](const Point&) { return not_a_number; };
  for (const char* name : every_algorithm)
    EXPECT_THROW((void)minimize(box(3), nowhere, {.algorithm = name, .max_evaluations = 60}), MethodError) << name;
  const std::string told = test::refusal([&] { (void)minimize(box(3), nowhere, {.max_evaluations = 60}); });
  EXPECT_NE(told.find("none gave a finite objective"), std::string::npos) << told;
  test::record({theme, "every algorithm of NLopt", "an objective that is NaN, or infinite, everywhere",
                "There is no best. It is an error, not a design.", "No finite objective was seen.", told});
}

TEST(Search, BySlopesThatAreNoNumbersDoesNotFollowThem) {
  const auto steep = [](const Point& point, Point& slopes) {
    for (std::size_t i = 0; i < point.size(); ++i)
      slopes[i] = point[i] > 40.0 ? not_a_number : 2.0 * std::log(point[i] / 7.0) / point[i];
    return valley(point);
  };
  std::vector<Variable> variables = box(3);
  int lost = 0;
  for (const char* name : {"LD_MMA", "LD_CCSAQ", "LD_LBFGS", "LD_SLSQP", "LD_VAR2", "LD_TNEWTON_PRECOND_RESTART"}) {
    const auto result = minimize_with_slopes(variables, steep, {.algorithm = name, .max_evaluations = 100});
    EXPECT_LT(result.best.objective, valley({20.0, 20.0, 20.0})) << name;
    EXPECT_GT(result.best.values[0], 1.0) << name;
    lost += result.best.objective > 0.01 ? 1 : 0;
  }
  EXPECT_EQ(lost, 0);
  for (Variable& variable : variables) variable.start = 60.0;
  const std::string told = test::refusal(
      [&] { (void)minimize_with_slopes(variables, steep, {.algorithm = "LD_LBFGS", .max_evaluations = 20}); });
  EXPECT_NE(told.find("none gave a finite objective"), std::string::npos) << told;
  test::record({theme, "searches by slopes (MMA, LBFGS, SLSQP, …)",
                "a finite objective whose slopes are NaN beyond 40, from 20 and from 60",
                "From 20 all reach the valley at 7. From 60 there is no slope to follow: an error.",
                "A slope that is no number makes its whole evaluation one that is not finite.", told});
}

TEST(Search, OnAFlatObjectiveSaysSo) {
  for (const char* name : every_algorithm) {
    const auto result = minimize(box(3), [](const Point&) { return 3.0; }, {.algorithm = name, .max_evaluations = 200});
    EXPECT_NE(result.outcome.find("same wherever it was asked"), std::string::npos) << name << ": " << result.outcome;
    EXPECT_FALSE(result.converged) << name;
    EXPECT_EQ(result.best.objective, 3.0) << name;
  }
  const auto told = minimize(box(3), [](const Point&) { return 3.0; }, {});
  test::record({theme, "every algorithm of NLopt", "an objective that is the same everywhere",
                fmt::format("NLopt calls it a success: BOBYQA “converges” after {} evaluations, at the start.",
                            told.evaluations),
                "The highest and the lowest objective that were seen are equal.", told.outcome});
}

TEST(Search, ThatEndsBeforeItsFirstEvaluationSaysWhy) {
  const auto told_by = [](const char* name, std::size_t variables) {
    return test::refusal([&] { (void)minimize(box(variables), valley, {.algorithm = name, .max_evaluations = 100}); });
  };
  EXPECT_NE(told_by("GN_AGS", 11).find("before its first evaluation"), std::string::npos);
  EXPECT_EQ(told_by("GN_AGS", 5), "");
  EXPECT_NE(told_by("LN_NEWUOA_BOUND", 1).find("must be >= 2"), std::string::npos);
  EXPECT_NE(told_by("LD_LBFGS_NOCEDAL", 3).find("before its first evaluation"), std::string::npos);
  test::record({theme, "`GN_AGS`, `LN_NEWUOA`, `LD_LBFGS_NOCEDAL`", "11 variables; one variable; any number",
                "NLopt knows the names, takes the problem, and makes not one evaluation: AGS above 10 variables, "
                "NEWUOA with one, Nocedal's LBFGS always (it is not in NLopt any more).",
                "No evaluation happened.", told_by("GN_AGS", 11)});
}

TEST(Search, ByStogoEndsWithItsBudget) {
  int calls = 0;
  const auto counted = [&](const Point& point) {
    ++calls;
    return valley(point);
  };
  const auto result = minimize(box(2), counted, {.algorithm = "GD_STOGO", .max_evaluations = 150});
  EXPECT_LE(calls, 150);
  EXPECT_EQ(calls, result.evaluations);
  test::record({theme, "`GD_STOGO`", "more boxes to divide than the budget of 150 evaluations",
                "StoGO hears no forced stop, which ends every other algorithm: by that alone it did not return within "
                "two minutes.",
                "NLopt's own count of evaluations is set beside.", result.outcome});
}

// NLopt itself, beside the account that the program keeps.
TEST(Search, ByCobylaReturnsItsLastPointNotItsBest) {
  const auto rippled = [](const Point& x) {
    double sum = 0.0;
    for (std::size_t i = 0; i < 3; ++i)
      sum += std::pow(x[i] - 0.42 - 0.1 * static_cast<double>(i), 2) + 0.3 * std::sin(40.0 * x[i]);
    return sum;
  };
  static double best;  // of the run, for a plain C callback
  const auto call = [](unsigned count, const double* x, double*, void* objective) {
    const double value = (*static_cast<decltype(rippled)*>(objective))(Point(x, x + count));
    best = std::min(best, value);
    return value;
  };
  int above = 0, runs = 0;
  double most = 0.0;
  for (; runs < 20; ++runs) {
    best = HUGE_VAL;
    Point x = {0.05 * runs, 0.5, 0.9 - 0.03 * runs};
    nlopt_opt raw = nlopt_create(NLOPT_LN_COBYLA, 3);
    auto objective = rippled;
    nlopt_set_min_objective(raw, call, &objective);
    nlopt_set_lower_bounds1(raw, 0.0);
    nlopt_set_upper_bounds1(raw, 1.0);
    nlopt_set_initial_step1(raw, 0.1);
    nlopt_set_xtol_abs1(raw, 1e-3);
    std::vector<Variable> variables;
    for (const double start : x) variables.push_back({"number", 0.0, 1.0, start, false});
    double value = 0.0;
    nlopt_optimize(raw, x.data(), &value);
    nlopt_destroy(raw);
    above += rippled(x) > best ? 1 : 0;
    most = std::max(most, rippled(x) - best);

    double lowest = HUGE_VAL;
    const auto watched = [&](const Point& point) {
      const double seen = rippled(point);
      lowest = std::min(lowest, seen);
      return seen;
    };
    EXPECT_EQ(minimize(variables, watched, {.algorithm = "LN_COBYLA"}).best.objective, lowest);
  }
  EXPECT_GT(above, 0);
  test::record({theme, "`LN_COBYLA`", "20 starts on a rippled valley, NLopt 2.7.1 by itself",
                fmt::format("It returns a point above the lowest that it had seen in {} of {} runs, by up to {:.1g} "
                            "(ripples of 0.3). A search here returns the lowest.",
                            above, runs, most),
                "The program keeps its own best, whatever the algorithm.", "—"});
}

TEST(EvaluationLog, OnAFullDiskStopsTheSearch) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "there is no /dev/full here";
  const std::string told = test::refusal([] { EvaluationLog("/dev/full", "a"); });
  EXPECT_NE(told.find("is the disk full"), std::string::npos) << told;
  test::record({theme, "log of evaluations", "a full disk (/dev/full)",
                "The search stops: what it finds could not be gone on with. Lines that were written stay.",
                "Every line is flushed, and the stream asked.", told});
}

TEST(EvaluationLog, CutOffForeignOrDamagedIsToldApart) {
  const auto file = fresh_file("log");
  {
    EvaluationLog log(file, "a");
    for (double k = 0.0; k < 4.0; k += 1.0) log.append({"fine", {k}, {2.0 * k}});
  }
  std::filesystem::resize_file(file, std::filesystem::file_size(file) - 7);
  EXPECT_EQ(EvaluationLog(file, "a").found(), 3U);
  test::record({theme, "log of evaluations", "the program was killed in the middle of a line",
                "The line counts as not written: 3 of 4 evaluations are taken from the log, the fourth is made again.",
                "No end of line.", "—"});

  const std::string foreign = test::refusal([&] { EvaluationLog(file, "b"); });
  EXPECT_NE(foreign.find("another search"), std::string::npos) << foreign;
  test::record({theme, "log of evaluations", "that of another problem", "It is refused, and not written to.",
                "A digest of the problem in the first line.", foreign.substr(foreign.find("line 1"))});

  EvaluationLog log(file, "a");
  EXPECT_TRUE(log.replay("fine", {0.0}).has_value());
  const std::string strayed = test::refusal([&] { (void)log.replay("fine", {std::nextafter(1.0, 2.0)}); });
  EXPECT_NE(strayed.find("asks for another evaluation"), std::string::npos) << strayed;
  test::record({theme, "log of evaluations", "another processor whose libm rounds another way: one bit of a variable",
                "The search would leave its own path: it is refused rather than mixed.",
                "Every question is compared with the log's, bit by bit.", strayed.substr(strayed.find("line"))});

  { std::ofstream(file, std::ios::app) << "{\"stage\": 3}\n"; }
  const std::string damaged = test::refusal([&] { EvaluationLog(file, "a"); });
  EXPECT_NE(damaged.find("line 5"), std::string::npos) << damaged;
  test::record({theme, "log of evaluations", "a line that is no evaluation", "It is refused with its number.",
                "Every line is read before the search begins.", damaged.substr(damaged.find("line"))});
  std::filesystem::remove(file);
}

}  // namespace
}  // namespace mezzotint
