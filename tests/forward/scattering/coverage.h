#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "forward/scattering/bin_interval.h"
#include "forward/scattering/path_tracing.h"

namespace mezzotint::test {

/// How often the 95 % intervals of a map hold what a far longer run says, by the hits that a bin of one run expects.
struct Coverage {
  /// Edges of the classes of expected hits; the last class has no end.
  static constexpr std::array<double, 9> edges = {0.03, 0.1, 0.3, 1.0, 3.0, 10.0, 30.0, 100.0, 300.0};
  std::array<double, edges.size()> bins{}, intervals{}, covered{}, above{}, below{}, by_error{};
  /// `by_error` counts those whose mean lies within Student's t times its standard error, whatever the hits.
  [[nodiscard]] double share(std::size_t c) const { return covered[c] / intervals[c]; }
};

/// Runs with the seeds 1 … repeats against one of `factor` times the paths, all by the same options but for the long
/// run, which is a beam. Expected hits are those that a beam of as many paths would have by single reflection: the
/// light of the bin over the reflectance on its way.
inline Coverage coverage_of(PathTracer& tracer, PathTracingOptions options, int repeats, std::uint64_t factor) {
  PathTracingOptions longer = options;
  longer.samples = options.samples * factor;
  longer.seed = 1000003;
  const Bsdf truth = tracer.trace(longer);
  const auto areas = projected_solid_angles(options.grid);
  const DirectionMap weights = average_over_bins(
      options.grid,
      [&](const Direction& viewer) {
        const Direction light = to_direction(options.incidence);
        return reflectance(options.material, std::min(1.0, (light + viewer).normalized().dot(light)));
      },
      2);
  std::vector<int> class_of(areas.size(), -1);
  Coverage result;
  for (std::size_t bin = 0; bin < areas.size(); ++bin) {
    const double hits = truth.reflection.mean[bin] * areas[bin] / weights[bin] * static_cast<double>(options.samples);
    for (std::size_t c = 0; c < Coverage::edges.size() && hits >= Coverage::edges[c]; ++c)
      class_of[bin] = static_cast<int>(c);
    if (class_of[bin] >= 0) result.bins[static_cast<std::size_t>(class_of[bin])] += 1.0;
  }
  for (int repeat = 1; repeat <= repeats; ++repeat) {
    options.seed = static_cast<std::uint64_t>(repeat);
    const MapEstimate map = tracer.trace(options).reflection;
    for (std::size_t bin = 0; bin < areas.size(); ++bin) {
      if (class_of[bin] < 0) continue;
      const auto c = static_cast<std::size_t>(class_of[bin]);
      const double value = truth.reflection.mean[bin];
      result.intervals[c] += 1.0;
      const double error = student_95(options.batches - 1) * map.standard_error[bin];
      if (std::abs(value - map.mean[bin]) <= error) result.by_error[c] += 1.0;
      if (value > map.high_95[bin])
        result.above[c] += 1.0;
      else if (value < map.low_95[bin])
        result.below[c] += 1.0;
      else
        result.covered[c] += 1.0;
    }
  }
  return result;
}

}  // namespace mezzotint::test
