#include "measurement/reflectance/triangulation.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace mezzotint {

namespace {

constexpr std::size_t cells_a_side = 32;
constexpr double shift = 1e-9;

using Triangle = std::array<std::uint32_t, 3>;

struct Circle {
  double x, y, square;
};

struct OpenTriangle {
  Triangle corner;
  Circle circle;
};

double distance(const PlanePoint& a, const PlanePoint& b) { return std::hypot(a.x - b.x, a.y - b.y); }

// Twice the signed area.
double cross(const PlanePoint& a, const PlanePoint& b, const PlanePoint& c) {
  return (b.x - a.x) * (c.y - a.y) - (c.x - a.x) * (b.y - a.y);
}

OpenTriangle open_triangle(const std::vector<PlanePoint>& points, std::uint32_t a, std::uint32_t b, std::uint32_t c) {
  const double bx = points[b].x - points[a].x, by = points[b].y - points[a].y;
  const double cx = points[c].x - points[a].x, cy = points[c].y - points[a].y;
  const double b2 = bx * bx + by * by, c2 = cx * cx + cy * cy, twice = 2.0 * (bx * cy - by * cx);
  const double x = (cy * b2 - by * c2) / twice, y = (bx * c2 - cx * b2) / twice;
  return {{a, b, c}, {points[a].x + x, points[a].y + y, x * x + y * y}};
}

// Points of regular grids lie on common circles and lines, where the construction has no unique answer: a shift far
// below any goniometer's resolution, from a hash of the index, makes one.
std::vector<PlanePoint> shifted(const std::vector<PlanePoint>& points) {
  std::vector<PlanePoint> result = points;
  std::uint64_t state = 1;
  const auto next = [&state] {
    state = state * 6364136223846793005ULL + 1442695040888963407ULL;
    return static_cast<double>(state >> 40U) / static_cast<double>(1U << 24U) - 0.5;
  };
  for (PlanePoint& point : result) {
    point.x += shift * next();
    point.y += shift * next();
  }
  return result;
}

using Edge = std::array<std::uint32_t, 2>;

// Sides that occur once bound the hole that a new point leaves.
std::vector<Edge> outline(std::vector<Edge>& edges) {
  const auto undirected = [](const Edge& e) { return Edge{std::min(e[0], e[1]), std::max(e[0], e[1])}; };
  std::sort(edges.begin(), edges.end(), [&](const Edge& a, const Edge& b) { return undirected(a) < undirected(b); });
  std::vector<Edge> once;
  for (std::size_t i = 0; i < edges.size(); ++i) {
    if (i + 1 < edges.size() && undirected(edges[i]) == undirected(edges[i + 1])) {
      ++i;
    } else {
      once.push_back(edges[i]);
    }
  }
  return once;
}

// From left to right: a triangle whose circle lies left of the sweep can lose its corners no more.
std::vector<Triangle> delaunay(std::vector<PlanePoint> points) {
  const auto count = static_cast<std::uint32_t>(points.size());
  std::vector<std::uint32_t> order(count);
  std::iota(order.begin(), order.end(), 0U);
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return points[a].x < points[b].x || (points[a].x == points[b].x && a < b);
  });
  for (const PlanePoint& far : {PlanePoint{-3e3, -1e3}, PlanePoint{3e3, -1e3}, PlanePoint{0.0, 3e3}})
    points.push_back(far);
  std::vector<OpenTriangle> open = {open_triangle(points, count, count + 1, count + 2)};
  std::vector<Triangle> done;
  std::vector<Edge> edges;
  for (const std::uint32_t index : order) {
    const PlanePoint& point = points[index];
    edges.clear();
    std::erase_if(open, [&](const OpenTriangle& triangle) {
      const double dx = point.x - triangle.circle.x, dy = point.y - triangle.circle.y;
      if (dx > 0.0 && dx * dx > triangle.circle.square) {
        done.push_back(triangle.corner);
        return true;
      }
      if (dx * dx + dy * dy > triangle.circle.square) return false;
      const auto& [a, b, c] = triangle.corner;
      edges.insert(edges.end(), {Edge{a, b}, Edge{b, c}, Edge{c, a}});
      return true;
    });
    for (const Edge& edge : outline(edges)) {
      const OpenTriangle next = open_triangle(points, edge[0], edge[1], index);
      if (std::isfinite(next.circle.square)) open.push_back(next);
    }
  }
  for (const OpenTriangle& triangle : open) done.push_back(triangle.corner);
  std::erase_if(done, [count](const Triangle& t) { return std::max({t[0], t[1], t[2]}) >= count; });
  return done;
}

}  // namespace

