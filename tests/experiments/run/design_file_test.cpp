#include "experiments/run/design_file.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

namespace mezzotint {
namespace {

Design some_design() {
  Design design{.pattern = Noise{.scale = 61.7_um, .stretch = 1.0 / 3.0 + 1.0, .direction = 31.1_deg, .seed = 77}};
  design.variables = {{"scale_um", 30.2, 400.0, 90.1, true}};
  design.search = {.values = {61.7}, .objective = 1e-17, .lowered = {{Measure::CubeRoot, 0.7}}, .cost = 1.25};
  design.search.history = {{"moments", {{90.1}, 0.1 + 0.2}, 1.0}, {"scan", {{61.7}, std::nan("")}, 0.25}};
  design.search.outcome = "converged";
  design.distances = {{Measure::Wasserstein, 0.1, 1.0 / 3.0, {0.2, std::nan("")}, 1e-9}};
  design.fresh_covariances = {{0.1, 0.2, 0.3}, {0.4, 0.5, -0.6}};
  design.fresh_seeds = {1500, 1501};
  design.warnings = {"µm \"quoted\""};
  return design;
}

TEST(DesignFile, GiveBackADesignBitForBit) {
  const Design design = some_design();
  const auto text = to_json(design).dump();
  const Design read = design_from_json(nlohmann::ordered_json::parse(text));
  EXPECT_EQ(to_json(read).dump(), text);
  EXPECT_EQ(std::get<Noise>(read.pattern).stretch, std::get<Noise>(design.pattern).stretch);
  EXPECT_EQ(read.search.history[0].step.objective, 0.1 + 0.2);
  EXPECT_TRUE(std::isnan(read.search.history[1].step.objective));
  EXPECT_EQ(read.fresh_covariances[1].xy, -0.6);
}

TEST(DesignFile, GiveBackEveryPatternThatCanBeSearched) {
  LineIntegralConvolution lines{.length = 123.4_um, .seed = 5, .hash = CellHash::Slides};
  lines.singularities = {{{1.5_um, -2.5_um}, -0.5}, {{}, 1.0}};
  const FractionalBrownianMotion motion{.hurst = 0.3, .octaves = 7, .seed = 6};
  PatternRegions regions{
      .pixel = 20.0_um, .columns = 2, .rows = 3, .labels = {7, 7, 7, 200, 200, 7}, .source = "a.png"};
  regions.parts = {{motion, 7}, {Ridges{}, 200}};
  const Pattern turned = TurnedPattern{25.0_deg, {3.0_um, 4.0_um}, {{lines}}};
  for (const Pattern& pattern :
       {Pattern{motion}, Pattern{Turbulence{.octaves = 2}}, Pattern{lines}, Pattern{Sinusoid{}}, Pattern{Ridges{}},
        Pattern{PatternSum{{{turned}, {regions}}}}, Pattern{PatternProduct{9.0_um, {{motion}, {Ridges{}}}}},
        Pattern{MaskedPattern{.softness = 0.3, .parts = {{motion}, {Ridges{}}, {Noise{}}}}}}) {
    Design design = some_design();
    design.pattern = pattern;
    const Design read = design_from_json(nlohmann::ordered_json::parse(to_json(design).dump()));
    const Grid grid{24, 24, 5.0_um, 5.0_um};
    const HeightField before = synthesize(design.pattern, grid), after = synthesize(read.pattern, grid);
    EXPECT_TRUE(std::ranges::equal(before.heights_um(), after.heights_um())) << kind_name(pattern);
  }
}

TEST(DesignFile, GiveBackATargetBitForBit) {
  const Target target = beckmann_target({0.25, 0.1, 30.0_deg});
  const auto json = to_json(target);
  EXPECT_EQ(to_json(target_from_json(nlohmann::ordered_json::parse(json.dump()))).dump(), json.dump());
}

}  // namespace
}  // namespace mezzotint
