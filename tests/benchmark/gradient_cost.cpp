// What the gradient of a search's figure costs beside the figure alone: CPU time, medians of interleaved repeats. Not a
// test.

#include <ctime>

#include <algorithm>
#include <functional>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "forward/base/freed_memory.h"
#include "forward/pattern/pattern_parameters.h"
#include "inverse/design/slope_model.h"
#include "inverse/objective/lobe_distance.h"
#include "inverse/target/target.h"

namespace {

using namespace mezzotint;

constexpr std::size_t repeats = 15;

double cpu_seconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

double seconds_of(const std::function<void()>& work) {
  const double start = cpu_seconds();
  work();
  return cpu_seconds() - start;
}

double median(std::vector<double> values) {
  std::ranges::nth_element(values, values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2));
  return values[values.size() / 2];
}

std::vector<std::string> free_names(const Pattern& pattern) {
  std::vector<std::string> names;
  for (const PatternParameter& parameter : all_parameters(pattern)) {
    if (why_fixed(parameter).empty()) names.push_back(parameter.name);
  }
  return names;
}

LobeTarget wanted_lobes() {
  const DirectionGrid bins{48, 48};
  const std::vector<DirectionAngles> lights = {{20.0_deg, 0.0_deg}, {20.0_deg, 90.0_deg}};
  std::vector<DirectionMap> maps;
  for (const auto& light : lights)
    maps.push_back(reflection_map(BeckmannLobe{0.2, 0.1, 20.0_deg}, Dielectric{1.5}, light, bins));
  return lobe_target(bins, Dielectric{1.5}, lights, maps, false);
}

void measure(const std::string& name, const Pattern& pattern, std::size_t pixels, const LobeTarget* lobes) {
  const Target target = beckmann_target({0.2, 0.1, 20.0_deg});
  const SlopeModel model(PrinterProfile{}, {.pixels = pixels, .subsamples = 4}, {1, 2, 3, 4},
                         lobes != nullptr ? std::optional(*lobes) : std::nullopt);
  const SlopeModel::Figure figure = [&](const SlopeModel::Shown& shown, SlopeModel::Shown& slopes) {
    const CovarianceDistance found = covariance_distance_with_slopes(shown.covariance, target);
    slopes.covariance = found.slopes;
    double sum = found.value;
    for (std::size_t light = 0; light < shown.maps.size(); ++light) {
      DistanceWithSlopes by_lobe =
          lobe_distance(LobeDistance::CubeRoot, lobes->grid, shown.maps[light], lobes->maps[light]);
      sum += by_lobe.value;
      slopes.maps[light] = std::move(by_lobe.slopes);
    }
    return sum;
  };
  const std::vector<std::string> names = free_names(pattern);
  std::vector<double> slopes, alone, both;
  double checked = 0.0;
  for (std::size_t i = 0; i < repeats; ++i) {
    alone.push_back(seconds_of([&] {
      SlopeModel::Shown shown = model.shown(pattern), unused = shown;
      checked += figure(shown, unused);
    }));
    both.push_back(seconds_of([&] { checked -= model.figure_with_slopes(pattern, names, figure, slopes); }));
  }
  fmt::print("{:22} {:3} px {:10} {:2} numbers  figure {:7.2f} ms, with slopes {:7.2f} ms: {:.2f} times{}\n", name,
             pixels, lobes != nullptr ? "2 lobes" : "covariance", names.size(), 1e3 * median(alone), 1e3 * median(both),
             median(both) / median(alone), checked == 0.0 ? "" : " (and another value)");
}

}  // namespace

int main() {
  keep_freed_memory();
  const Sinusoid sinusoid{.wavelength_u = 130.0_um, .wavelength_v = 170.0_um, .direction = 25.0_deg, .height = 5.0_um};
  const Ridges ridges{.wavelength = 150.0_um, .direction = 25.0_deg, .height = 5.0_um, .skew = 0.4};
  const Noise noise{.scale = 90.0_um, .stretch = 1.8, .direction = 25.0_deg, .height = 5.0_um};
  const LobeTarget lobes = wanted_lobes();
  fmt::print("4 draws, 4 samples a pixel and axis, maps of 48 bins; CPU time, median of {}\n", repeats);
  for (const std::size_t pixels : {96, 192}) {
    for (const LobeTarget* wanted : {static_cast<const LobeTarget*>(nullptr), &lobes}) {
      measure("sinusoid", sinusoid, pixels, wanted);
      measure("ridges", ridges, pixels, wanted);
      measure("noise", noise, pixels, wanted);
      measure("sum of all three", PatternSum{{{sinusoid}, {ridges}, {noise}}}, pixels, wanted);
    }
  }
  return 0;
}
