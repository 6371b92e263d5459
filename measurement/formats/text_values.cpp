#include "measurement/formats/text_values.h"

#include <charconv>
#include <system_error>

namespace mezzotint {

namespace {

constexpr std::size_t longest_text = 4000;

template <class Number>
std::optional<Number> whole_number(std::string_view text) {
  text = trimmed(text);
  if (text.starts_with('+')) text.remove_prefix(1);  // from_chars knows no plus sign
  Number value{};
  const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (problem != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

// Length of the UTF-8 character that begins here, 0 where none does (overlong forms and surrogates are none).
std::size_t character_length(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned char first = byte(0);
  if (first < 0x80) return 1;
  const std::size_t length = first >= 0xF0 ? 4 : first >= 0xE0 ? 3 : 2;
  if (first < 0xC2 || first > 0xF4 || text.size() < length) return 0;
  for (std::size_t i = 1; i < length; ++i) {
    if ((byte(i) & 0xC0) != 0x80) return 0;
  }
  const bool overlong = (first == 0xE0 && byte(1) < 0xA0) || (first == 0xF0 && byte(1) < 0x90);
  const bool outside = (first == 0xED && byte(1) > 0x9F) || (first == 0xF4 && byte(1) > 0x8F);
  return overlong || outside ? 0 : length;
}

}  // namespace

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view white = " \t\r\n";
  const std::size_t begin = text.find_first_not_of(white);
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(white) - begin + 1);
}

std::optional<double> to_number(std::string_view text) { return whole_number<double>(text); }

std::optional<std::uint64_t> to_count(std::string_view text) { return whole_number<std::uint64_t>(text); }

std::optional<double> metres_of_unit(std::string_view unit) {
  if (unit == "m" || unit.empty()) return 1.0;
  if (unit == "mm") return 1e-3;
  // Unicode has two: the micro sign and the Greek letter.
  if (unit == "um" || unit == "\u00b5m" || unit == "\u03bcm") return 1e-6;
  if (unit == "nm") return 1e-9;
  if (unit == "pm") return 1e-12;
  return std::nullopt;
}

namespace {

std::string latin1_to_utf8(std::string_view text) {
  std::string utf8;
  for (const char c : text) {
    const auto code = static_cast<unsigned char>(c);
    if (code < 0x80) {
      utf8.push_back(c);
    } else {
      utf8.push_back(static_cast<char>(0xC0 | code >> 6));
      utf8.push_back(static_cast<char>(0x80 | (code & 0x3F)));
    }
  }
  return utf8;
}

}  // namespace

std::string utf8_or_latin1(std::string_view text) {
  for (std::string_view rest = text; !rest.empty();) {
    const std::size_t length = character_length(rest);
    if (length == 0) return latin1_to_utf8(text);
    rest.remove_prefix(length);
  }
  return std::string(text);
}

std::string clean_text(std::string_view text) {
  text = trimmed(text);
  std::string clean;
  while (!text.empty() && clean.size() < longest_text) {
    const std::size_t length = character_length(text);
    const bool control = static_cast<unsigned char>(text[0]) < 0x20 || text[0] == 0x7F;
    if (length == 0 || control) {
      clean.push_back(length == 0 ? '?' : ' ');
    } else {
      clean.append(text.substr(0, length));
    }
    text.remove_prefix(length == 0 ? 1 : length);
  }
  return clean;
}

}  // namespace mezzotint
