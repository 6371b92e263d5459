#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace mezzotint {

/// The candidate that was most likely meant: the closest by edit distance (insert, delete, replace, swap), if
/// it is close enough to be a slip of the finger.
[[nodiscard]] std::optional<std::string> closest_match(std::string_view word,
                                                       const std::vector<std::string>& candidates);

/// The candidate that differs from a key in its unit alone: "scale_mm" for "scale_um".
[[nodiscard]] std::optional<std::string> same_quantity_in_our_unit(std::string_view key,
                                                                   const std::vector<std::string>& candidates);

/// A sentence for a message: `; did you mean "pitch_um"?`, or the list of what is known.
[[nodiscard]] std::string suggest(std::string_view word, const std::vector<std::string>& candidates);

}  // namespace mezzotint
