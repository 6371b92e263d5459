#include "experiments/study/study.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "experiments/study/label_places.h"
#include "experiments/study/scene.h"
#include "experiments/study/study_methods.h"
#include "experiments/study/study_svg.h"
#include "forward/base/error.h"
#include "forward/surface/slope_covariance.h"

namespace mezzotint {
namespace {

StudyPoint point(const std::string& method, double seconds, double error) {
  StudyPoint made{{method}, {"gaussian", 0.3, 0.0}};
  made.seconds = seconds;
  made.error = error;
  return made;
}

TEST(StudyFront, HoldsWhatNothingBeatsInBothTimeAndError) {
  std::vector<StudyPoint> points = {point("a", 1.0, 0.1), point("b", 2.0, 0.2), point("c", 3.0, 0.01),
                                    point("auto", 0.5, 0.001)};
  points.push_back(point("d", 0.1, 0.001));
  points.back().scene.theta_deg = 30.0;  // another scene
  mark_pareto_front(points);
  EXPECT_TRUE(points[0].on_front);
  EXPECT_FALSE(points[1].on_front);
  EXPECT_TRUE(points[2].on_front);
  EXPECT_FALSE(points[3].on_front);  // drawn on the front, no part of it
  EXPECT_TRUE(points[4].on_front);
}

TEST(StudyFront, TakesErrorsBelowTheNoiseOfTheReferenceForEqual) {
  std::vector<StudyPoint> points = {point("a", 1.0, 0.002), point("b", 2.0, 0.001)};
  for (StudyPoint& made : points) made.floor = 0.003;
  mark_pareto_front(points);
  EXPECT_TRUE(points[0].on_front);
  EXPECT_FALSE(points[1].on_front);
}

TEST(StudyRelief, HasTheGradientThatItIsAskedFor) {
  for (const std::string& family : relief_families()) {
    const StudyRelief relief = make_study_relief(family, 0.3, {.cells = 128});
    const SlopeCovariance slopes = slope_covariance(relief.field);
    EXPECT_NEAR(std::sqrt(slopes.xx + slopes.yy), 0.3, 1e-4) << family;  // float heights
    EXPECT_EQ(relief.field.periodic(), family != "patch");
  }
  EXPECT_THROW((void)make_study_relief("waves", 0.3, {.cells = 128}), InvalidInput);
  EXPECT_THROW((void)make_study_relief("gaussian", 0.3, {.cells = 32}), InvalidInput);
}

TEST(StudyRelief, OfAPeriodicFamilyHasNoSeam) {
  for (const char* family : {"gaussian", "noise", "sinusoid", "bumps", "folds", "plateaus"}) {
    const HeightField field = draw_relief(family, {.cells = 128, .seed = 5, .periods = 4.0});
    double inside = 0.0, seam = 0.0;
    for (std::size_t row = 0; row < field.rows(); ++row) {
      for (std::size_t column = 1; column < field.columns(); ++column)
        inside = std::max(inside, std::abs(double{field.at(column, row)} - field.at(column - 1, row)));
      seam = std::max(seam, std::abs(double{field.at(0, row)} - field.at(field.columns() - 1, row)));
    }
    // One column's largest step against that of 127: it is larger by chance in one of 128.
    EXPECT_LE(seam, 1.5 * inside) << family;
  }
}

TEST(StudyRelief, OfAScanIsTheWholeLevelledMirroredPatch) {
  const StudyRelief scan = scan_relief(virtual_scan(128));
  EXPECT_EQ(scan.field.missing_count(), 0U);
  EXPECT_FALSE(scan.field.periodic());
  // Half of the relief's own slopes survive the instrument's pixels at this few cells; its noise adds 0.02.
  EXPECT_GT(scan.gradient, 0.1);
  EXPECT_LT(scan.gradient, 0.4);
}

TEST(StudyRelief, IsTheSameOnACoarserMesh) {
  const HeightField field = draw_relief("gaussian", {.cells = 128});
  const HeightField quarter = coarser(field, 4);
  EXPECT_EQ(quarter.columns(), 32U);
  EXPECT_EQ(quarter.grid().pitch_x.um(), 4.0);
  EXPECT_EQ(quarter.at(3, 5), field.at(12, 20));
}

TEST(LabelPlaces, KeepTheirOrderAndTheirDistance) {
  const std::vector<double> places = label_places({99.0, 10.0, 98.0, 11.0}, 12.0, 100.0);
  EXPECT_EQ(places, (std::vector<double>{100.0, 10.0, 88.0, 22.0}));
}

TEST(StudyMethods, AreAllDrawnAndAllAnswerAQuestion) {
  for (const PathMethod& method : path_methods()) {
    EXPECT_NE(style_of(method.name).colour, nullptr);
    const bool asked = std::any_of(study_questions().begin(), study_questions().end(), [&](StudyQuestion question) {
      const auto& methods = methods_for(question);
      return std::find(methods.begin(), methods.end(), method.name) != methods.end();
    });
    EXPECT_TRUE(asked || method.name == plain_method) << method.name;
  }
}

StudyOptions small_study() {
  StudyOptions options;
  options.families = {"gaussian"};
  options.gradients = {0.1};
  options.thetas_deg = {30.0};
  options.scan = scan_relief(virtual_scan(64));
  options.cells = 64;
  options.resolution = 16;
  options.reference_samples = 1U << 17;
  options.most_samples = 1U << 14;
  return options;
}

TEST(Study, MeasuresEveryMethodOnEverySceneAndDrawsIt) {
  const StudyOptions options = small_study();
  const auto points = run_study(options, {});
  for (const StudyScene& scene : scenes_of(options)) {
    std::vector<std::string> methods = {moments_method, auto_method};
    if (scene.relief != "scan") methods.emplace_back(slopes_method);
    for (const PathMethod& method : path_methods())
      if (scene.relief != "scan" || !method.needs_splat) methods.push_back(method.name);
    for (const std::string& method : methods) {
      EXPECT_TRUE(std::any_of(points.begin(), points.end(),
                              [&](const auto& p) { return p.scene == scene && p.method == method; }))
          << method << " on " << scene.relief;
    }
  }
  for (const StudyPoint& made : points) {
    EXPECT_GT(made.seconds, 0.0);
    EXPECT_LT(made.error, 10.0) << made.method;
    EXPECT_GT(made.floor, 0.0);
  }
  EXPECT_NE(study_svg(options, points, "gaussian").find("</svg>"), std::string::npos);
  EXPECT_NE(study_choices_svg(options, points).find("scan: bounce cap"), std::string::npos);
  // What is left of an unbiased run when both noises are taken out is none, within three of its standard errors.
  for (const StudyPoint& made : points) {
    if (made.method != "paths, beam") continue;
    EXPECT_GT(made.error, 0.0);
    EXPECT_LE(made.bias, 3.0 * made.bias_error) << made.scene.relief << " " << made.samples;
  }
}

}  // namespace
}  // namespace mezzotint
