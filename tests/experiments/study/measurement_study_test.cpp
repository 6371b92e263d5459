#include "experiments/study/measurement_study.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "experiments/study/measurement_comparisons.h"
#include "experiments/study/study_methods.h"
#include "forward/base/error.h"
#include "measurement/correction/fill.h"
#include "measurement/correction/gaussian_filter.h"
#include "measurement/correction/plane.h"
#include "tests/measurement/relief.h"

namespace mezzotint {
namespace {

HeightField smooth_noise(std::size_t side) {
  return s_filter(test::white_noise(test::micrometre_grid(side, side), 5), 8.0_um);
}

HeightField with_a_hole(HeightField field) {
  for (std::size_t row = 20; row < 32; ++row)
    for (std::size_t column = 20; column < 32; ++column) field.at(column, row) = test::missing;
  return field;
}

double largest_difference(const HeightField& a, const HeightField& b, std::size_t rim = 0) {
  double largest = 0.0;
  for (std::size_t row = rim; row + rim < a.rows(); ++row)
    for (std::size_t column = rim; column + rim < a.columns(); ++column)
      largest = std::max(largest, std::abs(double{a.at(column, row)} - double{b.at(column, row)}));
  return largest;
}

TEST(MeasurementComparisons, RelaxTowardsTheSolution) {
  const HeightField holed = with_a_hole(smooth_noise(64));
  const HeightField solved = fill_missing(holed);
  const double none = largest_difference(fill_by_relaxation(holed, 0), solved);
  const double some = largest_difference(fill_by_relaxation(holed, 30), solved);
  EXPECT_EQ(largest_difference(fill_by_relaxation(holed, 0), fill_by_plane(holed)), 0.0);
  EXPECT_LT(some, 0.5 * none);
  // A sweep leaves cos²(π/13) = 0.94 of the slowest error in a hole of 12 samples; 1000 leave rounding.
  EXPECT_LT(largest_difference(fill_by_relaxation(holed, 1000), solved), 1e-5);
}

TEST(MeasurementComparisons, FillATiltedPlaneByItself) {
  const HeightField plane =
      test::field_of(test::micrometre_grid(64, 64), [](double x, double y) { return x - 2.0 * y; });
  EXPECT_LT(largest_difference(fill_by_plane(with_a_hole(plane)), plane), 1e-4);  // floats of 100 µm
}

TEST(MeasurementComparisons, SmoothAsTheFilterDoesAwayFromTheEnds) {
  const HeightField field = smooth_noise(96);
  const HeightField filtered = s_filter(field, 10.0_um);
  EXPECT_LT(largest_difference(smooth_by_sums(field, 10.0_um, 1.2), filtered, 12), 1e-6);
  EXPECT_LT(largest_difference(smooth_wrapped(field, 10.0_um), filtered, 12), 1e-6);
  EXPECT_GT(largest_difference(smooth_by_sums(field, 10.0_um, 0.3), filtered, 12), 1e-3);
  EXPECT_GT(largest_difference(smooth_wrapped(field, 10.0_um), filtered), 1e-2);
}

TEST(MeasurementComparisons, EstimateTheSameSq) {
  const HeightField field = smooth_noise(128);
  const double sq = root_mean_square_height(field).um();
  EXPECT_NEAR(sq_of_every(field, 1), sq, 1e-9);
  EXPECT_NEAR(sq_of_rows(field, 128), sq, 1e-9);
  // Of 4096 independent draws: 1/√8192 of Sq, five times.
  EXPECT_NEAR(sq_of_random(field, 4096, 1), sq, 0.06 * sq);
}

TEST(MeasurementStudy, DrawsEveryMethodOfEveryQuestion) {
  const MeasurementStudyOptions options{.cells = 64, .fields = 2};
  const auto panels = run_measurement_study(options, {});
  EXPECT_EQ(panels.size(), 12U);
  for (const MeasurementPanel& panel : panels) {
    for (const std::string& method : methods_for(panel.question)) {
      EXPECT_NE(style_of(method).colour, nullptr);
      EXPECT_TRUE(std::ranges::any_of(panel.points, [&](const ChartPoint& point) { return point.method == method; }))
          << method;
    }
    EXPECT_TRUE(std::ranges::any_of(panel.points, [](const ChartPoint& point) { return point.on_front; }));
    for (const ChartPoint& point : panel.points) {
      EXPECT_GT(point.seconds, 0.0);
      EXPECT_LT(point.error, 3.0) << point.method;
      EXPECT_EQ(point.error == 0.0, point.method == "all samples");
    }
  }
  for (const MeasurementQuestion question : measurement_questions())
    EXPECT_NE(measurement_svg(options, panels, question).find("</svg>"), std::string::npos);
  EXPECT_THROW((void)run_measurement_study({.cells = 32}, {}), InvalidInput);
}

}  // namespace
}  // namespace mezzotint
