#include "experiments/study/study.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "experiments/study/scene.h"
#include "experiments/study/study_svg.h"
#include "forward/base/error.h"
#include "forward/surface/slope_covariance.h"

namespace mezzotint {
namespace {

StudyPoint point(const std::string& method, double seconds, double error) {
  StudyPoint made{"gaussian", 0.3, 0.0, method};
  made.seconds = seconds;
  made.error = error;
  return made;
}

TEST(StudyFront, HoldsWhatNothingBeatsInBothTimeAndError) {
  std::vector<StudyPoint> points = {point("a", 1.0, 0.1), point("b", 2.0, 0.2), point("c", 3.0, 0.01),
                                    point("auto", 0.5, 0.001)};
  points.push_back(point("d", 0.1, 0.001));
  points.back().theta_deg = 30.0;  // another scene
  mark_pareto_front(points);
  EXPECT_TRUE(points[0].on_front);
  EXPECT_FALSE(points[1].on_front);
  EXPECT_TRUE(points[2].on_front);
  EXPECT_FALSE(points[3].on_front);  // drawn on the front, no part of it
  EXPECT_TRUE(points[4].on_front);
}

TEST(StudyRelief, HasTheGradientThatItIsAskedFor) {
  for (const std::string& family : study_families()) {
    const StudyRelief relief = make_study_relief(family, 0.3, 128);
    const SlopeCovariance slopes = slope_covariance(relief.field);
    EXPECT_NEAR(std::sqrt(slopes.xx + slopes.yy), 0.3, 1e-4) << family;
    EXPECT_TRUE(relief.field.periodic());
  }
  EXPECT_THROW((void)make_study_relief("waves", 0.3, 128), InvalidInput);
}

TEST(Study, MeasuresEveryMethodAndDrawsIt) {
  StudyOptions options;
  options.gradients = {0.1};
  options.thetas_deg = {30.0};
  options.cells = 64;
  options.resolution = 16;
  const auto points = run_study(options, {});
  for (const char* method : {"slides plain", "paths, strata", "paths, splat corrected", "slopes", "moments", "auto"}) {
    EXPECT_TRUE(std::any_of(points.begin(), points.end(), [&](const auto& p) { return p.method == method; })) << method;
  }
  for (const StudyPoint& made : points) {
    EXPECT_GT(made.seconds, 0.0);
    EXPECT_LT(made.error, 10.0) << made.method;
  }
  const std::string svg = study_svg(options, points, "gaussian");
  EXPECT_NE(svg.find("</svg>"), std::string::npos);
}

}  // namespace
}  // namespace mezzotint
