#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <utility>
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

// visit(point) line by line; how many there are. The text is gone through twice, since a number takes less room in it
// than three do in memory.
template <class Visit>
std::size_t for_each_point(const std::filesystem::path& path, std::span<const std::byte> bytes, const Visit& visit) {
  TextScanner scanner(path, bytes);
  std::size_t count = 0;
  char separator = ' ';
  while (!scanner.at_end()) {
    std::string_view line = trimmed(scanner.take_line());
    if (is_comment(line)) continue;
    if (count == 0) separator = separator_of(line);
    Point point;
    point.x = coordinate(take_cell(line, separator), scanner);
    point.y = coordinate(take_cell(line, separator), scanner);
    point.z = height_of_cell(take_cell(line, separator), scanner);
    if (!line.empty()) scanner.fail("more than three numbers; a line holds x, y and z");
    visit(point);
    ++count;
  }
  if (count == 0) scanner.fail("holds no points");
  return count;
}

/// The different values among many; memory for a few times as many as there are.
class DistinctValues {
public:
  void add(double value) {
    if (!values_.empty() && value == values_.back()) return;
    values_.push_back(value);
    if (values_.size() < room_) return;
    sort();
    room_ = std::max(room_, 2 * values_.size());
  }
  [[nodiscard]] std::vector<double> sorted() && {
    sort();
    return std::move(values_);
  }

private:
  void sort() {
    std::sort(values_.begin(), values_.end());
    values_.erase(std::unique(values_.begin(), values_.end()), values_.end());
  }

  std::vector<double> values_;
  std::size_t room_ = std::size_t{1} << 16;
};

/// Evenly spaced places along one axis.
struct Axis {
  double first = 0.0, pitch = 0.0;
  std::uint64_t count = 0;

  [[nodiscard]] double place(double value) const { return (value - first) / pitch; }
};

// Values that differ by rounding alone are one.
std::vector<double> distinct(std::vector<double> values) {
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
Axis evenly_spaced(const std::filesystem::path& path, DistinctValues&& values, const char* name) {
  const std::vector<double> places = distinct(std::move(values).sorted());
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

std::vector<double> heights_on(const std::filesystem::path& path, std::span<const std::byte> bytes, const Axis& x,
                               const Axis& y) {
  std::vector<double> heights(x.count * y.count, std::numeric_limits<double>::quiet_NaN());
  std::vector<bool> taken(heights.size());
  for_each_point(path, bytes, [&](const Point& point) {
    const auto column = static_cast<std::size_t>(std::round(x.place(point.x)));
    const auto row = static_cast<std::size_t>(std::round(y.place(point.y)));
    const std::size_t i = row * x.count + column;
    if (taken[i]) throw FileError(path, "", fmt::format("has two points at ({}, {})", point.x, point.y));
    taken[i] = true;
    if (std::isfinite(point.z)) heights[i] = point.z;
  });
  return heights;
}

}  // namespace

SurfaceFile parse_xyz(const std::filesystem::path& path, std::span<const std::byte> bytes, const Sidecar& sidecar) {
  const double xy_m = required_scale_um(path, sidecar.xy_um, "xy_um") * 1e-6;
  const double z_m = required_scale_um(path, sidecar.value_um, "value_um") * 1e-6;
  DistinctValues places_x, places_y;
  const std::size_t points = for_each_point(path, bytes, [&](const Point& point) {
    places_x.add(point.x);
    places_y.add(point.y);
  });
  const Axis x = evenly_spaced(path, std::move(places_x), "x"), y = evenly_spaced(path, std::move(places_y), "y");
  const Grid grid = checked_grid(path, "grid", {x.count, y.count, x.pitch * xy_m, y.pitch * xy_m});
  if (points < grid.size() / least_filled) {
    throw FileError(path, "grid",
                    fmt::format("{} points on {} × {} places; a grid is filled to a sixteenth at least", points,
                                grid.columns, grid.rows));
  }
  const std::vector<double> heights = heights_on(path, bytes, x, y);
  const auto height_m = [&](std::size_t i) { return heights[i] * z_m + sidecar.datum_um * 1e-6; };
  HeightField field = assemble_heights(path, "points", grid, FirstRow::Bottom, sidecar_continuation(sidecar), height_m);
  return {std::move(field), "xyz", sidecar.title, sidecar.provenance, ""};
}

}  // namespace mezzotint
