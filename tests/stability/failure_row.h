#pragma once

#include <cstdlib>
#include <fstream>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace mezzotint::test {

/// One line of docs/where-methods-fail.md: a method, taken to the place where it breaks.
struct FailureRow {
  std::string theme;     ///< heading of the page
  std::string method;    ///< what was taken …
  std::string taken_to;  ///< … to where
  std::string happens;   ///< with the figures that the case measured
  std::string noticed;   ///< how the program notices; "not noticed" where it does not
  std::string told;      ///< what the user reads: the sentence itself where there is one
};

/// A curve of the page's figure.
struct FailureCurve {
  std::string panel;
  std::string series;
  std::vector<double> theta_deg;
  std::vector<double> values;
};

namespace detail {
inline void append_line(const nlohmann::ordered_json& line) {
  const char* path = std::getenv("MEZZOTINT_FAILURES");
  if (path != nullptr && *path != '\0') std::ofstream(path, std::ios::app) << line.dump() << '\n';
}
}  // namespace detail

/// Appends a row, or a curve, as a line of JSON to the file that the environment variable MEZZOTINT_FAILURES names;
/// does nothing where it names none.
inline void record(const FailureRow& row) {
  detail::append_line({{"theme", row.theme},
                       {"method", row.method},
                       {"taken_to", row.taken_to},
                       {"happens", row.happens},
                       {"noticed", row.noticed},
                       {"told", row.told}});
}
inline void record(const FailureCurve& curve) {
  detail::append_line(
      {{"panel", curve.panel}, {"series", curve.series}, {"theta_deg", curve.theta_deg}, {"values", curve.values}});
}

}  // namespace mezzotint::test
