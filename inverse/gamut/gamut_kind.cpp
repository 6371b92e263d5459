#include "inverse/gamut/gamut_kind.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "forward/base/error.h"
#include "forward/pattern/pattern_parameters.h"

namespace mezzotint {

namespace {

// Steeper flanks than these are narrower than pixels at any wavelength that gives slopes.
constexpr double least_skew = 0.2, largest_skew = 0.8;

struct Room {
  double least_um, longest_um, least_height_um, height_um;
};

Room room_of(const PrinterProfile& printer, const GamutBounds& bounds) {
  require_valid(printer);
  const Room room{bounds.least_pixels * printer.pixel_pitch.um(), bounds.longest.um(), bounds.least_height.um(),
                  reachable_height(printer).um()};
  require(std::isfinite(bounds.least_pixels) && bounds.least_pixels >= 2.0,
          "the shortest wavelength must be at least 2 pixels; below, pixels cannot show it");
  require(std::isfinite(room.longest_um) && room.longest_um > room.least_um,
          fmt::format("the longest length, {:.6g} um, must exceed the shortest one, {:.6g} um ({:.4g} pixels)",
                      room.longest_um, room.least_um, bounds.least_pixels));
  require(room.least_height_um > 0.0 && room.least_height_um < room.height_um,
          fmt::format("the least height must lie between 0 and the {:.4g} um that one layer reaches", room.height_um));
  return room;
}

// The free numbers of a simple kind; of octaves the finest one must keep its pixels.
std::vector<GamutParameter> free_of(const std::string& name, std::size_t part, const Room& room) {
  const GamutParameter height{part, "height_um", room.least_height_um, room.height_um};
  const double stretch = std::min(64.0, room.longest_um / room.least_um);
  if (name == "noise")
    return {{part, "scale_um", room.least_um, room.longest_um}, {part, "stretch", 1.0, stretch}, height};
  if (name == "fbm") {
    const FractionalBrownianMotion motion;
    const double least_um = room.least_um * std::pow(motion.lacunarity, motion.octaves - 1);
    require(least_um < room.longest_um,
            fmt::format("fbm of {} octaves needs a longest length above {:.4g} um", motion.octaves, least_um));
    return {{part, "scale_um", least_um, room.longest_um}, {part, "stretch", 1.0, stretch}, height};
  }
  if (name == "line_integral_convolution")
    return {{part, "scale_um", room.least_um, room.longest_um}, {part, "length_um", 1.0, room.longest_um}, height};
  if (name == "sinusoid")
    return {{part, "wavelength_u_um", room.least_um, room.longest_um},
            {part, "wavelength_v_um", room.least_um, room.longest_um},
            height};
  return {{part, "wavelength_um", room.least_um, room.longest_um}, {part, "skew", least_skew, largest_skew}, height};
}

std::vector<std::string> parts_named(const std::string& name) {
  std::vector<std::string> parts{""};
  for (const char letter : name) {
    if (letter == '+')
      parts.emplace_back();
    else
      parts.back() += letter;
  }
  return parts;
}

Pattern& part_of(Pattern& pattern, std::size_t index) {
  auto* sum = std::get_if<PatternSum>(&pattern);
  return sum == nullptr ? pattern : sum->parts.at(index).pattern;
}

}  // namespace

const std::vector<std::string>& gamut_kind_names() {
  static const std::vector<std::string> names = {
      "noise", "fbm", "line_integral_convolution", "sinusoid", "ridges", "ridges+sinusoid", "ridges+sinusoid+noise"};
  return names;
}

GamutKind gamut_kind(const std::string& name, const PrinterProfile& printer, const GamutBounds& bounds) {
  const auto& names = gamut_kind_names();
  require(std::ranges::find(names, name) != names.end(),
          fmt::format("the gamut knows no pattern \"{}\"; it knows {}", name, fmt::join(names, ", ")));
  const Room room = room_of(printer, bounds);
  const std::vector<std::string> parts = parts_named(name);
  GamutKind kind{name, default_pattern(parts.front()), {}};
  if (parts.size() > 1) {
    PatternSum sum;
    for (const std::string& part : parts) sum.parts.push_back({default_pattern(part)});
    kind.pattern = sum;
  }
  for (std::size_t part = 0; part < parts.size(); ++part) {
    for (GamutParameter& free : free_of(parts[part], part, room)) kind.free.push_back(std::move(free));
  }
  return kind;
}

Pattern pattern_of(const GamutKind& kind, const std::vector<double>& values, const PrinterProfile& printer) {
  require(values.size() == kind.free.size(), "one value a free number is needed");
  Pattern pattern = kind.pattern;
  for (std::size_t i = 0; i < values.size(); ++i)
    set_parameter(part_of(pattern, kind.free[i].part), kind.free[i].name, values[i]);
  const double excess = height_of(pattern) / reachable_height(printer);
  if (excess > 1.0) return pattern_of(kind, with_heights(kind, values, (1.0 - 1e-9) / excess), printer);
  return pattern;
}

std::vector<double> with_heights(const GamutKind& kind, std::vector<double> values, double factor) {
  for (std::size_t i = 0; i < values.size(); ++i)
    if (kind.free[i].name == "height_um") values[i] *= factor;
  return values;
}

Pattern turned(Pattern pattern, Angle direction) {
  if (auto* sum = std::get_if<PatternSum>(&pattern)) {
    for (PatternPart& part : sum->parts) part.pattern = turned(part.pattern, direction);
  } else {
    set_parameter(pattern, "direction_deg", get_parameter(pattern, "direction_deg") + direction.degrees());
  }
  return pattern;
}

}  // namespace mezzotint
