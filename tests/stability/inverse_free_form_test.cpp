#include <sys/resource.h>

#include <cmath>
#include <csignal>
#include <filesystem>
#include <limits>

#include "inverse/free_form/free_form.h"
#include "tests/stability/scene.h"

namespace mezzotint {
namespace {

constexpr const char* theme = "Inverse design";
constexpr DirectionGrid bins{32, 32};
const std::vector<DirectionAngles> light = {{10.0_deg, 30.0_deg}};
const Material glass = Dielectric{1.5};

LobeTarget square_goal() {
  const Direction mirror = to_direction(light.front());
  const auto inside = [](double x) { return 1.0 / (1.0 + std::exp((std::abs(x) - 0.18) / 0.02)); };
  const auto lobe = [&](const Direction& out) { return inside(out.x() + mirror.x()) * inside(out.y() + mirror.y()); };
  return lobe_target(bins, glass, light, {average_over_bins(bins, lobe, 8)}, true);
}

FreeFormOptions tiny() {
  return {
      .pixels = 16, .start_evaluations = 2, .evaluations = 6, .evaluations_per_epoch = 2, .traced_samples = 1U << 12};
}

std::string told_about(const LobeTarget& goal) {
  return test::refusal([&] { (void)find_free_form(goal, {}, tiny()); });
}

std::string warned(const FreeForm& form, const std::string& words) {
  for (const std::string& sentence : form.warnings)
    if (sentence.find(words) != std::string::npos) return sentence;
  return "";
}

TEST(FreeForm, OfAGoalThatIsNoneIsRefused) {
  LobeTarget dark = square_goal(), blind = square_goal(), bright = square_goal();
  for (double& value : dark.maps.front()) value = 0.0;
  blind.maps.front()[528] = std::numeric_limits<double>::quiet_NaN();
  for (double& value : bright.maps.front()) value *= 30.0;
  EXPECT_NE(told_about(dark).find("dark everywhere"), std::string::npos);
  EXPECT_NE(told_about(bright).find("brighter than a mirror"), std::string::npos);
  const std::string told = told_about(blind);
  EXPECT_NE(told.find("finite and not negative"), std::string::npos) << told;
  test::record({theme, "free forms", "a goal that is dark, negative, or NaN in one bin of 1024",
                "It is refused before anything is allocated: one NaN would make every evaluation one.",
                "Every bin of the goal.", told});
}

TEST(FreeForm, OfAGoalSmootherThanTheGroundSaysSo) {
  LobeTarget narrow = square_goal();
  DirectionMap point(bins.size(), 0.0);
  const Direction mirror = to_direction(light.front());
  point[bins.bin_of(-mirror.x(), -mirror.y())] = 1.0;
  const FreeForm form = find_free_form(lobe_target(bins, glass, light, {point}, true), {}, tiny());
  const std::string told = warned(form, "narrower");
  EXPECT_FALSE(told.empty());
  test::record({theme, "free forms", "a mirror's lobe: all light in one bin",
                fmt::format("Heights cannot take the printer's own ground away: the traced lobe stays {:.2f} off "
                            "(cube root) after the few evaluations of the test.",
                            form.verified.traced.by(LobeDistance::CubeRoot).root.value),
                "The goal's width against the light that the mean ground scatters.", told});
}

TEST(FreeForm, ThatIsStoppedKeepsItsBest) {
  FreeFormOptions options = tiny();
  options.state = std::filesystem::temp_directory_path() / "mezzotint_where_free_forms_fail";
  std::filesystem::remove(options.state);
  const auto stop = [left = 20](const ProgressEvent& event) mutable {
    if (event.stage == "free form" && --left < 0) throw Interrupted();
  };
  EXPECT_THROW((void)find_free_form(square_goal(), {}, options, stop), Interrupted);
  const auto so_far = free_form_so_far(options.state, {});
  ASSERT_TRUE(so_far.has_value());
  EXPECT_TRUE(std::isfinite(so_far->objective));
  FreeFormOptions other = options;
  other.seed = 2;
  const std::string told = test::refusal([&] { (void)find_free_form(square_goal(), {}, other); });
  EXPECT_FALSE(told.empty());
  EXPECT_EQ(find_free_form(square_goal(), {}, options).gray.values,
            find_free_form(square_goal(), {}, tiny()).gray.values);
  test::record({theme, "free forms", "Ctrl-C after 20 evaluations; then another seed with the same state",
                fmt::format("The best relief so far (objective {:.2g}) is in the state, and going on gives the same "
                            "bits. With another seed, goal or printer the state is refused.",
                            so_far->objective),
                "A digest of goal, printer and options in the state.", told.substr(told.find("state") - 4)});
  std::filesystem::remove(options.state);
}

// A limit on the size of files stands for a full disk: writing fails in the same place.
TEST(FreeForm, OnAFullDiskStopsWithTheLastStateWhole) {
  FreeFormOptions options = tiny();
  options.state = std::filesystem::temp_directory_path() / "mezzotint_free_form_on_a_full_disk";
  std::filesystem::remove(options.state);
  rlimit before{};
  getrlimit(RLIMIT_FSIZE, &before);
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  const rlimit few{1024, before.rlim_max};
  setrlimit(RLIMIT_FSIZE, &few);
  const std::string told = test::refusal([&] { (void)find_free_form(square_goal(), {}, options); });
  setrlimit(RLIMIT_FSIZE, &before);
  (void)std::signal(SIGXFSZ, handler);
  EXPECT_FALSE(told.empty());
  EXPECT_FALSE(std::filesystem::exists(options.state)) << "half a state";
  test::record({theme, "free forms", "a full disk for the state",
                "The search stops. The state before is whole: it is written aside and renamed.",
                "The stream is asked after every state.", told.substr(told.rfind("mezzotint_"))});
}

TEST(FreeForm, ThatHasNoBudgetIsRefused) {
  FreeFormOptions options = tiny();
  options.evaluations = 0;
  const std::string told = test::refusal([&] { (void)find_free_form(square_goal(), {}, options); });
  EXPECT_NE(told.find("at least one evaluation"), std::string::npos) << told;
  test::record({theme, "free forms", "a budget of 0 evaluations", "There is no closed-form start worth printing.",
                "The options are checked first.", told});
}

}  // namespace
}  // namespace mezzotint
