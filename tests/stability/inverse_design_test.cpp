#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <numbers>

#include "forward/optics/microfacet.h"
#include "inverse/design/design.h"
#include "inverse/gamut/gamut.h"
#include "inverse/target/implied_slopes.h"
#include "tests/stability/scene.h"

namespace mezzotint {
namespace {

using test::percent;

constexpr const char* theme = "Inverse design";
constexpr double pixel_um = 7.54;

/// The sentence with these words in it; empty where there is none.
std::string warned(const Design& design, const std::string& words) {
  for (const std::string& sentence : design.warnings)
    if (sentence.find(words) != std::string::npos) return sentence;
  return "";
}

DesignProblem waves() {
  DesignProblem problem;
  problem.target = beckmann_target({0.20, 0.10, 40.0_deg});
  problem.pattern = Sinusoid{.height = 14.0_um};
  problem.free = {
      {"wavelength_u_um", 30.2, 600.0, {}}, {"wavelength_v_um", 30.2, 600.0, {}}, {"direction_deg", -90.0, 90.0, {}}};
  problem.patch = {.pixels = 64, .subsamples = 2};
  problem.search_draws = 4;
  problem.fresh_draws = 4;
  problem.search.max_evaluations = 80;
  return problem;
}

LobeTarget lobes_of(const MicrofacetLobe& lobe, std::size_t bins, Angle theta) {
  const DirectionGrid grid{bins, bins};
  const Material glass = Dielectric{1.5};
  const std::vector<DirectionAngles> light = {{theta, Angle{}}};
  return lobe_target(grid, glass, light, {reflection_map(lobe, glass, light.front(), grid)}, false);
}

std::pair<double, double> range_of(const Design& design, const std::string& stage) {
  double low = HUGE_VAL, high = -HUGE_VAL;
  for (const DesignStep& step : design.search.history) {
    if (step.stage != stage) continue;
    low = std::min(low, step.step.objective);
    high = std::max(high, step.step.objective);
  }
  return {low, high};
}

TEST(Design, OfAParameterThatDoesNotShowSaysSo) {
  DesignProblem problem = waves();
  problem.pattern = PatternSum{{{Sinusoid{.height = 14.0_um}}, {Ridges{.wavelength = 90.0_um, .height = 0.001_um}}}};
  problem.free = {{"parts[1].direction_deg", -90.0, 90.0, {}}};
  const Design design = find_design(problem);
  const auto [low, high] = range_of(design, "scan");
  const std::string told = warned(design, "same wherever the search looked");
  EXPECT_FALSE(told.empty());
  EXPECT_FALSE(design.met);
  ASSERT_EQ(design.intervals.combinations.size(), 1U);
  EXPECT_FALSE(design.intervals.combinations[0].determined);
  EXPECT_TRUE(warned(find_design(waves()), "same wherever").empty());
  test::record({theme, "`mezzotint design`", "only the direction of ridges of 1 nm is free, beside waves of 14 µm",
                fmt::format("Over the whole box the objective changes by {} of itself. BOBYQA converges all the same, "
                            "and the direction's interval is ± {:.0f} rad: a null direction.",
                            test::below((high - low) / high), design.intervals.combinations[0].half_width_95),
                "The scan of the whole box changes by less than a thousandth; the intervals.", told});
}

TEST(Design, OfATargetUnderTheGroundIsCalledUnreachable) {
  DesignProblem problem = waves();
  problem.target = beckmann_target({0.004, 0.004, 0.0_deg});
  const GamutVerdict verdict = judge(problem.target, problem.printer, "sinusoid");
  EXPECT_EQ(verdict.place, GamutPlace::Outside);
  EXPECT_TRUE(verdict.by_formula);
  const Design design = find_design(problem);
  EXPECT_FALSE(design.met);
  EXPECT_FALSE(warned(design, "stands at its bound").empty());
  test::record({theme, "`mezzotint design`", "a target of α = 0.004, smoother than the printer's ground",
                fmt::format("The search runs into the bounds: α = {:.3f} on fresh draws with the longest waves, where "
                            "the ground alone has {:.4f}.",
                            std::numbers::sqrt2 * design.on_fresh_draws.axes.rms_major, verdict.nearest.x),
                "`judge` knows by a formula, before any search; the search says which bounds it hit.", verdict.why});
}

TEST(Design, WhereAModelFailsInAPartOfTheBoxGoesOnWithoutIt) {
  DesignProblem problem = waves();
  problem.pattern = LineIntegralConvolution{.height = 14.0_um};
  problem.target = beckmann_target({0.6, 0.05, 40.0_deg});
  problem.free = {{"scale_um", 0.5, 200.0, 60.0}, {"length_um", 20.0, 100.0, 60.0}, {"direction_deg", -90.0, 90.0, {}}};
  problem.patch.pixels = 48;
  problem.search_draws = 3;
  problem.search.max_evaluations = 15;
  const Design design = find_design(problem);
  const auto& steps = design.search.history;
  const auto failed =
      std::ranges::count_if(steps, [](const DesignStep& s) { return !std::isfinite(s.step.objective); });
  EXPECT_GT(failed, 0);
  EXPECT_TRUE(std::isfinite(design.search.objective));
  const std::string told = warned(design, "evaluations failed");
  EXPECT_FALSE(told.empty());
  test::record({theme, "`mezzotint design`", "lines of a box whose finest scales ask for more than 2^17 cells of noise",
                fmt::format("{} of {} evaluations fail. The others go on, and the best of them is judged.", failed,
                            steps.size()),
                "An error in the model, or an objective that is no number, counts as worse than everything.", told});

  problem = waves();
  problem.objective = {{Measure::SlopeCovariance, std::numeric_limits<double>::quiet_NaN()}};
  EXPECT_NE(test::refusal([&] { (void)find_design(problem); }).find("must be finite and positive"), std::string::npos);
}

TEST(Design, ThatIsStoppedLosesNoEvaluation) {
  const DesignProblem whole = waves();
  const Design expected = find_design(whole);
  DesignProblem stopped = whole;
  stopped.log = std::filesystem::temp_directory_path() / "mezzotint_where_designs_fail.jsonl";
  std::filesystem::remove(stopped.log);
  int evaluations = 0;
  const auto stop = [&](const ProgressEvent& event) {
    if (event.stage == "search" && ++evaluations == 3) throw Interrupted();
  };
  EXPECT_THROW((void)find_design(stopped, stop), Interrupted);
  const std::size_t kept = EvaluationLog(stopped.log, "").found();
  EXPECT_EQ(kept, 2U);
  const Design resumed = find_design(stopped);
  EXPECT_EQ(resumed.search.values, expected.search.values);
  EXPECT_EQ(resumed.search.history.size(), expected.search.history.size());
  EXPECT_EQ(resumed.fresh_error.variance_major, expected.fresh_error.variance_major);
  std::filesystem::remove(stopped.log);
  test::record({theme, "`mezzotint design`", "Ctrl-C, or an error, in the third evaluation",
                fmt::format("{} evaluations are on disk; the same command goes on behind them and ends in the same "
                            "bits.",
                            kept),
                "Every evaluation is written before the next begins.", "—"});
}

TEST(Design, FromAStartTurnedBy90IsLostWithoutAScan) {
  DesignProblem problem = waves();
  problem.free = {{"wavelength_u_um", 60.0, 250.0, 155.0},
                  {"wavelength_v_um", 200.0, 600.0, 311.0},
                  {"direction_deg", -90.0, 90.0, -55.0}};
  const std::vector<Variable> variables = search_variables(problem);
  const SlopeModel model(problem.printer, problem.patch, search_seeds(problem), {});
  const auto distance = [&](const std::vector<double>& values) {
    return covariance_distance(model.shown(with_values(problem.pattern, variables, values)).covariance, problem.target);
  };
  const MinimizeResult plain = minimize(variables, distance, {.max_evaluations = 120});
  const Design ladder = find_design(problem);
  EXPECT_GT(plain.best.objective, 0.1);
  EXPECT_TRUE(plain.converged);
  EXPECT_LT(ladder.search.objective, 1e-3);
  EXPECT_TRUE(ladder.met);
  test::record(
      {theme, "a local search by itself", "a start 95° from the target's direction, wavelengths bounded",
       fmt::format(
           "BOBYQA alone converges to {:.0f}° (√distance {:.2f}) and calls it done: waves that turned back would "
           "first have to become worse. The ladder ends at {:.0f}° (wanted: 40°), within {:.1g}, after {:.0f} "
           "evaluations.",
           plain.best.values[2], std::sqrt(plain.best.objective), ladder.search.values[2],
           std::sqrt(ladder.search.objective), ladder.search.cost),
       "A scan of the whole box before any local search, the swap by 90° among its places.", "—"});
}

TEST(Design, WithWavelengthsOfFewPixelsAliases) {
  const SlopeModel model({}, {.pixels = 96, .subsamples = 2}, {1}, {});
  const auto spread = [&](double pixels) {
    double low = HUGE_VAL, high = 0.0, sum = 0.0;
    constexpr int steps = 10;
    for (int k = -steps; k <= steps; ++k) {
      const Length wave = Length::from_um(pixels * pixel_um * (1.0 + 0.01 * k / steps));
      const Sinusoid waves{.wavelength_u = wave, .wavelength_v = 600.0_um, .height = 14.0_um};
      const double slope = std::sqrt(model.shown(waves).covariance.xx);
      low = std::min(low, slope);
      high = std::max(high, slope);
      sum += slope;
    }
    return (high - low) / sum * (2 * steps + 1);
  };
  EXPECT_GT(spread(2.0), 0.3);
  EXPECT_LT(spread(5.0), 0.02);
  DesignProblem problem = waves();
  problem.target = beckmann_target({0.5, 0.1, 0.0_deg});
  problem.free = {{"wavelength_u_um", 15.0, 28.0, {}}, {"wavelength_v_um", 30.2, 600.0, {}}};
  const std::string told = warned(find_design(problem), "below 4");
  EXPECT_FALSE(told.empty());
  EXPECT_TRUE(warned(find_design(waves()), "below 4").empty());
  test::record({theme, "pixels", "waves of 2, 2.5, 3, 4 and 5 pixels along the grid, lengths varied by ± 1 %",
                fmt::format("The RMS slope varies by {}, {}, {}, {} and {}: what is printed is the beat of wave and "
                            "grid, and a search that wants steepness flees there.",
                            percent(spread(2.0)), percent(spread(2.5)), percent(spread(3.0)), percent(spread(4.0)),
                            percent(spread(5.0))),
                "The pattern's shortest length, in pixels. Bounds from 4 pixels on keep a search out.", told});
}

struct Overfit {
  int warned = 0;
  double ratio = 0.0, error = 0.0;
};

DesignProblem few_cells(std::size_t draws, const std::string& algorithm) {
  DesignProblem problem = waves();
  problem.pattern = Noise{.height = 16.0_um};
  problem.free = {{"scale_um", 60.0, 400.0, {}}, {"stretch", 1.0, 6.0, {}}, {"direction_deg", -90.0, 90.0, {}}};
  problem.patch.pixels = 48;
  problem.search_draws = draws;
  problem.fresh_draws = 12;
  problem.search.algorithm = algorithm;
  return problem;
}

Overfit overfit_with(std::size_t draws, const std::string& algorithm, int searches) {
  Overfit all;
  for (int seed = 1; seed <= searches; ++seed) {
    DesignProblem problem = few_cells(draws, algorithm);
    problem.search.seed = static_cast<std::uint64_t>(seed);
    const Design design = find_design(problem);
    all.warned += warned(design, "fitted its draws").empty() ? 0 : 1;
    all.ratio += design.held_out_ratio / searches;
    all.error += design.fresh_error.largest() / searches;
  }
  return all;
}

// Algorithms that take slopes see the draws themselves; the others see them freed of what each is off by.
TEST(Design, OnOneDrawLearnsItByHeart) {
  constexpr int searches = 8;
  const Overfit one = overfit_with(1, "LD_SLSQP", searches), some = overfit_with(8, "LD_SLSQP", searches),
                many = overfit_with(32, "LD_SLSQP", searches), freed = overfit_with(1, "LN_BOBYQA", searches);
  EXPECT_GE(one.warned, 5);
  EXPECT_LT(many.warned, one.warned);
  EXPECT_LT(some.ratio, one.ratio);
  EXPECT_LT(some.error, one.error);
  EXPECT_LT(freed.error, one.error);
  EXPECT_LT(freed.ratio, 1.3);
  std::string told;
  for (std::uint64_t seed = 1; told.empty() && seed <= searches; ++seed) {
    DesignProblem problem = few_cells(1, "LD_SLSQP");
    problem.search.seed = seed;
    told = warned(find_design(problem), "fitted its draws");
  }
  test::record(
      {theme, "draws of a random pattern", "noise on 48² pixels, `LD_SLSQP`, 1, 8 and 32 draws, eight searches of each",
       fmt::format(
           "All fit their own draws. On 12 fresh ones a variance is off by {}, {} and {}; held-out ÷ trained is "
           "{:.2f}, {:.2f} and {:.2f} in the mean, and the warning comes in {}, {} and {} of 8. `LN_BOBYQA`, "
           "which sees one draw freed of what it is off by: {}, ratio {:.2f}, {} warnings.",
           percent(one.error), percent(some.error), percent(many.error), one.ratio, some.ratio, many.ratio, one.warned,
           some.warned, many.warned, percent(freed.error), freed.ratio, freed.warned),
       "Draws that the search never saw; above a ratio of 1.3 it says so. It also warns where many draws were "
       "searched: "
       "the ratio itself is known from 12 fresh draws only.",
       told});
}

TEST(Design, WithoutABudgetIsTheStart) {
  DesignProblem problem = waves();
  problem.search.max_evaluations = 0;
  const Design design = find_design(problem);
  const std::string told = warned(design, "no evaluation was allowed");
  EXPECT_FALSE(told.empty());
  EXPECT_FALSE(design.search.converged);
  EXPECT_EQ(design.fresh_covariances.size(), 4U);
  test::record({theme, "`max_evaluations = 0`", "waves toward a Beckmann lobe of 0.20 and 0.10",
                fmt::format("The closed-form start is printed and judged on fresh draws like any design: variances off "
                            "by {} and {}.",
                            percent(std::abs(design.fresh_error.variance_major)),
                            percent(std::abs(design.fresh_error.variance_minor))),
                "The budget is asked first.", told});
}

TEST(Design, ThatRunsOutOfBudgetKeepsTheBestSoFar) {
  DesignProblem problem = waves();
  problem.by_light = true;
  problem.lobes = lobes_of(BeckmannLobe{0.20, 0.10, 40.0_deg}, 32, 20.0_deg);
  problem.traced = {.corrections = 0, .evaluations = 0};
  problem.traced_draws = 0;
  problem.patch.pixels = 48;
  problem.search.max_evaluations = 20;
  const Design design = find_design(problem);
  double lowest = HUGE_VAL;
  for (const DesignStep& step : design.search.history)
    if (step.stage != "moments") lowest = std::min(lowest, step.step.objective);
  EXPECT_FALSE(design.search.converged);
  EXPECT_TRUE(std::isfinite(design.search.objective));
  EXPECT_LE(design.search.objective, 1.5 * lowest);
  const std::string told = warned(design, "when the budget ended");
  EXPECT_FALSE(told.empty());
  test::record({theme, "`max_evaluations`", "20 evaluations for a lobe of which a sinusoid has not the shape",
                "They end between rungs of the ladder. The best shape so far is judged and printed.",
                "What is left is asked before each rung.", told});
}

TEST(Design, OfLightThatNoReliefSendsBackSaysSo) {
  DesignProblem problem = waves();
  problem.by_light = true;
  problem.traced = {.corrections = 0, .evaluations = 0};
  problem.traced_draws = 0;
  problem.patch.pixels = 48;
  problem.search.max_evaluations = 0;
  const LobeTarget usual = lobes_of(BeckmannLobe{0.20, 0.10, 40.0_deg}, 32, 20.0_deg);
  const auto told = [&](double factor) {
    problem.lobes = usual;
    for (double& value : problem.lobes->maps.front()) value *= factor;
    return problem;
  };
  const std::string refused = test::refusal([&] { (void)find_design(told(30.0)); });
  EXPECT_NE(refused.find("brighter than a mirror"), std::string::npos) << refused;
  test::record({theme, "`mezzotint design`, free forms", "a lobe with 1.2 times the light that comes in",
                "It is refused before anything is searched.", "The light of every map, before anything is allocated.",
                refused});
  EXPECT_TRUE(warned(find_design(told(1.0)), "gentle relief").empty());
  EXPECT_FALSE(warned(find_design(told(3.0)), "gentle relief").empty());
  const std::string dark = warned(find_design(told(0.5)), "gentle relief");
  EXPECT_FALSE(dark.empty());
  test::record({theme, "`mezzotint design`, free forms",
                "a lobe three times as bright, or half as bright, as the material",
                "Its shape may be met, its brightness cannot: relief moves light, it makes and takes little.",
                "The light of every map against Fresnel's of a flat surface; from 5 % on it says so.", dark});
}

TEST(Design, OfFewGrayLevelsHasOtherSlopes) {
  PrinterProfile printer;
  printer.ground_amplitude = 0.0_um;
  const PatchOptions patch{.pixels = 64, .subsamples = 2};
  std::vector<double> worst;
  for (const double height_um : {10.0, 2.0, 1.0, 0.5, 0.3}) {
    double off = 0.0;
    for (const double wave_um : {60.0, 77.0, 100.0, 150.0, 220.0}) {
      const Sinusoid waves{.wavelength_u = Length::from_um(wave_um),
                           .wavelength_v = Length::from_um(1.3 * wave_um),
                           .direction = 20.0_deg,
                           .height = Length::from_um(height_um)};
      const SlopeModel smooth(printer, patch, {1, 2}, {}), rounded(printer, patch, {1, 2}, {}, {GrayLevels::Quantized});
      const SlopeCovariance a = smooth.shown(waves).covariance, b = rounded.shown(waves).covariance;
      off = std::max({off, std::abs(std::sqrt(b.xx / a.xx) - 1.0), std::abs(std::sqrt(b.yy / a.yy) - 1.0)});
    }
    worst.push_back(off);
  }
  EXPECT_LT(worst[1], 0.01);
  EXPECT_GT(worst[4], 0.05);
  DesignProblem problem = waves();
  problem.pattern = Sinusoid{.height = 0.4_um};
  problem.target = beckmann_target({0.02, 0.015, 40.0_deg});
  problem.free = {{"wavelength_u_um", 30.2, 300.0, {}}, {"wavelength_v_um", 30.2, 300.0, {}}};
  const std::string told = warned(find_design(problem), "gray levels");
  EXPECT_FALSE(told.empty());
  EXPECT_TRUE(warned(find_design(waves()), "gray levels").empty());
  test::record(
      {theme, "8 bits", "waves 10, 2, 1, 0.5 and 0.3 µm high, five wavelengths, no ground",
       fmt::format("Rounding to gray levels shifts RMS slopes by up to {}, {}, {}, {} and {}.", percent(worst[0]),
                   percent(worst[1]), percent(worst[2]), percent(worst[3]), percent(worst[4])),
       "The levels that the printed draw uses; below 14 it says so. Verdicts are on rounded prints anyway.", told});
}

TEST(Design, OfAGgxLobeHasNoSlopesOfItsOwn) {
  const auto alphas = [](const MicrofacetLobe& lobe, std::size_t bins, Angle theta) {
    const LobeTarget goal = lobes_of(lobe, bins, theta);
    return alphas_of(principal_axes(implied_slopes(goal, goal.maps).covariance));
  };
  const GgxLobe ggx{0.2, 0.1, 0.0_deg};
  const AlphaPair coarse = alphas(ggx, 32, 20.0_deg), middle = alphas(ggx, 48, 20.0_deg),
                  fine = alphas(ggx, 64, 20.0_deg), oblique = alphas(ggx, 48, 70.0_deg),
                  beckmann = alphas(BeckmannLobe{0.2, 0.1, 0.0_deg}, 48, 20.0_deg);
  EXPECT_NEAR(beckmann.x, 0.2, 0.002);
  EXPECT_GT(middle.x, 0.28);
  DesignProblem problem = waves();
  problem.lobes = lobes_of(ggx, 48, 20.0_deg);
  problem.target = {.kind = "ggx", .slopes = {middle.x / std::numbers::sqrt2, middle.y / std::numbers::sqrt2, {}}};
  problem.traced_draws = 0;
  problem.search.max_evaluations = 0;
  const std::string told = warned(find_design(problem), "GGX");
  EXPECT_FALSE(told.empty());
  test::record(
      {theme, "`kind = \"ggx\"`", "α = 0.2 and 0.1, maps of 32, 48 and 64 bins a side, light at 20°; at 70°",
       fmt::format("The slopes that the map implies are those of α_x = {:.3f}, {:.3f} and {:.3f} (α_y {:.3f}, {:.3f} "
                   "and {:.3f}): the tails up to the horizon, not the number of bins, decide. At 70° they are {:.3f} "
                   "and {:.3f}. Of a Beckmann lobe they are {:.3f} and {:.3f}.",
                   coarse.x, middle.x, fine.x, coarse.y, middle.y, fine.y, oblique.x, oblique.y, beckmann.x,
                   beckmann.y),
       "The kind of the target.", told});
}

TEST(Design, SaysWhichCombinationsNothingDetermines) {
  DesignProblem problem = waves();
  problem.free = {{"height_um", 4.0, 17.0, {}},
                  {"wavelength_u_um", 30.2, 600.0, {}},
                  {"wavelength_v_um", 30.2, 600.0, {}},
                  {"direction_deg", -90.0, 90.0, {}}};
  const Design design = find_design(problem);
  const auto& combinations = design.intervals.combinations;
  ASSERT_EQ(combinations.size(), 4U);
  EXPECT_FALSE(combinations[3].determined);
  for (const std::size_t i : {0U, 1U, 2U}) EXPECT_TRUE(std::isinf(design.intervals.half_widths_95[i])) << i;
  EXPECT_LT(design.intervals.half_widths_95[3], 0.05);
  // All three lengths grow alike: the shape stays.
  for (const std::size_t i : {1U, 2U}) EXPECT_NEAR(combinations[3].change[i] / combinations[3].change[0], 1.0, 0.15);
  test::record({theme, "intervals", "height and both wavelengths of waves are free, slopes are wanted",
                fmt::format("Scaled together they show the same slopes: three figures cannot fix four numbers. The "
                            "interval of each length by itself is infinite, that of the direction ± {:.2f}°.",
                            design.intervals.half_widths_95[3] * 180.0 / std::numbers::pi),
                "Directions along which no figure changes enough to be fixed to a quarter.",
                in_words(combinations[3], design.variables)});
}

}  // namespace
}  // namespace mezzotint
