// How many nanoseconds a slope point costs in a SmoothLobe, beside the plain formulas point by point, for maps and
// for their derivatives: one thread, CPU time, medians of interleaved repeats. Not a test.

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include <fmt/format.h>
#include <tbb/global_control.h>

#include "inverse/objective/smooth_lobe.h"
#include "tests/benchmark/measure.h"
#include "tests/inverse/objective/scalar_lobe.h"

namespace {

using namespace mezzotint;
using benchmark::median;
using benchmark::thread_seconds;

constexpr std::size_t repeats = 9;

// Slopes of two crossed waves and a fine one: neighbours alike, as on a printed relief.
struct Slopes {
  std::vector<float> x, y;
};
Slopes slopes_of(std::size_t points) {
  Slopes slopes;
  const auto side = static_cast<std::size_t>(std::sqrt(static_cast<double>(points)));
  for (std::size_t i = 0; i < points; ++i) {
    const auto u = static_cast<double>(i % side), v = static_cast<double>(i / side);
    slopes.x.push_back(static_cast<float>(0.2 * std::sin(0.07 * u + 0.02 * v) + 0.05 * std::sin(0.9 * u + 2.0 * v)));
    slopes.y.push_back(static_cast<float>(0.25 * std::cos(0.05 * v - 0.01 * u)));
  }
  return slopes;
}

struct Times {
  std::vector<double> old_way, new_way;
  void add(const std::function<void()>& old_work, const std::function<void()>& new_work) {
    const double start = thread_seconds();
    old_work();
    const double middle = thread_seconds();
    new_work();
    old_way.push_back(middle - start);
    new_way.push_back(thread_seconds() - middle);
  }
  void print(const char* what, double points) const {
    const double old_ns = 1e9 * median(old_way) / points, new_ns = 1e9 * median(new_way) / points;
    fmt::print("  {:<11} {:>6.1f} {:>6.1f} {:>6.1f}x", what, old_ns, new_ns, old_ns / new_ns);
  }
};

void race(std::size_t side, std::size_t points, std::size_t lights) {
  const SmoothGrid grid({side, side});
  const Slopes slopes = slopes_of(points);
  const std::vector<double> figure(side * side, 1.0);
  std::vector<SmoothLobe> lobes;
  std::vector<test::ScalarLobe> scalar;
  for (std::size_t i = 0; i < lights; ++i) {
    const DirectionAngles to_light{Angle::from_degrees(20.0 + 25.0 * static_cast<double>(i)), Angle::from_degrees(0.0)};
    lobes.emplace_back(grid, Dielectric{1.5}, to_light);
    scalar.emplace_back(grid, Dielectric{1.5}, to_light);
  }
  std::vector<float> toward_x(points), toward_y(points);
  volatile double sink = 0.0;
  const auto maps = [&](const auto& some) {
    for (const auto& lobe : some) sink = sink + lobe.map(slopes.x, slopes.y)[side];
  };
  const auto derivatives = [&](const auto& some) {
    for (const auto& lobe : some) lobe.add_slope_derivatives(slopes.x, slopes.y, figure, 1.0, toward_x, toward_y);
  };
  Times map_times, derivative_times;
  for (std::size_t repeat = 0; repeat < repeats; ++repeat) {
    map_times.add([&] { maps(scalar); }, [&] { maps(lobes); });
    derivative_times.add([&] { derivatives(scalar); }, [&] { derivatives(lobes); });
  }
  fmt::print("{:>3}² bins {:>8} points {} lights", side, points, lights);
  const double all = static_cast<double>(points * lights);
  map_times.print("map", all);
  derivative_times.print("derivatives", all);
  fmt::print("\n");
}

}  // namespace

int main() {
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  fmt::print("ns a point and light, one thread, medians of {}: point by point, with vectors, ratio\n", repeats);
  for (const std::size_t side : {48U, 64U}) {
    for (const std::size_t points : {9216U, 150000U, 1200000U}) {
      for (const std::size_t lights : {1U, 2U}) race(side, points, lights);
    }
  }
  return 0;
}
