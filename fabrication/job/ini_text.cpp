#include "fabrication/job/ini_text.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <string_view>

namespace mezzotint {

namespace {

std::string trimmed(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(" \t\r");
  if (begin == std::string_view::npos) return "";
  return std::string(text.substr(begin, text.find_last_not_of(" \t\r") + 1 - begin));
}

}  // namespace

IniText::IniText(std::span<const std::byte> text, const MemberPlace& place) : place_(place) {
  std::string_view rest(reinterpret_cast<const char*>(text.data()), text.size());
  while (!rest.empty()) {
    const std::string_view line = rest.substr(0, rest.find('\n'));
    rest.remove_prefix(std::min(rest.size(), line.size() + 1));
    const std::size_t equals = line.find('=');
    if (equals == std::string_view::npos || line.front() == '#' || line.front() == ';') continue;
    values_[trimmed(line.substr(0, equals))] = trimmed(line.substr(equals + 1));
  }
}

std::string IniText::text(const std::string& key) const {
  const auto found = values_.find(key);
  if (found == values_.end()) place_.refuse(fmt::format("\"{}\" is missing", key));
  return found->second;
}

double IniText::number(const std::string& key, double low, double high) const {
  const std::string value = text(key);
  double number = 0.0;
  const auto [end, problem] = std::from_chars(value.data(), value.data() + value.size(), number);
  const bool good = problem == std::errc() && end == value.data() + value.size() && number >= low && number <= high;
  if (!good) place_.refuse(fmt::format("\"{}\" is \"{}\"; it must be a number from {} to {}", key, value, low, high));
  return number;
}

std::size_t IniText::whole(const std::string& key, std::size_t low, std::size_t high) const {
  const double value = number(key, static_cast<double>(low), static_cast<double>(high));
  if (value != std::floor(value)) place_.refuse(fmt::format("\"{}\" must be a whole number", key));
  return static_cast<std::size_t>(value);
}

}  // namespace mezzotint
