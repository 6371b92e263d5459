#include "forward/pattern/pattern_map.h"

#include <cmath>

#include "forward/base/error.h"

namespace mezzotint {

namespace {

constexpr const char* too_small =
    "the tile holds less than one period of the pattern; take a larger tile or shorter lengths";

void round_u(PatternMap& map, const Sheet& sheet) {
  map.ux = std::round(map.ux * sheet.width_um()) / sheet.width_um();
  map.uy = std::round(map.uy * sheet.depth_um()) / sheet.depth_um();
}
void round_v(PatternMap& map, const Sheet& sheet) {
  map.vx = std::round(map.vx * sheet.width_um()) / sheet.width_um();
  map.vy = std::round(map.vy * sheet.depth_um()) / sheet.depth_um();
}

// The pattern's own origin stays where it is: the whole plane is changed alike, so that a shift by a tile is none.
void keep_origin(PatternMap& map, const PatternMap& wanted) {
  const double x = (wanted.vy * wanted.u0 - wanted.uy * wanted.v0) / wanted.determinant();
  const double y = (wanted.ux * wanted.v0 - wanted.vx * wanted.u0) / wanted.determinant();
  map.u0 = map.ux * x + map.uy * y;
  map.v0 = map.vx * x + map.vy * y;
}

}  // namespace

PatternMap turned(const PatternMap& map, Angle direction) {
  const double c = std::cos(direction.radians()), s = std::sin(direction.radians());
  return {c * map.ux + s * map.vx, c * map.uy + s * map.vy, c * map.vx - s * map.ux,
          c * map.vy - s * map.uy, c * map.u0 + s * map.v0, c * map.v0 - s * map.u0};
}

PatternMap in_units(const PatternMap& map, double unit_u, double unit_v) {
  return {map.ux / unit_u, map.uy / unit_u, map.vx / unit_v, map.vy / unit_v, map.u0 / unit_u, map.v0 / unit_v};
}

PatternMap moved(PatternMap map, double u, double v) {
  map.u0 += u;
  map.v0 += v;
  return map;
}

PatternMap scaled(const PatternMap& map, double u, double v) {
  return {u * map.ux, u * map.uy, v * map.vx, v * map.vy, u * map.u0, v * map.v0};
}

PatternMap sum(const PatternMap& a, const PatternMap& b) {
  return {a.ux + b.ux, a.uy + b.uy, a.vx + b.vx, a.vy + b.vy, a.u0 + b.u0, a.v0 + b.v0};
}

PatternMap fitted(PatternMap map, const Sheet& sheet) {
  if (sheet.continuation != Continuation::Periodic) return map;
  const PatternMap wanted = map;
  round_u(map, sheet);
  round_v(map, sheet);
  // In periods a tile, where the smallest determinant of whole numbers is 1.
  require(std::abs(map.determinant()) * sheet.width_um() * sheet.depth_um() > 0.5, too_small);
  keep_origin(map, wanted);
  return map;
}

PatternMap fitted_along_u(PatternMap map, const Sheet& sheet) {
  if (sheet.continuation != Continuation::Periodic) return map;
  const PatternMap wanted = map;
  round_u(map, sheet);
  require(map.ux != 0.0 || map.uy != 0.0, too_small);
  keep_origin(map, wanted);
  return map;
}

}  // namespace mezzotint
