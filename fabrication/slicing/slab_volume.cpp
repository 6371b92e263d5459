#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

#include "fabrication/slicing/slab_cut.h"

namespace mezzotint {

namespace {

/// A convex polygon: a triangle after some cuts by planes, each of which adds one corner at most (rounding some more).
struct Polygon {
  std::array<RasterPoint, 24> points;
  std::size_t size = 0;

  Polygon() {}  // the points stay as they are: most are never used
  Polygon(const Polygon&) = delete;
  Polygon& operator=(const Polygon& other) {
    size = other.size;
    std::copy_n(other.points.begin(), size, points.begin());
    return *this;
  }
  void add(const RasterPoint& point) {
    assert(size < points.size());
    points[size++] = point;
  }
};

template <double RasterPoint::*Axis>
RasterPoint between(const RasterPoint& a, const RasterPoint& b, double value) {
  const double t = (value - a.*Axis) / (b.*Axis - a.*Axis);
  RasterPoint point{a.x + t * (b.x - a.x), a.y + t * (b.y - a.y), a.z + t * (b.z - a.z)};
  point.*Axis = value;
  return point;
}

/// Cuts at a plane across an axis: what lies below goes to `below`, the rest stays.
template <double RasterPoint::*Axis>
void cut_off(Polygon& polygon, double value, Polygon& below) {
  Polygon above;
  below.size = 0;
  for (std::size_t i = 0; i < polygon.size; ++i) {
    const RasterPoint& a = polygon.points[i];
    const RasterPoint& b = polygon.points[i + 1 == polygon.size ? 0 : i + 1];
    if (a.*Axis <= value) below.add(a);
    if (a.*Axis >= value) above.add(a);
    if ((a.*Axis < value && b.*Axis > value) || (a.*Axis > value && b.*Axis < value)) {
      const RasterPoint point = between<Axis>(a, b, value);
      below.add(point);
      above.add(point);
    }
  }
  polygon = above;
}

template <double RasterPoint::*Axis>
std::pair<double, double> range(const Polygon& polygon) {
  double low = polygon.points[0].*Axis, high = low;
  for (std::size_t i = 1; i < polygon.size; ++i) {
    low = std::min(low, polygon.points[i].*Axis);
    high = std::max(high, polygon.points[i].*Axis);
  }
  return {low, high};
}

/// Twice the signed area of a triangle as seen along −x: positive where it faces −x, so that the row enters there.
double facing_area(const RasterPoint& a, const RasterPoint& b, const RasterPoint& c) {
  return (b.z - a.z) * (c.y - a.y) - (b.y - a.y) * (c.z - a.z);
}

// Area and mean x of a polygon within one pixel; x is linear over it, so a triangle's mean is that of its corners.
void add_cell(AreaRows& rows, std::size_t row, long column, const Polygon& polygon) {
  double area = 0.0, moment = 0.0;
  const RasterPoint& first = polygon.points[0];
  for (std::size_t i = 2; i < polygon.size; ++i) {
    const RasterPoint& b = polygon.points[i - 1];
    const RasterPoint& c = polygon.points[i];
    const double part = facing_area(first, b, c);
    area += part;
    moment += part * (first.x + b.x + c.x);
  }
  // moment − area·column is what counts; the mean itself may not exist where parts cancel.
  area *= 0.5;
  if (column < 0 || column >= static_cast<long>(rows.columns())) return rows.add_outside(row, column, area);
  const double beyond = moment / 6.0 - area * static_cast<double>(column);
  rows.add_split(row, static_cast<std::size_t>(column), area - beyond, beyond);
}

/// How the area as seen along x follows from the outline as seen along y or z: its density at x is `factor` times
/// the outline's extent there, in z or in y.
struct Outline {
  double factor = 0.0;
  bool along_y = true;  ///< the extent is taken in y (the face is seen along z)
};

/// Steeper faces lie within two columns of a row, where cutting is as quick and more exact.
constexpr double most_factor = 16.0;

Outline outline_of(const RasterTriangle& t) {
  const RasterPoint u = {t[1].x - t[0].x, t[1].y - t[0].y, t[1].z - t[0].z};
  const RasterPoint v = {t[2].x - t[0].x, t[2].y - t[0].y, t[2].z - t[0].z};
  const double normal_x = u.y * v.z - u.z * v.y, normal_y = u.z * v.x - u.x * v.z, normal_z = u.x * v.y - u.y * v.x;
  if (std::abs(normal_z) >= std::abs(normal_y)) return {normal_x / normal_z, true};
  return {-normal_x / normal_y, false};
}

void add_row_by_cuts(AreaRows& rows, std::size_t row, Polygon& polygon, long first, double right) {
  const double end = std::min(right, static_cast<double>(rows.columns()) + 0.5);  // beyond nothing is cut any more
  Polygon below;
  long column = first;
  for (; polygon.size > 2 && static_cast<double>(column + 1) < end; ++column) {
    cut_off<&RasterPoint::x>(polygon, static_cast<double>(column + 1), below);
    if (below.size > 2) add_cell(rows, row, column, below);
  }
  if (polygon.size > 2) add_cell(rows, row, column, polygon);
}

/// Area and moment of each column, from the column's left side; double, since edges add much and take it back.
struct ColumnSums {
  static constexpr long most = 64;
  std::array<double, most> area, moment;
};

// ∫ q dx and ∫ q·(x − column) dx along an edge, column by column.
void add_edge(ColumnSums& sums, long first, double xa, double qa, double xb, double qb) {
  if (xa == xb || (qa == 0.0 && qb == 0.0)) return;
  const double sign = xb > xa ? 1.0 : -1.0;
  if (xb < xa) {
    std::swap(xa, xb);
    std::swap(qa, qb);
  }
  const auto add = [&](long column, double x0, double q0, double x1, double q1) {
    const auto left = static_cast<double>(column);
    const double width = sign * (x1 - x0), from = x0 - left, to = x1 - left;
    const auto at = static_cast<std::size_t>(column - first);
    sums.area[at] += 0.5 * width * (q0 + q1);
    sums.moment[at] += width * (1.0 / 6.0) * ((2.0 * from + to) * q0 + (from + 2.0 * to) * q1);
  };
  auto column = static_cast<long>(xa);
  if (xb <= static_cast<double>(column + 1)) return add(column, xa, qa, xb, qb);
  const double slope = (qb - qa) / (xb - xa);
  double x = xa, q = qa;
  for (; static_cast<double>(column + 1) < xb; ++column) {
    const auto next_x = static_cast<double>(column + 1);
    const double next_q = qa + slope * (next_x - xa);
    add(column, x, q, next_x, next_q);
    x = next_x;
    q = next_q;
  }
  add(column, x, q, xb, qb);
}

// The same without cuts: by Green's theorem the columns follow from the polygon's edges.
void add_row_by_edges(AreaRows& rows, std::size_t row, const Polygon& polygon, long first, long last,
                      const Outline& outline) {
  ColumnSums sums;
  const auto count = static_cast<std::size_t>(last - first + 1);
  std::fill_n(sums.area.begin(), count, 0.0);
  std::fill_n(sums.moment.begin(), count, 0.0);
  const auto extent = [&](const RasterPoint& p) { return outline.along_y ? p.y - static_cast<double>(row) : p.z; };
  const RasterPoint* before = &polygon.points[polygon.size - 1];
  for (std::size_t i = 0; i < polygon.size; ++i) {
    const RasterPoint& point = polygon.points[i];
    add_edge(sums, first, before->x, extent(*before), point.x, extent(point));
    before = &point;
  }
  for (std::size_t i = 0; i < count; ++i) {
    const double area = outline.factor * sums.area[i], left_of = outline.factor * sums.moment[i];
    rows.add_split(row, static_cast<std::size_t>(first) + i, area - left_of, left_of);
  }
}

void add_row(AreaRows& rows, std::size_t row, Polygon& polygon, const Outline& outline) {
  const auto [left, right] = range<&RasterPoint::x>(polygon);
  const auto columns = static_cast<double>(rows.columns());
  const auto first = floor_of(std::clamp(left, -1.0, columns));
  if (right <= static_cast<double>(first + 1) && first >= 0) return add_cell(rows, row, first, polygon);
  const bool inside = left >= 0.0 && right < columns && right - left < static_cast<double>(ColumnSums::most - 2);
  if (inside && std::abs(outline.factor) < most_factor)
    return add_row_by_edges(rows, row, polygon, first, static_cast<long>(right), outline);
  add_row_by_cuts(rows, row, polygon, first, right);
}

void add_polygon(AreaRows& rows, Polygon& polygon, const Outline& outline) {
  Polygon below;
  const auto row_count = static_cast<double>(rows.rows());
  auto [low, high] = range<&RasterPoint::y>(polygon);
  if (low >= row_count || high <= 0.0) return;
  if (low < 0.0) cut_off<&RasterPoint::y>(polygon, 0.0, below);
  auto row = static_cast<std::size_t>(std::max(low, 0.0));
  for (; row + 1 < rows.rows() && static_cast<double>(row + 1) < high && polygon.size > 2; ++row) {
    cut_off<&RasterPoint::y>(polygon, static_cast<double>(row + 1), below);
    if (below.size > 2) add_row(rows, row, below, outline);
  }
  if (polygon.size < 3) return;
  if (high <= static_cast<double>(row + 1)) return add_row(rows, row, polygon, outline);
  cut_off<&RasterPoint::y>(polygon, static_cast<double>(row + 1), below);
  if (below.size > 2) add_row(rows, row, below, outline);
}

// The common case of fine relief: a triangle within one pixel and one layer.
bool add_small(AreaRows& rows, const RasterTriangle& t, double area) {
  const auto [left, right] = std::minmax({t[0].x, t[1].x, t[2].x});
  const auto [low, high] = std::minmax({t[0].y, t[1].y, t[2].y});
  if (left < 0.0 || low < 0.0 || right >= static_cast<double>(rows.columns()) ||
      high >= static_cast<double>(rows.rows())) {
    return false;
  }
  const auto column = static_cast<std::size_t>(left);
  const auto row = static_cast<std::size_t>(low);
  if (right > static_cast<double>(column + 1) || high > static_cast<double>(row + 1)) return false;
  rows.add(row, static_cast<long>(column), 0.5 * area, (t[0].x + t[1].x + t[2].x) / 3.0);
  return true;
}

}  // namespace

void add_volume(AreaRows& rows, const RasterTriangle& triangle) {
  const double area = facing_area(triangle[0], triangle[1], triangle[2]);
  if (area == 0.0) return;
  const auto [low, high] = std::minmax({triangle[0].z, triangle[1].z, triangle[2].z});
  if (low >= 0.0 && high <= 1.0 && add_small(rows, triangle, area)) return;
  Polygon polygon, below;
  for (const RasterPoint& point : triangle) polygon.add(point);
  if (low < 0.0) cut_off<&RasterPoint::z>(polygon, 0.0, below);
  if (high > 1.0) {
    cut_off<&RasterPoint::z>(polygon, 1.0, below);
    polygon = below;
  }
  if (polygon.size > 2) add_polygon(rows, polygon, outline_of(triangle));
}

}  // namespace mezzotint
