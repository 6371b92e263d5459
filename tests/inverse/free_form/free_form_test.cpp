#include "inverse/free_form/free_form.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "forward/base/error.h"

namespace mezzotint {
namespace {

constexpr DirectionGrid bins{32, 32};
const std::vector<DirectionAngles> light = {{10.0_deg, 30.0_deg}};

// A soft-edged square of directions about the mirror direction: no family of patterns has such a lobe.
double square_lobe(const Direction& out) {
  const Direction mirror = to_direction(light.front());
  const auto inside = [](double x) { return 1.0 / (1.0 + std::exp((std::abs(x) - 0.18) / 0.02)); };
  return inside(out.x() + mirror.x()) * inside(out.y() + mirror.y());
}

LobeTarget square_goal() {
  return lobe_target(bins, Dielectric{1.5}, light, {average_over_bins(bins, square_lobe, 8)}, true);
}

FreeFormOptions small() {
  return {.pixels = 48, .start_evaluations = 10, .evaluations = 60, .evaluations_per_epoch = 20};
}

double fresh(const FreeForm& form, LobeDistance kind) {
  return std::ranges::find(form.fresh, kind, &FreshDistance::distance)->value;
}

TEST(FreeForm, FindsALobeThatNoPatternHas) {
  const FreeForm form = find_free_form(square_goal(), {}, small());
  // 0.026 on places and grounds that it never met.
  EXPECT_LT(std::sqrt(fresh(form, LobeDistance::CubeRoot)), 0.04);
  EXPECT_LT(std::sqrt(form.on_search_draws), std::sqrt(fresh(form, LobeDistance::CubeRoot)));
  EXPECT_EQ(form.gray.columns, 48U);
  for (const float gray : form.gray.values) {
    const float level = 255.0F * gray;
    ASSERT_NEAR(level, std::round(level), 1e-4) << "not one of the printer's levels";
  }
}

TEST(FreeForm, GivesTheSameBitsWithAnyNumberOfThreads) {
  FreeFormOptions options = small();
  options.start_evaluations = 3;
  options.evaluations = 6;
  options.evaluations_per_epoch = 3;
  const FreeForm many = find_free_form(square_goal(), {}, options);
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  EXPECT_EQ(find_free_form(square_goal(), {}, options).gray.values, many.gray.values);
}

TEST(FreeForm, AGoalOfAnyBrightnessHasTheLightOfAFlatSurface) {
  const DirectionMap map = average_over_bins(bins, square_lobe, 8);
  const LobeTarget goal = lobe_target(bins, Dielectric{1.5}, light, {map}, true);
  double sum = 0.0;
  for (std::size_t k = 0; k < map.size(); ++k) sum += goal.grid.areas()[k] * goal.maps.front()[k];
  EXPECT_NEAR(sum, reflectance(Dielectric{1.5}, std::cos(light.front().theta.radians())), 1e-12);
}

TEST(FreeForm, RefusesWhatIsNoGoal) {
  EXPECT_THROW((void)lobe_target(bins, Mirror{}, light, {DirectionMap(bins.size(), 0.0)}, true), InvalidInput);
  EXPECT_THROW((void)lobe_target(bins, Mirror{}, light, {}, true), InvalidInput);
  FreeFormOptions options = small();
  options.pixels = 4;
  EXPECT_THROW((void)find_free_form(square_goal(), {}, options), InvalidInput);
  options = small();
  options.algorithm = "LN_BOBYQA";
  EXPECT_THROW((void)find_free_form(square_goal(), {}, options), InvalidInput);
}

}  // namespace
}  // namespace mezzotint
