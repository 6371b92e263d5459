#include "inverse/design/design.h"

#include <cmath>

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "forward/base/error.h"
#include "inverse/design/closed_form_start.h"

namespace mezzotint {
namespace {

DesignProblem small_problem() {
  DesignProblem problem;
  problem.target = beckmann_target({0.20, 0.10, 40.0_deg});
  problem.pattern = Sinusoid{.height = 14.0_um};
  problem.free = {
      {"wavelength_u_um", 30.2, 600.0, {}}, {"wavelength_v_um", 30.2, 600.0, {}}, {"direction_deg", -90.0, 90.0, {}}};
  problem.patch = {.pixels = 96, .subsamples = 2};
  problem.search_draws = 4;
  problem.fresh_draws = 4;
  problem.search.max_evaluations = 80;
  return problem;
}

TEST(Design, OfASinusoidMeetsItsTargetOnFreshDraws) {
  const DesignProblem problem = small_problem();
  const Design design = find_design(problem);
  EXPECT_TRUE(design.met) << "variances " << design.fresh_error.variance_major << ", "
                          << design.fresh_error.variance_minor << ", axis " << design.fresh_error.rotation.degrees()
                          << "°";
  EXPECT_GE(design.search.history.size(), 2U);
  EXPECT_LE(design.search.cost, problem.search.max_evaluations);
}

TEST(Design, GivesTheSameBitsWithOneThreadAndWithTwo) {
  DesignProblem problem = small_problem();
  problem.search.max_evaluations = 12;
  std::vector<DesignStep> histories[2];
  for (const int threads : {1, 2}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    histories[threads - 1] = find_design(problem).search.history;
  }
  ASSERT_EQ(histories[0].size(), histories[1].size());
  for (std::size_t i = 0; i < histories[0].size(); ++i) {
    EXPECT_EQ(histories[0][i].step.objective, histories[1][i].step.objective);
    EXPECT_EQ(histories[0][i].step.values, histories[1][i].step.values);
  }
}

TEST(Design, SaysThatAMirrorBelowTheGroundNoiseIsOutOfReach) {
  DesignProblem problem = small_problem();
  problem.target = beckmann_target({0.004, 0.004, 0.0_deg});
  problem.search.max_evaluations = 40;
  const Design design = find_design(problem);
  EXPECT_FALSE(design.met);
  EXPECT_FALSE(design.warnings.empty());
}

TEST(Design, NeverSearchesOnTheDrawsThatJudgeIt) {
  DesignProblem problem = small_problem();
  problem.search_draws = 256;
  problem.fresh_draws = 256;
  for (const auto searched : search_seeds(problem)) {
    for (const auto fresh : fresh_seeds(problem)) EXPECT_NE(searched, fresh);
  }
}

TEST(Design, BeginsWhereTheClosedFormPutsIt) {
  const PrinterProfile printer;
  const Target target = beckmann_target({0.12, 0.06, 20.0_deg});
  const PrintedTexture texture(printer, {.pixels = 128, .subsamples = 4}, {1, 2, 3, 4});
  for (const Pattern& pattern :
       {Pattern{Noise{.height = 12.0_um}}, Pattern{FractionalBrownianMotion{.height = 12.0_um, .octaves = 2}},
        Pattern{Turbulence{.height = 12.0_um, .octaves = 2}}, Pattern{LineIntegralConvolution{.height = 12.0_um}}}) {
    const Pattern start = closed_form_start(pattern, target, printer, 0.55_um);
    // A start, not the truth: the printed slopes are within a third of the target's.
    const SlopeAxes printed = estimate_axes(texture.slope_covariances(start, GrayLevels::Quantized)).axes;
    EXPECT_NEAR(printed.rms_major / target.slopes.rms_major, 1.0, 0.33) << kind_name(pattern);
    EXPECT_NEAR(printed.rms_minor / target.slopes.rms_minor, 1.0, 0.33) << kind_name(pattern);
    EXPECT_LT(axis_difference(printed.rotation, target.slopes.rotation).degrees(), 5.0) << kind_name(pattern);
  }
}

TEST(Design, RefusesToSearchWhatItCannotChange) {
  DesignProblem problem = small_problem();
  problem.pattern = FractionalBrownianMotion{};
  problem.free = {{"octaves", 2.0, 5.0, {}}};
  EXPECT_THROW((void)search_variables(problem), InvalidInput);
}

}  // namespace
}  // namespace mezzotint
