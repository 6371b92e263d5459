#include "inverse/gamut/gamut_map.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "forward/base/error.h"
#include "forward/base/random.h"

namespace mezzotint {
namespace {

GamutMap map_of(const GamutMapOptions& options, const PrinterProfile& printer) {
  std::vector<std::vector<double>> results;
  for (std::size_t i = 0; i < gamut_task_count(options); ++i) results.push_back(run_gamut_task(options, printer, i));
  return assemble_gamut(options, printer, results);
}

GamutMapOptions small(const std::string& kind) {
  return {.kinds = {kind}, .blur_factors = {1.0, 1.3}, .rays = 4, .edge_heights = 3, .patch = {96, 3, 2, 1}};
}

// Whether a border's points say that a pattern with these slopes can be had, by a line between neighbours in
// logarithms; `slack` is relative.
bool is_enclosed(const GamutRegion& region, const AlphaPair& alpha, double slack) {
  const auto ground = 0.5 * region.floor_alpha * region.floor_alpha;
  const double ratio = std::sqrt((0.5 * alpha.y * alpha.y - ground) / (0.5 * alpha.x * alpha.x - ground));
  for (std::size_t k = 1; k < region.steepest.size(); ++k) {
    const auto ratio_of = [ground](const AlphaPair& a) {
      return std::sqrt((0.5 * a.y * a.y - ground) / (0.5 * a.x * a.x - ground));
    };
    const AlphaPair &low = region.steepest[k - 1].alpha, &high = region.steepest[k].alpha;
    if (ratio > ratio_of(high) && k + 1 < region.steepest.size()) continue;
    const double share = std::log(ratio / ratio_of(low)) / std::log(ratio_of(high) / ratio_of(low));
    const double border = low.x * std::pow(high.x / low.x, std::clamp(share, 0.0, 1.0));
    return alpha.x <= border * (1.0 + slack);
  }
  return false;
}

// 400 prints drawn over all of the room: none beyond the border by more than its tolerance and what four rays leave.
TEST(GamutMap, NoPrintOfASinusoidLiesBeyondTheBorder) {
  const PrinterProfile printer;
  const GamutMapOptions options = small("sinusoid");
  const GamutRegion region = map_of(options, printer).regions.front();
  const GamutKind kind = gamut_kind("sinusoid", printer);
  const SlopePrint print(printer, {64, 3, 1, 77});
  const double ground = 0.5 * region.floor_alpha * region.floor_alpha;
  double closest = 0.0;
  for (std::uint64_t i = 0; i < 400; ++i) {
    const auto u = RandomStream(3, RandomPurpose::GamutTarget).uniform4(i);
    std::vector<double> values;
    for (std::size_t k = 0; k < 2; ++k)
      values.push_back(kind.free[k].low * std::pow(kind.free[k].high / kind.free[k].low, 0.5 * u.at(k)));
    values.push_back(kind.free[2].high * (0.7 + 0.3 * u[2]));
    const AxisSquares s = print.squares(pattern_of(kind, values, printer)).mean;
    const AlphaPair alpha{std::sqrt(2.0 * (std::max(s.u, s.v) + ground)),
                          std::sqrt(2.0 * (std::min(s.u, s.v) + ground))};
    EXPECT_TRUE(is_enclosed(region, alpha, 0.04)) << alpha.x << ", " << alpha.y;
    closest = std::max(closest, alpha.x / region.steepest.front().alpha.x);
  }
  EXPECT_GT(closest, 0.9) << "the draws did not come near the border";
}

TEST(GamutMap, MoreBlurReachesLess) {
  const GamutMap map = map_of(small("sinusoid"), PrinterProfile{});
  ASSERT_EQ(map.regions.size(), 2U);
  ASSERT_EQ(map.regions[0].steepest.size(), 4U);
  for (std::size_t k = 0; k < 4; ++k)
    EXPECT_LT(map.regions[1].steepest[k].alpha.x, 0.95 * map.regions[0].steepest[k].alpha.x);
  EXPECT_LT(map.regions[0].largest_tolerance(), 0.05);
}

TEST(GamutMap, RidgesAreALineAlongTheFloor) {
  const GamutMap map = map_of(small("ridges"), PrinterProfile{});
  const GamutRegion& region = map.regions.front();
  ASSERT_EQ(region.steepest.size(), 1U);
  for (const AlphaPair& alpha : region.outline()) EXPECT_NEAR(alpha.y, region.floor_alpha, 1e-5);
  EXPECT_GT(region.steepest.front().alpha.x, 0.9);
}

// What judge says agrees with the map, a little inside and a little outside of its border.
TEST(GamutMap, JudgeAgreesOnBothSidesOfTheBorder) {
  const PrinterProfile printer;
  const GamutRegion region = map_of(small("sinusoid"), printer).regions.front();
  for (const BorderPoint& point : region.steepest) {
    const double ground = 0.5 * region.floor_alpha * region.floor_alpha;
    const auto scaled = [&](double factor) {
      const auto of = [&](double alpha) {
        return std::sqrt(2.0 * (factor * factor * (0.5 * alpha * alpha - ground) + ground));
      };
      return beckmann_target({of(point.alpha.x), of(std::min(point.alpha.y, point.alpha.x)), Angle{}});
    };
    EXPECT_NE(judge(scaled(0.94), printer, "sinusoid").place, GamutPlace::Outside) << point.alpha.x;
    EXPECT_EQ(judge(scaled(1.12), printer, "sinusoid").place, GamutPlace::Outside) << point.alpha.x;
  }
}

TEST(GamutMap, RefusesWhatMakesNoSense) {
  EXPECT_THROW((void)gamut_task_count({.kinds = {}}), InvalidInput);
  EXPECT_THROW((void)gamut_task_count({.rays = 1}), InvalidInput);
  EXPECT_THROW((void)run_gamut_task(small("ridges"), PrinterProfile{}, 1000), InvalidInput);
  EXPECT_THROW((void)assemble_gamut(small("ridges"), PrinterProfile{}, {}), InvalidInput);
}

}  // namespace
}  // namespace mezzotint
