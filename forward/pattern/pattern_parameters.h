#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "forward/pattern/pattern.h"

namespace mezzotint {

/// A number that a pattern has, under the name that experiment files use.
///
/// Units    as the name's ending says: `_um` micrometres, `_deg` degrees, none for a ratio.
struct PatternParameter {
  std::string_view name;
  double lowest = 0.0;       ///< smallest value with a meaning
  double highest = 0.0;      ///< largest value with a meaning
  bool logarithmic = false;  ///< a search should step by factors, not by differences
  bool whole = false;        ///< a whole number; a search cannot change it
};

/// The kinds of pattern, by name: the simple ones, then the compositions.
[[nodiscard]] const std::vector<std::string_view>& pattern_kinds();

/// A pattern of that kind with its defaults; a composition without parts.
/// @throws InvalidInput for an unknown kind, naming the known ones.
[[nodiscard]] Pattern default_pattern(std::string_view kind);

/// The numbers of a pattern's kind, in the order in which they are reported; those of a composition's parts are theirs.
[[nodiscard]] const std::vector<PatternParameter>& pattern_parameters(const Pattern& pattern);

/// @throws InvalidInput for a name that the pattern's kind does not have.
[[nodiscard]] double get_parameter(const Pattern& pattern, std::string_view name);
void set_parameter(Pattern& pattern, std::string_view name, double value);

}  // namespace mezzotint
