#pragma once

#include <cstdlib>
#include <fstream>
#include <string>

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

/// Appends the row as a line of JSON to the file that the environment variable MEZZOTINT_FAILURES names; does nothing
/// where it names none.
inline void record(const FailureRow& row) {
  const char* path = std::getenv("MEZZOTINT_FAILURES");
  if (path == nullptr || *path == '\0') return;
  const nlohmann::ordered_json line = {{"theme", row.theme},     {"method", row.method},   {"taken_to", row.taken_to},
                                       {"happens", row.happens}, {"noticed", row.noticed}, {"told", row.told}};
  std::ofstream(path, std::ios::app) << line.dump() << '\n';
}

}  // namespace mezzotint::test
