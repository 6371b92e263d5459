#include "forward/pattern/pattern_parameters.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "forward/base/error.h"

namespace mezzotint {

namespace {

constexpr double largest_length_um = 1e5;

PatternParameter length(std::string_view name) { return {name, 0.1, largest_length_um, true}; }
PatternParameter direction() { return {"direction_deg", -360.0, 360.0, false}; }
PatternParameter height() { return {"height_um", 1e-3, 1e4, true}; }
PatternParameter stretch() { return {"stretch", 1.0, 64.0, true}; }
PatternParameter place(std::string_view name) { return {name, -1e6, 1e6, false}; }
PatternParameter whole(std::string_view name, double low, double high) { return {name, low, high, false, true}; }

using Table = std::vector<PatternParameter>;

const std::array<Table, std::variant_size_v<Pattern>>& tables() {
  static const std::array<Table, std::variant_size_v<Pattern>> all = {
      Table{length("scale_um"), stretch(), direction(), height()},
      Table{length("scale_um"),
            stretch(),
            direction(),
            height(),
            {"hurst", 0.0, 1.0, false},
            {"lacunarity", 1.1, 8.0, true},
            whole("octaves", 1, 16)},
      Table{length("scale_um"), stretch(), direction(), height(), whole("octaves", 1, 16)},
      Table{length("scale_um"), length("length_um"), direction(), height()},
      Table{length("wavelength_u_um"), length("wavelength_v_um"), direction(), height()},
      Table{length("wavelength_um"), direction(), height(), {"skew", 0.01, 0.99, false}},
      Table{},
      Table{height()},
      Table{{"rotation_deg", -360.0, 360.0, false}, place("centre_x_um"), place("centre_y_um")},
      Table{{"threshold", 0.0, 1.0, false}, {"softness", 0.0, 1.0, false}},
      Table{length("pixel_um"), place("corner_x_um"), place("corner_y_um")}};
  return all;
}

// A member of a pattern, seen as a number in the unit of its name.
struct Slot {
  Length* length = nullptr;
  Angle* angle = nullptr;
  double* number = nullptr;
  int* whole = nullptr;

  [[nodiscard]] double read() const {
    if (length != nullptr) return length->um();
    if (whole != nullptr) return *whole;
    return angle != nullptr ? angle->degrees() : *number;
  }
  void write(double value) const {
    if (length != nullptr) {
      *length = Length::from_um(value);
    } else if (angle != nullptr) {
      *angle = Angle::from_degrees(value);
    } else if (whole != nullptr) {
      *whole = static_cast<int>(std::lround(value));
    } else {
      *number = value;
    }
  }
};

using Slots = std::vector<Slot>;

// In the order of the kind's table.
template <typename Kind>
Slots noise_slots(Kind& p) {
  return {{.length = &p.scale}, {.number = &p.stretch}, {.angle = &p.direction}, {.length = &p.height}};
}
Slots slots(Noise& p) { return noise_slots(p); }
Slots slots(FractionalBrownianMotion& p) {
  Slots all = noise_slots(p);
  all.insert(all.end(), {{.number = &p.hurst}, {.number = &p.lacunarity}, {.whole = &p.octaves}});
  return all;
}
Slots slots(Turbulence& p) {
  Slots all = noise_slots(p);
  all.push_back({.whole = &p.octaves});
  return all;
}
Slots slots(LineIntegralConvolution& p) {
  return {{.length = &p.scale}, {.length = &p.length}, {.angle = &p.direction}, {.length = &p.height}};
}
Slots slots(Sinusoid& p) {
  return {{.length = &p.wavelength_u}, {.length = &p.wavelength_v}, {.angle = &p.direction}, {.length = &p.height}};
}
Slots slots(Ridges& p) {
  return {{.length = &p.wavelength}, {.angle = &p.direction}, {.length = &p.height}, {.number = &p.skew}};
}
Slots slots(PatternSum&) { return {}; }
Slots slots(PatternProduct& p) { return {{.length = &p.height}}; }
Slots slots(TurnedPattern& p) { return {{.angle = &p.rotation}, {.length = &p.centre.x}, {.length = &p.centre.y}}; }
Slots slots(MaskedPattern& p) { return {{.number = &p.threshold}, {.number = &p.softness}}; }
Slots slots(PatternRegions& p) { return {{.length = &p.pixel}, {.length = &p.corner.x}, {.length = &p.corner.y}}; }

Slot slot(Pattern& pattern, std::string_view name) {
  const Table& table = pattern_parameters(pattern);
  const auto found = std::ranges::find(table, name, &PatternParameter::name);
  require(found != table.end(),
          "a pattern of kind \"" + std::string(kind_name(pattern)) + "\" has no \"" + std::string(name) + "\"");
  const auto index = static_cast<std::size_t>(found - table.begin());
  return std::visit([&](auto& kind) { return slots(kind)[index]; }, pattern);
}

}  // namespace

const std::vector<std::string_view>& pattern_kinds() {
  static const std::vector<std::string_view> kinds = {"noise",    "fbm",    "turbulence", "line_integral_convolution",
                                                      "sinusoid", "ridges", "sum",        "product",
                                                      "rotate",   "mask",   "regions"};
  return kinds;
}

Pattern default_pattern(std::string_view kind) {
  static const std::array<Pattern, std::variant_size_v<Pattern>> defaults = {
      Noise{},      FractionalBrownianMotion{}, Turbulence{},    LineIntegralConvolution{}, Sinusoid{},      Ridges{},
      PatternSum{}, PatternProduct{},           TurnedPattern{}, MaskedPattern{},           PatternRegions{}};
  const auto found = std::ranges::find(pattern_kinds(), kind);
  if (found == pattern_kinds().end()) {
    throw InvalidInput(fmt::format("unknown pattern kind \"{}\"; known: {}", kind, fmt::join(pattern_kinds(), ", ")));
  }
  return defaults.at(static_cast<std::size_t>(found - pattern_kinds().begin()));
}

const std::vector<PatternParameter>& pattern_parameters(const Pattern& pattern) { return tables().at(pattern.index()); }

double get_parameter(const Pattern& pattern, std::string_view name) {
  Pattern copy = pattern;
  return slot(copy, name).read();
}

void set_parameter(Pattern& pattern, std::string_view name, double value) { slot(pattern, name).write(value); }

}  // namespace mezzotint
