// How many nanoseconds a point of the relief costs in a SlopeModel: one thread, CPU time, medians. Not a test.

#include <array>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <tbb/global_control.h>

#include "inverse/design/slope_model.h"
#include "tests/benchmark/measure.h"

namespace {

using namespace mezzotint;

constexpr std::size_t repeats = 15;

LobeTarget two_lights(std::size_t side) {
  const std::vector<DirectionAngles> lights = {{20.0_deg, 0.0_deg}, {20.0_deg, 90.0_deg}};
  return {SmoothGrid({side, side}), Dielectric{1.5}, lights, std::vector<DirectionMap>(2)};
}

void measure(const std::string& name, const Pattern& pattern, std::size_t pixels, std::size_t draws) {
  std::vector<std::uint64_t> seeds;
  for (std::size_t i = 0; i < draws; ++i) seeds.push_back(i + 1);
  const SlopeModel model(PrinterProfile{}, {.pixels = pixels, .subsamples = 3}, seeds, two_lights(48));
  std::vector<double> seconds;
  SlopeModel::Shown shown;
  for (std::size_t repeat = 0; repeat < repeats; ++repeat) {
    const double start = benchmark::thread_seconds();
    shown = model.shown(pattern);
    seconds.push_back(benchmark::thread_seconds() - start);
  }
  double sum = 0.0;
  for (const DirectionMap& map : shown.maps) {
    for (std::size_t k = 0; k < map.size(); ++k) sum += map[k] * static_cast<double>(k % 97);
  }
  fmt::print("{:<10} {:>4}² pixels {} draws {:>8.1f} ns a point   covariance {:.17g}, maps {:.17g}\n", name, pixels,
             draws, 1e9 * benchmark::median(seconds) / model.samples(), shown.covariance.xx, sum);
}

}  // namespace

int main() {
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  const Pattern waves = Sinusoid{.wavelength_u = 80.0_um, .wavelength_v = 140.0_um, .direction = 30.0_deg};
  const Pattern octaves = FractionalBrownianMotion{};
  for (const std::size_t pixels : {96U, 128U}) {
    for (const std::size_t draws : {4U, 8U}) {
      measure("sinusoid", waves, pixels, draws);
      measure("fbm", octaves, pixels, draws);
    }
  }
  return 0;
}
