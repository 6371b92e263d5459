#include "inverse/design/lobe_goal.h"

#include <cmath>

#include <gtest/gtest.h>

#include "forward/base/error.h"
#include "forward/base/random.h"
#include "inverse/design/design.h"

namespace mezzotint {
namespace {

constexpr DirectionGrid grid{24, 24};
const std::vector<DirectionAngles> light = {{20.0_deg, 0.0_deg}, {20.0_deg, 90.0_deg}};

HeightField rough_scan() {
  return synthesize(Noise{.scale = 60.0_um, .stretch = 1.8, .direction = 25.0_deg, .height = 10.0_um, .seed = 3},
                    {300, 300, 3.0_um, 3.0_um});
}

TEST(LobeGoal, IsReachedByTheSurfaceThatItCameFrom) {
  const LobeGoal goal = lobe_goal_of(rough_scan(), Mirror{}, light, grid);
  EXPECT_NEAR(cube_root_error({goal.maps}, goal).value, 0.0, 1e-12);
}

TEST(LobeGoal, ErrorOfALobeTwiceAsBrightIsThatOfItsCubeRoot) {
  const LobeGoal goal = lobe_goal_of(rough_scan(), Mirror{}, light, grid);
  auto brighter = goal.maps;
  for (auto& map : brighter) {
    for (double& value : map) value *= 2.0;
  }
  EXPECT_NEAR(cube_root_error({brighter}, goal).value, std::cbrt(2.0) - 1.0, 1e-12);
}

TEST(LobeGoal, StandardErrorIsThatOfIndependentDraws) {
  const LobeGoal goal = lobe_goal_of(rough_scan(), Mirror{}, light, grid);
  const RandomStream stream(5, RandomPurpose::Test);
  // Draws whose brightness scatters by 10 %: the error of the mean of 64 is that of ∛(2·(1 ± 0.1/8)) − 1.
  std::vector<std::vector<DirectionMap>> draws(64, goal.maps);
  for (std::size_t i = 0; i < draws.size(); ++i) {
    const double brightness = 2.0 * (1.0 + 0.1 * stream.normal4(i)[0]);
    for (auto& map : draws[i]) {
      for (double& value : map) value *= brightness;
    }
  }
  const double expected = std::cbrt(2.0) / 3.0 * 0.1 / 8.0;
  // A standard error from 64 draws scatters by 1/√(2·63) = 9 %; four of that.
  EXPECT_NEAR(cube_root_error(draws, goal).standard_error, expected, 0.36 * expected);
}

TEST(LobeGoal, LeadsASearchToTheTextureOfAScan) {
  DesignProblem problem;
  const HeightField scan = rough_scan();
  problem.target = scan_target(scan);
  // The scan is one patch of 0.9 mm, the print four of 0.7 mm. Its true parameters themselves measure 0.11 then
  // (0.09 … 0.12 over 12 sets of four draws), so 0.15 is that and a search's own error.
  problem.target.tolerance = 0.15;
  problem.pattern = Noise{.height = 12.0_um};
  problem.free = {{"scale_um", 31.0, 300.0, {}}, {"stretch", 1.0, 6.0, {}}, {"direction_deg", -90.0, 90.0, {}}};
  problem.patch = {.pixels = 96, .subsamples = 3};
  problem.search_draws = 4;
  problem.fresh_draws = 4;
  problem.search.max_evaluations = 40;
  problem.lobe = lobe_goal_of(scan, Mirror{}, light, grid);
  const Design design = find_design(problem);
  ASSERT_TRUE(design.fresh_lobe_error);
  EXPECT_TRUE(design.met) << design.fresh_lobe_error->value << " ± " << design.fresh_lobe_error->standard_error;
  // The scan is a noise itself, so matching its lobe matches its slopes; four patches of 0.7 mm scatter by some 5 %.
  EXPECT_NEAR(design.on_fresh_draws.axes.rms_major / problem.target.slopes.rms_major, 1.0, 0.15);
  EXPECT_LT(axis_difference(design.on_fresh_draws.axes.rotation, problem.target.slopes.rotation).degrees(), 10.0);
}

TEST(LobeGoal, RefusesALobeWithoutLight) {
  EXPECT_THROW((void)lobe_goal_of(rough_scan(), Mirror{}, {}, grid), InvalidInput);
}

}  // namespace
}  // namespace mezzotint
