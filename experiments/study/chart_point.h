#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>

namespace mezzotint {

/// One method with one budget, as a chart of error against time draws it.
struct ChartPoint {
  std::string method;
  std::uint64_t samples = 0;        ///< the budget, by which the points of a line are ordered; 0: none
  std::optional<double> tolerance;  ///< of `auto`
  double seconds = 0.0;             ///< CPU time of one thread, median
  double seconds_error = 0.0;       ///< standard error of it; 0 for a single run
  double error = 0.0;
  double error_spread = 0.0;  ///< standard error of it
  double floor = 0.0;         ///< nothing below it can be told from none
  bool on_front = false;      ///< no other method is both faster and nearer

  /// The error that is drawn.
  [[nodiscard]] double told() const { return std::max(error, floor); }
};

/// Whether a point leaves no reason to take another one on the same scene.
[[nodiscard]] inline bool beats(const ChartPoint& a, const ChartPoint& b) {
  return (a.told() < b.told() && a.seconds <= b.seconds) || (a.told() == b.told() && a.seconds < b.seconds);
}

}  // namespace mezzotint
