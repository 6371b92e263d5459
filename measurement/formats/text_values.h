#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace mezzotint {

/// Text without the white space around it.
[[nodiscard]] std::string_view trimmed(std::string_view text);

/// The whole text as a number (white space around it is allowed), whatever the locale; NaN and Inf are numbers.
[[nodiscard]] std::optional<double> to_number(std::string_view text);
[[nodiscard]] std::optional<std::uint64_t> to_count(std::string_view text);

/// What the unit is in metres: m, mm, µm (or um), nm, pm, and nothing at all for none given.
[[nodiscard]] std::optional<double> metres_of_unit(std::string_view unit);

/// Text as it is where it is UTF-8, else from Latin-1, in which older instruments write their µ.
[[nodiscard]] std::string utf8_or_latin1(std::string_view text);

/// Text of a file made fit for a report: valid UTF-8 without control characters, at most 4000 bytes. Bytes that
/// are no UTF-8 become '?'.
[[nodiscard]] std::string clean_text(std::string_view text);

}  // namespace mezzotint
