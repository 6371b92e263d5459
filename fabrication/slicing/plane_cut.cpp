#include <algorithm>
#include <cmath>
#include <optional>

#include "fabrication/slicing/slab_cut.h"

namespace mezzotint {

namespace {

constexpr double plane = 0.5;

struct PlanePoint {
  double x, y;
};

/// The cut, directed so that the material enters at growing x where y grows.
struct PlaneSegment {
  PlanePoint from, to;
};

// Of an edge that two triangles share both make the same point: it is worked out from its lower end.
PlanePoint crossing(const RasterPoint& lower, const RasterPoint& upper) {
  const double t = (plane - lower.z) / (upper.z - lower.z);
  return {lower.x + t * (upper.x - lower.x), lower.y + t * (upper.y - lower.y)};
}

// A corner in the plane counts as above it, in every triangle, so that cuts join.
std::optional<PlaneSegment> cut(const RasterTriangle& triangle) {
  std::optional<PlanePoint> rising, falling;
  for (std::size_t i = 0; i < 3; ++i) {
    const RasterPoint& a = triangle[i];
    const RasterPoint& b = triangle[(i + 1) % 3];
    if (a.z < plane && b.z >= plane) rising = crossing(a, b);
    if (a.z >= plane && b.z < plane) falling = crossing(b, a);
  }
  if (!rising || !falling) return std::nullopt;
  return PlaneSegment{*rising, *falling};
}

// A straight piece within one row, from (x0, …) to (x1, …), of signed height `area`.
void add_piece(AreaRows& rows, std::size_t row, double x0, double x1, double area) {
  const double left = std::min(x0, x1), right = std::max(x0, x1);
  const auto last_column = static_cast<double>(rows.columns());
  const long first = floor_of(std::clamp(left, -1.0, last_column));
  const long last = floor_of(std::clamp(right, -1.0, last_column));
  if (first == last) return rows.add(row, first, area, 0.5 * (left + right));
  const double per_column = area / (right - left);
  for (long column = first; column <= last; ++column) {
    const double begin = column == first ? left : static_cast<double>(column);
    const double end = column == last ? right : static_cast<double>(column + 1);
    rows.add(row, column, per_column * (end - begin), 0.5 * (begin + end));
  }
}

struct RisingSegment {
  PlanePoint low, high;
  double sign;
};

RisingSegment rising(const PlaneSegment& segment) {
  if (segment.to.y > segment.from.y) return {segment.from, segment.to, 1.0};
  return {segment.to, segment.from, -1.0};
}

}  // namespace

void add_plane_cut(AreaRows& rows, const RasterTriangle& triangle) {
  const std::optional<PlaneSegment> segment = cut(triangle);
  if (!segment || segment->from.y == segment->to.y) return;
  const auto [low, high, sign] = rising(*segment);
  const double slope = (high.x - low.x) / (high.y - low.y);
  const auto row_count = static_cast<double>(rows.rows());
  const double begin = std::max(low.y, 0.0), end = std::min(high.y, row_count);
  double y = begin;
  double x = low.x + slope * (begin - low.y);
  while (y < end) {
    const auto row = static_cast<std::size_t>(y);
    const double next_y = std::min(static_cast<double>(row + 1), end);
    const double next_x = next_y == high.y ? high.x : low.x + slope * (next_y - low.y);
    add_piece(rows, row, x, next_x, sign * (next_y - y));
    x = next_x;
    y = next_y;
  }
}

void add_plane_samples(AreaRows& rows, const RasterTriangle& triangle, int samples) {
  const std::optional<PlaneSegment> segment = cut(triangle);
  if (!segment || segment->from.y == segment->to.y) return;
  const auto [low, high, sign] = rising(*segment);
  const double slope = (high.x - low.x) / (high.y - low.y);
  const double count = samples;
  const double share = sign / (count * count);
  const auto last_line = static_cast<double>(rows.rows()) * count - 1.0;
  const auto last_sample = static_cast<double>(rows.columns()) * count;
  // Lines of samples at (i + 1/2)/N; the lower end belongs to the segment, the upper one to the next.
  const double first = std::max(std::ceil(low.y * count - 0.5), 0.0);
  for (double line = first; line <= last_line && (line + 0.5) / count < high.y; ++line) {
    const double x = low.x + slope * ((line + 0.5) / count - low.y);
    const double sample = std::clamp(std::ceil(x * count - 0.5), 0.0, last_sample);  // the first one right of x
    const auto row = static_cast<std::size_t>(line / count);
    const auto column = static_cast<std::size_t>(sample / count);
    const double missed = sample - static_cast<double>(column) * count;
    rows.add_split(row, column, share * (count - missed), share * missed);
  }
}

}  // namespace mezzotint
