#include "forward/pattern/pattern_parameters.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "forward/base/error.h"
#include "forward/pattern/pattern_tree.h"

namespace mezzotint {

namespace {

constexpr double largest_length_um = 1e5;

PatternParameter length(std::string name) { return {std::move(name), 0.1, largest_length_um, true}; }
PatternParameter direction() { return {"direction_deg", -360.0, 360.0, false}; }
PatternParameter height() { return {"height_um", 1e-3, 1e4, true}; }
PatternParameter stretch() { return {"stretch", 1.0, 64.0, true}; }
PatternParameter place(std::string name) { return {std::move(name), -1e6, 1e6, false}; }
PatternParameter whole(std::string name, double low, double high) { return {std::move(name), low, high, false, true}; }

PatternParameter phase(std::string name) { return {.name = std::move(name), .highest = 1.0, .drawn = true}; }

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
      Table{length("wavelength_u_um"), length("wavelength_v_um"), direction(), height(), phase("phase_u"),
            phase("phase_v")},
      Table{length("wavelength_um"), direction(), height(), {"skew", 0.01, 0.99, false}, phase("phase")},
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
  return {{.length = &p.wavelength_u}, {.length = &p.wavelength_v}, {.angle = &p.direction},
          {.length = &p.height},       {.number = &p.phase_u},      {.number = &p.phase_v}};
}
Slots slots(Ridges& p) {
  return {{.length = &p.wavelength},
          {.angle = &p.direction},
          {.length = &p.height},
          {.number = &p.skew},
          {.number = &p.phase}};
}
Slots slots(PatternSum&) { return {}; }
Slots slots(PatternProduct& p) { return {{.length = &p.height}}; }
Slots slots(TurnedPattern& p) { return {{.angle = &p.rotation}, {.length = &p.centre.x}, {.length = &p.centre.y}}; }
Slots slots(MaskedPattern& p) { return {{.number = &p.threshold}, {.number = &p.softness}}; }
Slots slots(PatternRegions& p) { return {{.length = &p.pixel}, {.length = &p.corner.x}, {.length = &p.corner.y}}; }

// For a message: a pattern's own numbers, and its parts.
std::string what_it_has(const Pattern& pattern) {
  constexpr std::size_t most_named = 16;
  std::vector<std::string> names;
  for (const PatternParameter& parameter : pattern_parameters(pattern)) names.push_back(parameter.name);
  const auto* parts = parts_of(pattern);
  for (std::size_t i = 0; parts != nullptr && i < parts->size() && names.size() < most_named; ++i) {
    names.push_back(part_name(kind_name(pattern), i) + ".…");
  }
  return names.empty() ? "nothing yet" : fmt::format("{}", fmt::join(names, ", "));
}

[[noreturn]] void complain(const Pattern& pattern, std::string_view name) {
  throw InvalidInput(
      fmt::format("a pattern of kind \"{}\" has no \"{}\"; it has {}", kind_name(pattern), name, what_it_has(pattern)));
}

// Which of a simple or composed pattern's own numbers has that name.
std::size_t index_of(const Pattern& pattern, std::string_view name) {
  const Table& table = pattern_parameters(pattern);
  const auto found = std::ranges::find(table, name, &PatternParameter::name);
  if (found == table.end()) complain(pattern, name);
  return static_cast<std::size_t>(found - table.begin());
}

std::size_t index_of_part(const Pattern& pattern, std::string_view name) {
  const auto* parts = parts_of(pattern);
  for (std::size_t i = 0; parts != nullptr && i < parts->size(); ++i) {
    if (part_name(kind_name(pattern), i) == name) return i;
  }
  complain(pattern, name);
}

struct Path {
  std::string_view part;  ///< empty: the number is the pattern's own
  std::string_view rest;
};
Path split(std::string_view path) {
  const std::size_t point = path.find('.');
  if (point == std::string_view::npos) return {{}, path};
  return {path.substr(0, point), path.substr(point + 1)};
}

// The pattern in a composition that has the number, and what that calls it.
struct Found {
  const Pattern& pattern;
  std::string_view name;
};
Found follow(const Pattern& pattern, std::string_view path) {
  const auto [part, rest] = split(path);
  if (part.empty()) return {pattern, path};
  return follow((*parts_of(pattern))[index_of_part(pattern, part)].pattern, rest);
}

Pattern& part_at(Pattern& pattern, std::size_t index) {
  return std::visit(
      [&]<typename Kind>(Kind& kind) -> Pattern& {
        if constexpr (Composed<Kind>) return kind.parts.at(index).pattern;
        return pattern;
      },
      pattern);
}

bool counts_by_shape(const Pattern& pattern, std::size_t part, bool itself) {
  if (std::holds_alternative<PatternProduct>(pattern)) return true;
  if (std::holds_alternative<MaskedPattern>(pattern)) return part == 2;
  return std::holds_alternative<TurnedPattern>(pattern) && itself;
}

void add_parameters(const Pattern& pattern, const std::string& path, bool by_shape, Table& into) {
  for (const PatternParameter& own : pattern_parameters(pattern)) {
    if (by_shape && own.name == "height_um") continue;
    into.push_back(own);
    into.back().name = path + own.name;
  }
  const auto* parts = parts_of(pattern);
  for (std::size_t i = 0; parts != nullptr && i < parts->size(); ++i) {
    add_parameters((*parts)[i].pattern, path + part_name(kind_name(pattern), i) + ".",
                   counts_by_shape(pattern, i, by_shape), into);
  }
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

std::string why_fixed(const PatternParameter& parameter) {
  const auto say = [&](const char* what) { return fmt::format("\"{}\" is {}", parameter.name, what); };
  if (parameter.whole) return say("a whole number, which a search cannot change; give it a value");
  if (parameter.drawn) return say("drawn anew by a search, as the seeds of noise are; leave it out");
  return {};
}

const std::vector<PatternParameter>& pattern_parameters(const Pattern& pattern) { return tables().at(pattern.index()); }

std::string part_name(std::string_view kind, std::size_t index) {
  if (kind == "rotate") return "part";
  if (kind != "mask") return fmt::format("parts[{}]", index);
  static const std::array<const char*, 3> names = {"inside", "outside", "mask"};
  return names.at(index);
}

std::vector<PatternParameter> all_parameters(const Pattern& pattern) {
  Table all;
  add_parameters(pattern, "", false, all);
  return all;
}

PatternParameter find_parameter(const Pattern& pattern, std::string_view path) {
  const Table all = all_parameters(pattern);
  const auto found = std::ranges::find(all, path, &PatternParameter::name);
  if (found != all.end()) return *found;
  const Found at = follow(pattern, path);
  (void)index_of(at.pattern, at.name);
  throw InvalidInput(fmt::format("\"{}\" means nothing: a factor or a mask counts by its shape alone", path));
}

std::string_view last_name(std::string_view path) {
  const std::size_t point = path.rfind('.');
  return point == std::string_view::npos ? path : path.substr(point + 1);
}

double get_parameter(const Pattern& pattern, std::string_view path) {
  const Found at = follow(pattern, path);
  const std::size_t index = index_of(at.pattern, at.name);
  return std::visit([index](auto kind) { return slots(kind)[index].read(); }, at.pattern);
}

void set_parameter(Pattern& pattern, std::string_view path, double value) {
  if (const auto [part, rest] = split(path); !part.empty()) {
    set_parameter(part_at(pattern, index_of_part(pattern, part)), rest, value);
    return;
  }
  const std::size_t index = index_of(pattern, path);
  std::visit([&](auto& kind) { slots(kind)[index].write(value); }, pattern);
}

}  // namespace mezzotint
