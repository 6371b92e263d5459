#include "inverse/free_form/free_form.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "forward/base/error.h"
#include "forward/base/file_output.h"

namespace mezzotint {
namespace {

constexpr DirectionGrid bins{32, 32};
const std::vector<DirectionAngles> light = {{10.0_deg, 30.0_deg}};
const Material glass = Dielectric{1.5};

// A soft-edged square of directions about the mirror direction: no family of patterns has such a lobe.
double square_lobe(const Direction& out) {
  const Direction mirror = to_direction(light.front());
  const auto inside = [](double x) { return 1.0 / (1.0 + std::exp((std::abs(x) - 0.18) / 0.02)); };
  return inside(out.x() + mirror.x()) * inside(out.y() + mirror.y());
}

LobeTarget square_goal() { return lobe_target(bins, glass, light, {average_over_bins(bins, square_lobe, 8)}, true); }

FreeFormOptions small() {
  return {.pixels = 48,
          .start_evaluations = 10,
          .evaluations = 40,
          .evaluations_per_epoch = 20,
          .traced_samples = 1U << 16};
}
FreeFormOptions tiny() {
  return {
      .pixels = 16, .start_evaluations = 2, .evaluations = 6, .evaluations_per_epoch = 2, .traced_samples = 1U << 12};
}

std::filesystem::path fresh_path(const std::string& name) {
  const auto path = std::filesystem::temp_directory_path() / ("mezzotint_free_form_" + name);
  std::filesystem::remove(path);
  return path;
}

// Stops after so many evaluations.
Progress stop_after(int evaluations) {
  return [left = evaluations](const ProgressEvent& event) mutable {
    if (event.stage == "free form" && --left < 0) throw Interrupted();
  };
}

void expect_same(const FreeForm& a, const FreeForm& b) {
  EXPECT_EQ(a.gray.values, b.gray.values);
  EXPECT_EQ(a.history, b.history);
  EXPECT_EQ(a.start, b.start);
  EXPECT_EQ(a.on_search_draws, b.on_search_draws);
  EXPECT_EQ(a.verified.traced.lobes.front().mean, b.verified.traced.lobes.front().mean);
  EXPECT_EQ(a.evaluations, b.evaluations);
}

TEST(FreeForm, FindsALobeThatNoPatternHas) {
  const FreeForm form = find_free_form(square_goal(), {}, small());
  // On places and grounds that it never met, traced.
  EXPECT_LT(form.verified.traced.by(LobeDistance::CubeRoot).root.value, 0.04);
  // The trial, straight or by way of the Wasserstein distance, and all epochs.
  EXPECT_EQ(form.history.size(), 50U);
}

TEST(FreeForm, IsAllThatAPrinterCanDo) {
  const PrinterProfile printer;
  const FreeForm form = find_free_form(square_goal(), printer, tiny());
  ASSERT_EQ(form.gray.values.size(), 256U);
  for (const float gray : form.gray.values) {
    const float level = 255.0F * gray;
    ASSERT_NEAR(level, std::round(level), 1e-4) << "not one of the printer's levels";
  }
  const HeightRange range = height_range(print_layer(form.gray, printer, {4, Surround::Repeat}));
  EXPECT_GE(range.lowest.um(), 0.0);
  EXPECT_LE(range.highest, reachable_height(printer) + Length::from_um(1e-4));
}

// Light to one side: noise and waves cannot do it on a tile that has to close, a saw can.
TEST(FreeForm, ALobeToOneSideNeedsASaw) {
  const auto aside = [](const Direction& out) {
    return std::exp(-0.5 * (std::pow(out.x() - 0.15, 2) + out.y() * out.y()) / (0.08 * 0.08));
  };
  const LobeTarget goal = lobe_target(bins, glass, {{}}, {average_over_bins(bins, aside, 8)}, true);
  FreeFormOptions options = small();
  options.pixels = 48;
  options.start_evaluations = 6;
  options.evaluations = 20;
  const FreeForm form = find_free_form(goal, {}, options);
  EXPECT_TRUE(form.start.starts_with("a saw")) << form.start;
  // 0.33 after these few evaluations; without the light at all it would be 1.
  EXPECT_LT(form.verified.traced.by(LobeDistance::L2).root.value, 0.45);
  const DirectionMap& seen = form.verified.traced.lobes.front().mean;
  // Its mirror image gets nothing of it.
  EXPECT_GT(seen[16 * 32 + 18], 10.0 * seen[16 * 32 + 13]);
}

TEST(FreeForm, GivesTheSameBitsWithAnyNumberOfThreads) {
  const FreeForm many = find_free_form(square_goal(), {}, tiny());
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  expect_same(find_free_form(square_goal(), {}, tiny()), many);
}

TEST(FreeForm, AGoalOfAnyBrightnessHasTheLightOfAFlatSurface) {
  const DirectionMap map = average_over_bins(bins, square_lobe, 8);
  const LobeTarget goal = lobe_target(bins, glass, light, {map}, true);
  double sum = 0.0;
  for (std::size_t k = 0; k < map.size(); ++k) sum += goal.grid.areas()[k] * goal.maps.front()[k];
  EXPECT_NEAR(sum, reflectance(glass, std::cos(light.front().theta.radians())), 1e-12);
}

// In a trial, in the second one of a start, between stages, in an epoch after a correction.
TEST(FreeFormState, AnInterruptedSearchEndsInTheSameBits) {
  const FreeForm whole = find_free_form(square_goal(), {}, tiny());
  for (const int evaluations : {1, 5, 26, 33}) {
    FreeFormOptions options = tiny();
    options.state = fresh_path("resumed");
    EXPECT_THROW((void)find_free_form(square_goal(), {}, options, stop_after(evaluations)), Interrupted);
    expect_same(find_free_form(square_goal(), {}, options), whole);
    // Finished: nothing is searched again.
    expect_same(find_free_form(square_goal(), {}, options, stop_after(0)), whole);
    std::filesystem::remove(options.state);
  }
}

TEST(FreeFormState, InterruptedTwiceItStillDoes) {
  const FreeForm whole = find_free_form(square_goal(), {}, tiny());
  FreeFormOptions options = tiny();
  options.state = fresh_path("twice");
  EXPECT_THROW((void)find_free_form(square_goal(), {}, options, stop_after(9)), Interrupted);
  EXPECT_THROW((void)find_free_form(square_goal(), {}, options, stop_after(13)), Interrupted);
  expect_same(find_free_form(square_goal(), {}, options), whole);
  std::filesystem::remove(options.state);
}

TEST(FreeFormState, KeepsTheBestOfASearchThatWasStopped) {
  FreeFormOptions options = tiny();
  options.state = fresh_path("stopped");
  // The first trial moves light; the objective is met from the third evaluation on.
  EXPECT_THROW((void)find_free_form(square_goal(), {}, options, stop_after(1)), Interrupted);
  EXPECT_FALSE(free_form_so_far(options.state, {}).has_value());
  EXPECT_THROW((void)find_free_form(square_goal(), {}, options, stop_after(20)), Interrupted);
  const auto found = free_form_so_far(options.state, {});
  ASSERT_TRUE(found.has_value());
  EXPECT_EQ(found->gray.values.size(), 256U);
  EXPECT_FALSE(found->start.empty());
  EXPECT_GT(found->objective, 0.0);
  EXPECT_LT(found->objective, 10.0);
  std::filesystem::remove(options.state);
}

TEST(FreeFormState, RefusesThatOfAnotherProblemAndDamagedOnes) {
  FreeFormOptions options = tiny();
  options.state = fresh_path("other");
  EXPECT_THROW((void)find_free_form(square_goal(), {}, options, stop_after(7)), Interrupted);
  FreeFormOptions other = options;
  other.seed = 2;
  EXPECT_THROW((void)find_free_form(square_goal(), {}, other), FileError);
  PrinterProfile printer;
  printer.spread.width = 3.0_um;
  EXPECT_THROW((void)find_free_form(square_goal(), printer, options), FileError);
  LobeTarget goal = square_goal();
  goal.maps.front()[100] *= 1.0 + 1e-15;
  goal.maps.front()[500] += 1e-15;
  EXPECT_THROW((void)find_free_form(goal, {}, options), FileError);
  std::filesystem::resize_file(options.state, std::filesystem::file_size(options.state) - 1);
  EXPECT_THROW((void)find_free_form(square_goal(), {}, options), FileError);
  EXPECT_THROW((void)free_form_so_far(options.state, {}), FileError);
  write_file(options.state, "something else");
  EXPECT_THROW((void)find_free_form(square_goal(), {}, options), FileError);
  std::filesystem::remove(options.state);
}

TEST(FreeForm, RefusesWhatIsNoGoal) {
  EXPECT_THROW((void)lobe_target(bins, Mirror{}, light, {DirectionMap(bins.size(), 0.0)}, true), InvalidInput);
  EXPECT_THROW((void)lobe_target(bins, Mirror{}, light, {}, true), InvalidInput);
  const auto refused = [](double factor, double one) {
    LobeTarget goal = square_goal();
    for (double& value : goal.maps.front()) value *= factor;
    goal.maps.front()[528] += one;
    EXPECT_THROW((void)find_free_form(goal, {}, tiny()), InvalidInput) << factor << " " << one;
  };
  refused(0.0, 0.0);  // dark
  refused(1.0, std::numeric_limits<double>::quiet_NaN());
  refused(1.0, -1.0);
  refused(30.0, 0.0);  // 1.2 of the light that comes
  LobeTarget none = square_goal();
  none.maps.clear();
  none.incidences.clear();
  EXPECT_THROW((void)find_free_form(none, {}, tiny()), InvalidInput);
}

TEST(FreeForm, RefusesOptionsWithoutMeaning) {
  const auto refused = [](const auto& change) {
    FreeFormOptions options = tiny();
    change(options);
    EXPECT_THROW((void)find_free_form(square_goal(), {}, options), InvalidInput);
  };
  refused([](FreeFormOptions& o) { o.pixels = 4; });
  refused([](FreeFormOptions& o) { o.algorithm = "LN_BOBYQA"; });
  refused([](FreeFormOptions& o) { o.evaluations = 0; });
  refused([](FreeFormOptions& o) { o.start_evaluations = 0; });
  refused([](FreeFormOptions& o) { o.objective.clear(); });
  refused([](FreeFormOptions& o) { o.start_objective.clear(); });
  refused([](FreeFormOptions& o) { o.objective = {{LobeDistance::L2, -1.0}}; });
  refused([](FreeFormOptions& o) { o.fresh_draws = 3; });
}

bool says(const FreeForm& form, std::string_view words) {
  return std::ranges::any_of(form.warnings, [&](const std::string& w) { return w.find(words) != std::string::npos; });
}

TEST(FreeForm, SaysWhatNoReliefOfTheMaterialCanDo) {
  LobeTarget bright = square_goal();
  for (double& value : bright.maps.front()) value *= 4.0;
  EXPECT_TRUE(says(find_free_form(bright, {}, tiny()), "of the light of direction 1"));
  const FreeForm usual = find_free_form(square_goal(), {}, tiny());
  EXPECT_FALSE(says(usual, "of the light of direction 1"));
  EXPECT_FALSE(says(usual, "narrower"));
  // A mirror's lobe: the ground scatters more.
  LobeTarget narrow = square_goal();
  DirectionMap point(bins.size(), 0.0);
  point[bins.bin_of(-to_direction(light.front()).x(), -to_direction(light.front()).y())] = 1.0;
  EXPECT_TRUE(says(find_free_form(lobe_target(bins, glass, light, {point}, true), {}, tiny()), "narrower"));
}

}  // namespace
}  // namespace mezzotint
