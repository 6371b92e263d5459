#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <fmt/format.h>

#include "forward/base/error.h"
#include "measurement/formats/plain_parsers.h"
#include "measurement/formats/text_scanner.h"
#include "measurement/formats/text_values.h"

namespace mezzotint {

namespace {

struct Point {
  double x = 0.0, y = 0.0, z = 0.0;
};

// How far a point may lie from its place on the grid, in pitches: coordinates are printed with few digits.
constexpr double largest_deviation = 0.05;
// Points that fill less of their grid than this are no grid.
constexpr std::size_t least_filled = 16;

double coordinate(std::string_view cell, const TextScanner& scanner) {
  const double value = height_of_cell(cell, scanner);
  if (!std::isfinite(value)) scanner.fail("a point without a place; x and y must be numbers");
  return value;
}

bool is_comment(std::string_view line) { return line.empty() || line.front() == '#' || line.front() == '%'; }

std::vector<Point> take_points(TextScanner& scanner) {
  std::vector<Point> points;
  char separator = ' ';
  while (!scanner.at_end()) {
    std::string_view line = trimmed(scanner.take_line());
    if (is_comment(line)) continue;
    if (points.empty()) separator = separator_of(line);
    Point point;
    point.x = coordinate(take_cell(line, separator), scanner);
    point.y = coordinate(take_cell(line, separator), scanner);
    point.z = height_of_cell(take_cell(line, separator), scanner);
    if (!line.empty()) scanner.fail("more than three numbers; a line holds x, y and z");
    points.push_back(point);
  }
  if (points.empty()) scanner.fail("holds no points");
  return points;
}

/// Evenly spaced places along one axis.
struct Axis {
  double first = 0.0, pitch = 0.0;
  std::uint64_t count = 0;

  [[nodiscard]] double place(double value) const { return (value - first) / pitch; }
};

std::vector<double> distinct(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const double same = 1e-9 * (values.back() - values.front());
  const auto end =
      std::unique(values.begin(), values.end(), [&](double a, double b) { return std::abs(b - a) <= same; });
  values.erase(end, values.end());
  return values;
}

bool fits(const Axis& axis, const std::vector<double>& places) {
  return std::all_of(places.begin(), places.end(), [&](double value) {
    const double place = axis.place(value);
    return std::abs(place - std::round(place)) <= largest_deviation;
  });
}

// As many places as there are values; and where whole lines are missing, as the smallest step between two tells.
Axis evenly_spaced(const std::filesystem::path& path, const std::vector<Point>& points, double Point::*member) {
  const char* const name = member == &Point::x ? "x" : "y";
  std::vector<double> values;
  values.reserve(points.size());
  for (const Point& point : points) values.push_back(point.*member);
  const std::vector<double> places = distinct(std::move(values));
  if (places.size() < 2) throw FileError(path, name, "is the same for all points; a grid has at least 2 × 2");
  const double length = places.back() - places.front();
  double smallest = length;
  for (std::size_t i = 1; i < places.size(); ++i) smallest = std::min(smallest, places[i] - places[i - 1]);
  for (const double steps : {static_cast<double>(places.size() - 1), std::round(length / smallest)}) {
    const Axis axis{places.front(), length / steps, static_cast<std::uint64_t>(steps) + 1};
    if (fits(axis, places)) return axis;
  }
  throw FileError(path, name,
                  fmt::format("has {} places from {} to {} that are not evenly spaced; a regular grid is needed",
                              places.size(), places.front(), places.back()));
}

std::vector<double> heights_on(const std::filesystem::path& path, const std::vector<Point>& points, const Axis& x,
                               const Axis& y) {
  std::vector<double> heights(x.count * y.count, std::numeric_limits<double>::quiet_NaN());
  std::vector<bool> taken(heights.size());
  for (const Point& point : points) {
    const auto column = static_cast<std::size_t>(std::round(x.place(point.x)));
    const auto row = static_cast<std::size_t>(std::round(y.place(point.y)));
    const std::size_t i = row * x.count + column;
    if (taken[i]) throw FileError(path, "", fmt::format("has two points at ({}, {})", point.x, point.y));
    taken[i] = true;
    if (std::isfinite(point.z)) heights[i] = point.z;
  }
  return heights;
}

}  // namespace

SurfaceFile parse_xyz(const std::filesystem::path& path, std::span<const std::byte> bytes, const Sidecar& sidecar) {
  const double xy_m = required_scale_um(path, sidecar.xy_um, "xy_um") * 1e-6;
  const double z_m = required_scale_um(path, sidecar.value_um, "value_um") * 1e-6;
  TextScanner scanner(path, bytes);
  const std::vector<Point> points = take_points(scanner);
  const Axis x = evenly_spaced(path, points, &Point::x), y = evenly_spaced(path, points, &Point::y);
  const Grid grid = checked_grid(path, "grid", {x.count, y.count, x.pitch * xy_m, y.pitch * xy_m});
  if (points.size() < grid.size() / least_filled) {
    throw FileError(path, "grid",
                    fmt::format("{} points on {} × {} places; a grid is filled to a sixteenth at least", points.size(),
                                grid.columns, grid.rows));
  }
  const std::vector<double> heights = heights_on(path, points, x, y);
  const auto height_m = [&](std::size_t i) { return heights[i] * z_m + sidecar.datum_um * 1e-6; };
  HeightField field = assemble_heights(path, "points", grid, FirstRow::Bottom, sidecar_continuation(sidecar), height_m);
  return {std::move(field), "xyz", sidecar.title, sidecar.provenance, ""};
}

}  // namespace mezzotint