Triangulation::Triangulation(std::vector<PlanePoint> points) : points_(std::move(points)) {
  triangles_ = delaunay(shifted(points_));
  leave_out_gaps();
  fill_cells();
}

void Triangulation::leave_out_gaps() {
  std::vector<std::vector<double>> sides(points_.size());
  const auto side = [&](const Triangle& t, std::size_t i) { return distance(points_[t[i]], points_[t[(i + 1) % 3]]); };
  for (const Triangle& t : triangles_) {
    for (std::size_t i = 0; i < 3; ++i) {
      for (const std::uint32_t end : {t[i], t[(i + 1) % 3]}) sides[end].push_back(side(t, i));
    }
  }
  std::vector<double> median(points_.size(), 0.0);
  for (std::size_t i = 0; i < points_.size(); ++i) {
    if (sides[i].empty()) continue;
    const auto middle = sides[i].begin() + static_cast<std::ptrdiff_t>(sides[i].size() / 2);
    std::nth_element(sides[i].begin(), middle, sides[i].end());
    median[i] = *middle;
  }
  std::erase_if(triangles_, [&](const Triangle& t) {
    const double longest = std::max({side(t, 0), side(t, 1), side(t, 2)});
    return longest > longest_side * std::max({median[t[0]], median[t[1]], median[t[2]]});
  });
}

std::size_t Triangulation::cell_of(double value, double low) const {
  const double cell = std::floor((value - low) / cell_side_);
  return static_cast<std::size_t>(std::clamp(cell, 0.0, static_cast<double>(cells_a_side - 1)));
}

void Triangulation::fill_cells() {
  if (points_.empty()) return;
  const auto [left, right] =
      std::minmax_element(points_.begin(), points_.end(), [](const auto& a, const auto& b) { return a.x < b.x; });
  const auto [bottom, top] =
      std::minmax_element(points_.begin(), points_.end(), [](const auto& a, const auto& b) { return a.y < b.y; });
  low_x_ = left->x;
  low_y_ = bottom->y;
  const double extent = std::max(right->x - left->x, top->y - bottom->y);
  cell_side_ = std::max(extent, 1e-6) / static_cast<double>(cells_a_side);
  cells_.resize(cells_a_side * cells_a_side);
  for (std::uint32_t index = 0; index < triangles_.size(); ++index) {
    const auto& [a, b, c] = triangles_[index];
    const auto x = std::minmax({points_[a].x, points_[b].x, points_[c].x});
    const auto y = std::minmax({points_[a].y, points_[b].y, points_[c].y});
    for (std::size_t row = cell_of(y.first - shift, low_y_); row <= cell_of(y.second + shift, low_y_); ++row) {
      for (std::size_t column = cell_of(x.first - shift, low_x_); column <= cell_of(x.second + shift, low_x_); ++column)
        cells_[row * cells_a_side + column].push_back(index);
    }
  }
}

std::optional<Triangulation::Corners> Triangulation::around(PlanePoint place) const {
  if (cells_.empty()) return std::nullopt;
  for (const std::uint32_t index : cells_[cell_of(place.y, low_y_) * cells_a_side + cell_of(place.x, low_x_)]) {
    const Triangle& t = triangles_[index];
    const PlanePoint &a = points_[t[0]], &b = points_[t[1]], &c = points_[t[2]];
    const double whole = cross(a, b, c);
    if (whole == 0.0) continue;
    const std::array<double, 3> weight = {cross(place, b, c) / whole, cross(a, place, c) / whole,
                                          cross(a, b, place) / whole};
    // A place on a side may lie a rounding, or the shift, outside of both triangles there.
    const double side = std::max({distance(a, b), distance(b, c), distance(c, a)});
    const double slack = shift * (1.0 + side * side / std::abs(whole));
    if (std::min({weight[0], weight[1], weight[2]}) < -slack) continue;
    return Corners{t, weight};
  }
  return std::nullopt;
}

}  // namespace mezzotint
