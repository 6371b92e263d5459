#include "fabrication/stage/marlin_words.h"

#include <charconv>
#include <cmath>

#include <fmt/format.h>

namespace mezzotint {

namespace {

constexpr std::int64_t largest_height_um = 10'000'000;  // ten metres: more is noise on the line

bool contains(std::string_view text, std::string_view part) { return text.find(part) != std::string_view::npos; }

MarlinReply resend(std::string_view rest) {
  while (!rest.empty() && (rest.front() == ' ' || rest.front() == ':' || rest.front() == 'N')) rest.remove_prefix(1);
  std::int64_t number = 0;
  const auto result = std::from_chars(rest.data(), rest.data() + rest.size(), number);
  if (result.ec != std::errc{}) return {MarlinReply::Kind::LineDamaged};
  return {MarlinReply::Kind::Resend, number};
}

MarlinReply error(std::string_view text) {
  if (contains(text, "Homing Failed") || contains(text, "Homing failed")) return {MarlinReply::Kind::HomingFailed};
  const bool mended_by_resend = contains(text, "Line Number") || contains(text, "hecksum");
  return {mended_by_resend ? MarlinReply::Kind::LineDamaged : MarlinReply::Kind::Refused};
}

// "X:0.00 Y:0.00 Z:12.02 E:0.00 Count X:0 Y:0 Z:4807": the first Z is the height, the second one counts steps.
std::optional<std::int64_t> reported_height(std::string_view line) {
  const auto place = line.find("Z:");
  if (place == std::string_view::npos || contains(line.substr(0, place), "Count")) return {};
  return parse_micrometres(line.substr(place + 2));
}

}  // namespace

std::string numbered_line(std::int64_t number, std::string_view command) {
  std::string line = fmt::format("N{} {}", number, command);
  unsigned char checksum = 0;
  for (const char byte : line) checksum = static_cast<unsigned char>(checksum ^ static_cast<unsigned char>(byte));
  return line + fmt::format("*{}\n", checksum);
}

std::string millimetres(std::int64_t height_um) {
  const std::int64_t size = height_um < 0 ? -height_um : height_um;
  return fmt::format("{}{}.{:03}", height_um < 0 ? "-" : "", size / 1000, size % 1000);
}

std::optional<std::int64_t> parse_micrometres(std::string_view text) {
  while (!text.empty() && text.front() == ' ') text.remove_prefix(1);
  double value = 0.0;
  const auto result = std::from_chars(text.data(), text.data() + text.size(), value, std::chars_format::fixed);
  if (result.ec != std::errc{} || !(std::abs(value) * 1000.0 <= double(largest_height_um))) return {};
  return std::llround(value * 1000.0);
}

MarlinReply parse_marlin_reply(std::string_view line) {
  if (line == "ok" || line.starts_with("ok ")) return {MarlinReply::Kind::Acknowledged};
  if (line.starts_with("Resend")) return resend(line.substr(6));
  if (line.starts_with("rs ")) return resend(line.substr(3));
  if (line == "start") return {MarlinReply::Kind::Restarted};
  if (line.starts_with("echo:busy") || line.starts_with("busy:") || line == "wait") return {MarlinReply::Kind::Busy};
  if (line.starts_with("Error:")) return error(line.substr(6));
  if (line.starts_with("!!")) return {MarlinReply::Kind::Refused};
  if (line.starts_with("echo:Unknown command")) return {MarlinReply::Kind::Refused};
  if (contains(line, "Homing Failed")) return {MarlinReply::Kind::HomingFailed};
  if (const auto height = reported_height(line)) return {MarlinReply::Kind::Position, 0, *height};
  return {};
}

}  // namespace mezzotint
