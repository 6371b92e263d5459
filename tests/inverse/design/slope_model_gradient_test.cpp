#include <array>
#include <cmath>

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "forward/pattern/pattern_parameters.h"
#include "inverse/design/slope_model.h"
#include "inverse/objective/lobe_distance.h"
#include "inverse/target/target.h"

namespace mezzotint {
namespace {

const std::vector<DirectionAngles> lights = {{20.0_deg, 0.0_deg}, {20.0_deg, 90.0_deg}};

const LobeTarget& wanted_lobes() {
  static const LobeTarget target = [] {
    const DirectionGrid bins{32, 32};
    std::vector<DirectionMap> maps;
    for (const auto& light : lights)
      maps.push_back(reflection_map(BeckmannLobe{0.2, 0.1, 20.0_deg}, Dielectric{1.5}, light, bins));
    return lobe_target(bins, Dielectric{1.5}, lights, maps, false);
  }();
  return target;
}

SlopeModel::Figure by_lobes(LobeDistance distance) {
  return [distance](const SlopeModel::Shown& shown, SlopeModel::Shown& slopes) {
    double sum = 0.0;
    for (std::size_t light = 0; light < shown.maps.size(); ++light) {
      DistanceWithSlopes found =
          lobe_distance(distance, wanted_lobes().grid, shown.maps[light], wanted_lobes().maps[light]);
      sum += found.value;
      slopes.maps[light] = std::move(found.slopes);
    }
    return sum;
  };
}

double by_covariance(const SlopeModel::Shown& shown, SlopeModel::Shown& slopes) {
  const auto found = covariance_distance_with_slopes(shown.covariance, beckmann_target({0.2, 0.1, 20.0_deg}));
  slopes.covariance = found.slopes;
  return found.value;
}

struct NamedFigure {
  std::string name;
  SlopeModel::Figure figure;
};
std::vector<NamedFigure> all_figures() {
  std::vector<NamedFigure> figures = {{"covariance", by_covariance}};
  for (const LobeDistance distance : all_lobe_distances)
    figures.push_back({std::string(name_of(distance)), by_lobes(distance)});
  return figures;
}

struct Case {
  Pattern pattern;
  std::vector<std::string> names;
  std::vector<double> steps;  // for differences
};

double size_of(const std::vector<double>& v) {
  double sum = 0.0;
  for (const double x : v) sum += x * x;
  return std::sqrt(sum);
}

// What is shown one and two steps of a number above and below.
struct Around {
  std::array<SlopeModel::Shown, 4> shown;

