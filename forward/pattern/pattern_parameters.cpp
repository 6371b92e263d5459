#include "forward/pattern/pattern_parameters.h"

#include <algorithm>
#include <array>

#include "forward/base/error.h"

namespace mezzotint {

namespace {

constexpr double largest_length_um = 1e5;

PatternParameter length(std::string_view name) { return {name, 0.1, largest_length_um, true}; }
PatternParameter direction() { return {"direction_deg", -360.0, 360.0, false}; }
PatternParameter height() { return {"height_um", 1e-3, 1e4, true}; }

using Table = std::vector<PatternParameter>;

const std::array<Table, std::variant_size_v<Pattern>>& tables() {
  static const std::array<Table, std::variant_size_v<Pattern>> all = {
      Table{length("scale_um"), {"stretch", 1.0, 64.0, true}, direction(), height()},
      Table{length("wavelength_u_um"), length("wavelength_v_um"), direction(), height()},
      Table{length("wavelength_um"), direction(), height(), {"skew", 0.01, 0.99, false}}};
  return all;
}

// A member of a pattern, seen as a number in the unit of its name.
struct Slot {
  Length* length = nullptr;
  Angle* angle = nullptr;
  double* number = nullptr;

  [[nodiscard]] double read() const {
    if (length != nullptr) return length->um();
    return angle != nullptr ? angle->degrees() : *number;
  }
  void write(double value) const {
    if (length != nullptr) {
      *length = Length::from_um(value);
    } else if (angle != nullptr) {
      *angle = Angle::from_degrees(value);
    } else {
      *number = value;
    }
  }
};

// In the order of the kind's table.
std::array<Slot, 4> slots(Noise& p) {
  return {Slot{.length = &p.scale}, {.number = &p.stretch}, {.angle = &p.direction}, {.length = &p.height}};
}
std::array<Slot, 4> slots(Sinusoid& p) {
  return {Slot{.length = &p.wavelength_u}, {.length = &p.wavelength_v}, {.angle = &p.direction}, {.length = &p.height}};
}
std::array<Slot, 4> slots(Ridges& p) {
  return {Slot{.length = &p.wavelength}, {.angle = &p.direction}, {.length = &p.height}, {.number = &p.skew}};
}

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
  static const std::vector<std::string_view> kinds = {"noise", "sinusoid", "ridges"};
  return kinds;
}

Pattern default_pattern(std::string_view kind) {
  if (kind == "noise") return Noise{};
  if (kind == "sinusoid") return Sinusoid{};
  if (kind == "ridges") return Ridges{};
  throw InvalidInput("unknown pattern kind \"" + std::string(kind) + "\"; known: noise, sinusoid, ridges");
}

const std::vector<PatternParameter>& pattern_parameters(const Pattern& pattern) { return tables().at(pattern.index()); }

double get_parameter(const Pattern& pattern, std::string_view name) {
  Pattern copy = pattern;
  return slot(copy, name).read();
}

void set_parameter(Pattern& pattern, std::string_view name, double value) { slot(pattern, name).write(value); }

}  // namespace mezzotint
