#include <algorithm>
#include <array>
#include <vector>

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/box_intersection_d.h>
#include <CGAL/intersections.h>

#include "fabrication/part/triangle_geometry.h"
#include "fabrication/repair/close_surface.h"
#include "forward/surface/vertex_welder.h"

namespace mezzotint {

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;
using Corners = std::array<std::uint32_t, 3>;
using Box = CGAL::Box_intersection_d::Box_with_info_d<double, 3, std::uint32_t>;

/// The triangles by places: what CGAL split apart is one again.
struct Soup {
  std::vector<Point> points;
  std::vector<Corners> triangles;
};

Soup soup_of(const PartMesh& mesh) {
  VertexWelder welder(mesh.vertices_mm.size());
  std::vector<std::uint32_t> numbers;
  numbers.reserve(mesh.vertices_mm.size());
  for (const auto& vertex : mesh.vertices_mm) numbers.push_back(welder.number(vertex).value);
  Soup soup;
  for (const auto& place : welder.vertices()) soup.points.emplace_back(place[0], place[1], place[2]);
  for (const Corners& triangle : mesh.triangles) {
    const Corners corners = {numbers[triangle[0]], numbers[triangle[1]], numbers[triangle[2]]};
    if (!is_collapsed(corners)) soup.triangles.push_back(corners);
  }
  return soup;
}

std::vector<Box> boxes_of(const Soup& soup) {
  std::vector<Box> boxes;
  boxes.reserve(soup.triangles.size());
  for (std::uint32_t k = 0; k < soup.triangles.size(); ++k) {
    CGAL::Bbox_3 box;
    for (const std::uint32_t corner : soup.triangles[k]) box += soup.points[corner].bbox();
    boxes.emplace_back(box, k);
  }
  return boxes;
}

bool crosses(const Soup& soup, const Corners& edge_and_tip, const Corners& triangle) {
  const Kernel::Segment_3 segment(soup.points[edge_and_tip[0]], soup.points[edge_and_tip[1]]);
  const Kernel::Triangle_3 other(soup.points[triangle[0]], soup.points[triangle[1]], soup.points[triangle[2]]);
  return !other.is_degenerate() && CGAL::do_intersect(segment, other);
}

// Brings the corners that the other triangle has to the end. Returns how many.
std::size_t order_by_shared(Corners& corners, const Corners& other) {
  const auto shared = std::stable_partition(corners.begin(), corners.end(), [&](std::uint32_t corner) {
    return std::find(other.begin(), other.end(), corner) == other.end();
  });
  return static_cast<std::size_t>(corners.end() - shared);
}

bool intersect(const Soup& soup, Corners a, Corners b) {
  const Corners a_was = a;
  const std::size_t shared = order_by_shared(a, b);
  order_by_shared(b, a_was);
  const auto& points = soup.points;
  if (shared == 3) return true;
  if (shared == 2) {  // both on one side of the edge, in one plane
    return CGAL::orientation(points[a[0]], points[a[1]], points[a[2]], points[b[0]]) == CGAL::COPLANAR &&
           !CGAL::collinear(points[a[0]], points[a[1]], points[a[2]]) &&
           CGAL::coplanar_orientation(points[a[1]], points[a[2]], points[a[0]], points[b[0]]) == CGAL::POSITIVE;
  }
  if (shared == 1) return crosses(soup, a, b) || crosses(soup, b, a);
  const Kernel::Triangle_3 first(points[a[0]], points[a[1]], points[a[2]]);
  const Kernel::Triangle_3 second(points[b[0]], points[b[1]], points[b[2]]);
  return !first.is_degenerate() && !second.is_degenerate() && CGAL::do_intersect(first, second);
}

}  // namespace

std::size_t count_self_intersections(const PartMesh& mesh) {
  const Soup soup = soup_of(mesh);
  std::vector<Box> boxes = boxes_of(soup);
  std::size_t count = 0;
  CGAL::box_self_intersection_d(boxes.begin(), boxes.end(), [&](const Box& a, const Box& b) {
    count += intersect(soup, soup.triangles[a.info()], soup.triangles[b.info()]) ? 1 : 0;
  });
  return count;
}

}  // namespace mezzotint