  Around(const SlopeModel& model, Pattern pattern, const std::string& name, double step) {
    const double value = get_parameter(pattern, name);
    for (std::size_t i = 0; i < 4; ++i) {
      set_parameter(pattern, name, value + std::array{-2.0, -1.0, 1.0, 2.0}[i] * step);
      shown[i] = model.shown(pattern);
    }
  }
  // A step's change of a figure, by central differences of the fourth order.
  [[nodiscard]] double change(const SlopeModel::Figure& figure) const {
    std::array<double, 4> values;
    for (std::size_t i = 0; i < 4; ++i) {
      SlopeModel::Shown unused = shown[i];
      values[i] = figure(shown[i], unused);
    }
    return (8.0 * (values[2] - values[1]) - (values[3] - values[0])) / 12.0;
  }
};

// The gradients' errors relative to their size, each number counting by its step. The second derivatives of the sliced
// Wasserstein distance jump where light passes from bin to bin, so that the differences' own error falls with the step
// alone (1.4e-3, 7.6e-4, 3.7e-4 of three halvings): a quarter of the step for it, and ten times the tolerance.
void expect_gradients(const SlopeModel& model, const Case& at, double tolerance) {
  for (const auto& [name, figure] : all_figures()) {
    const bool jumps = name == "sliced_wasserstein";
    std::vector<double> slopes, off, size;
    const double value = model.figure_with_slopes(at.pattern, at.names, figure, slopes);
    SlopeModel::Shown shown = model.shown(at.pattern), unused = shown;
    EXPECT_EQ(value, figure(shown, unused)) << "other bits";
    for (std::size_t k = 0; k < at.names.size(); ++k) {
      const double step = jumps ? 0.25 * at.steps[k] : at.steps[k];
      size.push_back(Around(model, at.pattern, at.names[k], step).change(figure));
      off.push_back(slopes[k] * step - size.back());
    }
    EXPECT_LT(size_of(off), (jumps ? 10.0 : 1.0) * tolerance * size_of(size)) << kind_name(at.pattern) << " " << name;
  }
}

const SlopeModel& some_draws() {
  static const SlopeModel model(PrinterProfile{}, {.pixels = 96, .subsamples = 3}, {1, 2, 3, 4}, wanted_lobes());
  return model;
}

const Sinusoid sinusoid{.wavelength_u = 130.0_um, .wavelength_v = 170.0_um, .direction = 25.0_deg, .height = 12.0_um};
const Noise noise{.scale = 150.0_um, .stretch = 1.8, .direction = 25.0_deg, .height = 12.0_um};
const Ridges ridges{.wavelength = 150.0_um, .direction = 25.0_deg, .height = 12.0_um, .skew = 0.4};

// Steps of 1.5e-4 of a wavelength: what single precision leaves of the figures' differences is 1e-5.
TEST(SlopeModelGradient, IsThatOfDifferencesForSinusoids) {
  const std::vector<std::string> names = {"wavelength_u_um", "wavelength_v_um", "direction_deg", "height_um"};
  expect_gradients(some_draws(), {sinusoid, names, {0.02, 0.02, 0.01, 0.01}}, 1e-4);
}

// Smaller steps: where the noise is cut to [0, height], in 0.1 % of the pixels, there are kinks.
TEST(SlopeModelGradient, IsThatOfDifferencesForNoise) {
  const std::vector<std::string> names = {"scale_um", "stretch", "direction_deg", "height_um"};
  expect_gradients(some_draws(), {noise, names, {0.01, 0.0002, 0.005, 0.005}}, 1e-4);
}

// A pixel's middle that a crest passes by within a step spoils the difference, and there are some at every step.
TEST(SlopeModelGradient, IsThatOfDifferencesForRidgesButForTheirEdges) {
  const std::vector<std::string> names = {"wavelength_um", "direction_deg", "height_um", "skew"};
  expect_gradients(some_draws(), {ridges, names, {0.002, 0.001, 0.005, 2e-5}}, 0.01);
}

TEST(SlopeModelGradient, GoesThroughSumsAndTheirTurns) {
  Sinusoid low = sinusoid;
  Noise fine = noise;
  low.height = 4.0_um;
  fine.height = 6.0_um;
  const Pattern sum = PatternSum{{{low}, {TurnedPattern{20.0_deg, {}, {{fine}}}}, {fine}}};
  const std::vector<std::string> names = {"parts[0].wavelength_u_um", "parts[0].height_um", "parts[1].rotation_deg",
                                          "parts[1].part.scale_um", "parts[2].stretch"};
  expect_gradients(some_draws(), {sum, names, {0.02, 0.005, 0.005, 0.01, 0.0002}}, 2e-4);
}

TEST(SlopeModelGradient, HasTheSameBitsWithOneThreadAndWithTwo) {
  const SlopeModel model(PrinterProfile{}, {.pixels = 48, .subsamples = 2}, {1, 2, 3}, wanted_lobes());
  const std::vector<std::string> names = {"scale_um", "direction_deg"};
  std::vector<std::vector<double>> slopes(2);
  for (const std::size_t threads : {1, 2}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    (void)model.figure_with_slopes(noise, names, by_lobes(LobeDistance::CubeRoot), slopes[threads - 1]);
  }
  EXPECT_EQ(slopes[0], slopes[1]);
}

// The covariance that a pattern of these numbers shows is found again, from 30 % and 15 degrees off.
TEST(SlopeModelGradient, LeadsEverySearchBySlopesToWhatWasShown) {
  const SlopeModel model(PrinterProfile{}, {.pixels = 64, .subsamples = 2}, {1, 2}, {});
  const Target target{.slopes = principal_axes(model.shown(sinusoid).covariance)};
  const SlopeModel::Figure figure = [&target](const SlopeModel::Shown& shown, SlopeModel::Shown& slopes) {
    const CovarianceDistance found = covariance_distance_with_slopes(shown.covariance, target);
    slopes.covariance = found.slopes;
    return found.value;
  };
  const std::vector<Variable> variables = {{"wavelength_u_um", 60.0, 400.0, 100.0, true},
                                           {"wavelength_v_um", 60.0, 400.0, 220.0, true},
                                           {"direction_deg", -90.0, 90.0, 10.0, false}};
  std::vector<std::string> names;
  for (const Variable& variable : variables) names.push_back(variable.name);
  for (const std::string algorithm : {"LD_LBFGS", "LD_MMA", "LD_SLSQP"}) {
    const MinimizeResult found =
        minimize_with_slopes(variables, steep_objective(model, sinusoid, names, figure),
                             {.algorithm = algorithm, .max_evaluations = 60, .relative_tolerance = 1e-6});
    EXPECT_LT(found.best.objective, 1e-6) << algorithm;  // variances within 0.1 %
    EXPECT_LE(found.evaluations, 60) << algorithm;
  }
}

// A pattern that is higher than a layer is lifted no more, and cut.
TEST(SlopeModelGradient, SeesWhereALayerEnds) {
  Sinusoid high = sinusoid;
  high.height = 25.0_um;
  const std::vector<std::string> names = {"height_um", "wavelength_u_um"};
  expect_gradients(some_draws(), {high, names, {0.001, 0.002}}, 2e-2);
}

}  // namespace
}  // namespace mezzotint
