#include "forward/pattern/pattern_place.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "forward/pattern/pattern_parameters.h"

namespace mezzotint {

namespace {

constexpr double radians_a_degree = std::numbers::pi / 180.0;

// ∂turned(map, direction)/∂direction, a degree: the map turned by a right angle more.
PatternMap turned_slope(const PatternMap& map, Angle direction) {
  const PatternMap further = turned(map, Angle::from_radians(direction.radians() + std::numbers::pi / 2.0));
  return scaled(further, radians_a_degree, radians_a_degree);
}

// By how much, relatively, the units of u and v grow with a number.
struct UnitSlopes {
  const char* name;
  double u, v;
};
std::vector<UnitSlopes> of_scale(Length scale) { return {{"scale_um", 1.0 / scale.um(), 1.0 / scale.um()}}; }
std::vector<UnitSlopes> of_cells(Length scale, double stretch) {
  std::vector<UnitSlopes> slopes = of_scale(scale);
  slopes.push_back({"stretch", 0.0, 1.0 / stretch});
  return slopes;
}
std::vector<UnitSlopes> unit_slopes(const Noise& noise) { return of_cells(noise.scale, noise.stretch); }
std::vector<UnitSlopes> unit_slopes(const FractionalBrownianMotion& motion) {
  return of_cells(motion.scale, motion.stretch);
}
std::vector<UnitSlopes> unit_slopes(const Turbulence& turbulence) {
  return of_cells(turbulence.scale, turbulence.stretch);
}
std::vector<UnitSlopes> unit_slopes(const LineIntegralConvolution& lines) { return of_scale(lines.scale); }
std::vector<UnitSlopes> unit_slopes(const Sinusoid& sinusoid) {
  return {{"wavelength_u_um", 1.0 / sinusoid.wavelength_u.um(), 0.0},
          {"wavelength_v_um", 0.0, 1.0 / sinusoid.wavelength_v.um()}};
}
std::vector<UnitSlopes> unit_slopes(const Ridges& ridges) {
  return {{"wavelength_um", 1.0 / ridges.wavelength.um(), 1.0 / ridges.wavelength.um()}};
}

template <typename Kind>
SteepMap steep_map_of(const Kind& kind, const PatternPlace& place) {
  SteepMap result{map_of(kind, place.sheet), {}};
  for (const PatternMap& slope : place.slopes) result.slopes.push_back(map_without_phase(kind, slope));
  const auto add = [&](const char* name, const auto& slope) {
    if (const auto number = place.find(name)) result.slopes[*number] = sum(result.slopes[*number], slope());
  };
  const Units units = units_of(kind);
  add("direction_deg", [&] { return in_units(turned_slope(place.sheet.place, kind.direction), units.u, units.v); });
  for (const UnitSlopes& grows : unit_slopes(kind)) {
    add(grows.name, [&] { return scaled(map_without_phase(kind, place.sheet.place), -grows.u, -grows.v); });
  }
  // A phase is what it is whatever the other numbers are.
  add("phase_u", [] { return moved(no_map, 1.0, 0.0); });
  add("phase_v", [] { return moved(no_map, 0.0, 1.0); });
  add("phase", [] { return moved(no_map, 1.0, 0.0); });
  return result;
}

// Whose height is a composition's: all that are added, or the one that is largest; none where it has one of its own.
std::vector<std::size_t> parts_of_height(const Pattern& pattern) {
  const auto* parts = parts_of(pattern);
  if (parts == nullptr || std::holds_alternative<PatternProduct>(pattern)) return {};
  std::vector<std::size_t> found;
  const std::size_t count = std::holds_alternative<MaskedPattern>(pattern) ? 2 : parts->size();
  for (std::size_t i = 0; i < count; ++i) {
    if (std::holds_alternative<PatternSum>(pattern) || height_of((*parts)[i].pattern) == height_of(pattern)) {
      found.push_back(i);
    }
  }
  if (!std::holds_alternative<PatternSum>(pattern)) found.resize(1);
  return found;
}

}  // namespace

std::optional<std::size_t> PatternPlace::find(std::string_view name) const {
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (names[i].size() == path.size() + name.size() && names[i].starts_with(path) && names[i].ends_with(name)) {
      return i;
    }
  }
  return {};
}

PatternPlace whole_place(const Sheet& sheet, std::span<const std::string> names) {
  return {sheet, names, std::vector<PatternMap>(names.size(), no_map), ""};
}

PatternPlace place_below(const PatternPlace& place, std::string_view kind, std::size_t part) {
  PatternPlace below = place;
  below.path += part_name(kind, part) + ".";
  return below;
}

PatternPlace place_below(const PatternPlace& place, const TurnedPattern& turned_pattern) {
  PatternPlace below = place_below(place, "rotate", 0);
  below.sheet = sheet_below(turned_pattern, place.sheet);
  for (PatternMap& slope : below.slopes) slope = turned(slope, turned_pattern.rotation);
  const double c = std::cos(turned_pattern.rotation.radians()), s = std::sin(turned_pattern.rotation.radians());
  const auto add = [&](const char* name, const PatternMap& slope) {
    if (const auto number = place.find(name)) below.slopes[*number] = sum(below.slopes[*number], slope);
  };
  const PatternMap about_centre =
      moved(place.sheet.place, -turned_pattern.centre.x.um(), -turned_pattern.centre.y.um());
  add("rotation_deg", turned_slope(about_centre, turned_pattern.rotation));
  add("centre_x_um", moved(no_map, 1.0 - c, s));
  add("centre_y_um", moved(no_map, -s, 1.0 - c));
  return below;
}

bool SteepMap::moves(std::size_t number) const {
  const PatternMap& slope = slopes[number];
  return slope.ux != 0.0 || slope.uy != 0.0 || slope.vx != 0.0 || slope.vy != 0.0 || slope.u0 != 0.0 || slope.v0 != 0.0;
}

SteepMap steep_map(const Noise& noise, const PatternPlace& place) { return steep_map_of(noise, place); }
SteepMap steep_map(const FractionalBrownianMotion& motion, const PatternPlace& place) {
  return steep_map_of(motion, place);
}
SteepMap steep_map(const Turbulence& turbulence, const PatternPlace& place) { return steep_map_of(turbulence, place); }
SteepMap steep_map(const LineIntegralConvolution& lines, const PatternPlace& place) {
  return steep_map_of(lines, place);
}
SteepMap steep_map(const Sinusoid& sinusoid, const PatternPlace& place) { return steep_map_of(sinusoid, place); }
SteepMap steep_map(const Ridges& ridges, const PatternPlace& place) { return steep_map_of(ridges, place); }

SteepHeight steep_height(const Pattern& pattern, const std::string& path, std::span<const std::string> names) {
  SteepHeight height{height_of(pattern).um(), std::vector<double>(names.size(), 0.0)};
  if (names.empty()) return height;
  for (const std::size_t index : parts_of_height(pattern)) {
    const SteepHeight part =
        steep_height((*parts_of(pattern))[index].pattern, path + part_name(kind_name(pattern), index) + ".", names);
    for (std::size_t k = 0; k < names.size(); ++k) height.slopes[k] += part.slopes[k];
  }
  const auto own = std::ranges::find(names, path + "height_um");
  if (own != names.end() && parts_of_height(pattern).empty()) height.slopes[std::size_t(own - names.begin())] = 1.0;
  return height;
}

}  // namespace mezzotint
