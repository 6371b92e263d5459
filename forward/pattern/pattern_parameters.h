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
  std::string name;
  double lowest = 0.0;       ///< smallest value with a meaning
  double highest = 0.0;      ///< largest value with a meaning
  bool logarithmic = false;  ///< a search should step by factors, not by differences
  bool whole = false;        ///< a whole number
  bool drawn = false;        ///< another one in every draw of the texture
};

/// Why a search cannot change it; empty where it can.
[[nodiscard]] std::string why_fixed(const PatternParameter& parameter);

/// The kinds of pattern, by name: the simple ones, then the compositions.
[[nodiscard]] const std::vector<std::string_view>& pattern_kinds();

/// A pattern of that kind with its defaults; a composition without parts.
/// @throws InvalidInput for an unknown kind, naming the known ones.
[[nodiscard]] Pattern default_pattern(std::string_view kind);

/// The numbers of a pattern's kind, in the order in which they are reported; those of a composition's parts are theirs.
[[nodiscard]] const std::vector<PatternParameter>& pattern_parameters(const Pattern& pattern);

/// What a composition's part is called: "parts[0]", "parts[1]", … in the order of the file (of regions too, whatever
/// their labels); "part" of a turned pattern; "inside", "outside" and "mask".
/// @param kind  the composition's
[[nodiscard]] std::string part_name(std::string_view kind, std::size_t index);

/// The numbers of a pattern and of all that it is made of, each under its path, as the file nests them:
/// "parts[0].height_um", "parts[1].part.direction_deg", "mask.scale_um". A composition's own numbers stand first.
///
/// Left out are heights that mean nothing, since only the shape counts: those of a product's parts and of a mask.
[[nodiscard]] std::vector<PatternParameter> all_parameters(const Pattern& pattern);

/// One of them.
/// @throws InvalidInput for a name that is not among them, saying which are.
[[nodiscard]] PatternParameter find_parameter(const Pattern& pattern, std::string_view path);

/// The name at the end of a path: "height_um" of "parts[0].height_um".
[[nodiscard]] std::string_view last_name(std::string_view path);

/// A number of the pattern, or of one of its parts by its path.
/// @throws InvalidInput for a name that nothing has, saying what is there.
[[nodiscard]] double get_parameter(const Pattern& pattern, std::string_view path);
void set_parameter(Pattern& pattern, std::string_view path, double value);

}  // namespace mezzotint
