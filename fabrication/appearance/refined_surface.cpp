#include <cmath>
#include <map>
#include <utility>

#include <fmt/format.h>

#include "fabrication/appearance/smooth_surface.h"
#include "forward/base/error.h"

namespace mezzotint {

namespace {

using Eigen::Vector3d;
using Indices = std::array<std::uint32_t, 3>;

struct Triangle {
  Indices corners, nodes, sides;
  std::uint32_t source;
};

// One pass: every edge that is a triangle's longest and too long is halved.
class Pass {
public:
  Pass(SmoothSurface& surface, double longest_mm) : surface_(surface), longest_mm_(longest_mm) {}

  // Whether anything was too long.
  bool run() {
    mark();
    if (marked_ == 0) return false;
    halve_edges();
    std::vector<Triangle> before;
    for (std::size_t t = 0; t < surface_.corners.size(); ++t)
      before.push_back({surface_.corners[t], surface_.nodes[t], surface_.sides[t], surface_.sources[t]});
    surface_.corners.clear();
    surface_.nodes.clear();
    surface_.sides.clear();
    surface_.sources.clear();
    for (const Triangle& triangle : before) divide(triangle);
    name_owners();
    return true;
  }

private:
  [[nodiscard]] double length(std::uint32_t a, std::uint32_t b) const {
    return (surface_.vertices_mm[a] - surface_.vertices_mm[b]).norm();
  }
  [[nodiscard]] std::size_t longest_side(const Triangle& triangle) const {
    std::size_t longest = 0;
    double most = -1.0;
    for (std::size_t k = 0; k < 3; ++k) {
      const double own = length(triangle.corners.at(k), triangle.corners.at((k + 1) % 3));
      if (own > most) {
        most = own;
        longest = k;
      }
    }
    return longest;
  }

  void mark() {
    halves_.assign(surface_.edges.size(), SmoothSurface::none);
    ends_.resize(surface_.edges.size());
    for (std::size_t t = 0; t < surface_.corners.size(); ++t) {
      const Triangle triangle{surface_.corners[t], surface_.nodes[t], surface_.sides[t], 0};
      if (triangle.sides[0] == SmoothSurface::none) continue;
      const std::size_t k = longest_side(triangle);
      const std::uint32_t a = triangle.corners.at(k), b = triangle.corners.at((k + 1) % 3), edge = triangle.sides.at(k);
      if (!(length(a, b) > longest_mm_) || halves_[edge] != SmoothSurface::none) continue;
      halves_[edge] = 0;
      ends_[edge] = {std::min(a, b), std::max(a, b)};
      ++marked_;
    }
  }

  // The half at the lower vertex keeps the edge's number; the other one gets halves_[edge].
  void halve_edges() {
    middles_.assign(surface_.edges.size(), SmoothSurface::none);
    const std::size_t count = surface_.edges.size();
    for (std::size_t edge = 0; edge < count; ++edge) {
      if (halves_[edge] == SmoothSurface::none) continue;
      const auto [low, high] = ends_[edge];
      middles_[edge] = static_cast<std::uint32_t>(surface_.vertices_mm.size());
      surface_.vertices_mm.push_back(0.5 * (surface_.vertices_mm[low] + surface_.vertices_mm[high]));
      halves_[edge] = static_cast<std::uint32_t>(surface_.edges.size());
      SmoothSurface::Edge half{0, SmoothSurface::none};
      const std::uint32_t crease = surface_.edges[edge].crease;
      surface_.on_crease.push_back(crease != SmoothSurface::none ? 1 : 0);
      surface_.offsets.emplace_back(Vector3d::Zero());
      if (crease != SmoothSurface::none) {
        // A new vertex has a higher number than both ends.
        SmoothSurface::Crease& first = surface_.creases[crease];
        const Vector3d middle = 0.5 * (first.low + first.high);
        const SmoothSurface::Crease second{first.high, middle};
        first.high = middle;
        surface_.offsets.back() = middle;
        half.crease = static_cast<std::uint32_t>(surface_.creases.size());
        surface_.creases.push_back(second);
      }
      surface_.edges.push_back(half);
    }
  }

  [[nodiscard]] bool is_halved(std::uint32_t edge) const {
    return edge < middles_.size() && middles_[edge] != SmoothSurface::none;
  }
  std::uint32_t half_at(std::uint32_t edge, std::uint32_t vertex) const {
    return vertex == ends_[edge][0] ? edge : halves_[edge];
  }
  std::uint32_t node_between(std::uint32_t a, std::uint32_t b, std::uint32_t vertex) {
    const auto fresh = static_cast<std::uint32_t>(surface_.normals.size());
    const auto [place, is_new] = nodes_.try_emplace(std::minmax(a, b), fresh);
    if (!is_new) return place->second;
    const Vector3d sum = surface_.normals[a] + surface_.normals[b];
    surface_.normals.push_back(sum.norm() > 1e-9 ? Vector3d(sum.normalized()) : surface_.normals[a]);
    surface_.node_vertices.push_back(vertex);
    if (surface_.on_crease[vertex] == 0) surface_.offsets[vertex] = surface_.normals.back();
    return fresh;
  }

  // A half that kept its edge's number is not to be halved again in this pass: only sides whose ends are the edge's.
  void divide(const Triangle& triangle) {
    for (std::size_t i = 0, k = longest_side(triangle); i < 3; ++i, k = (k + 1) % 3) {
      const std::uint32_t edge = triangle.sides.at(k);
      const std::uint32_t a = triangle.corners.at(k), b = triangle.corners.at((k + 1) % 3);
      if (!is_halved(edge) || ends_[edge] != std::array{std::min(a, b), std::max(a, b)}) continue;
      return divide_at(triangle, k);
    }
    keep(triangle);
  }
  void divide_at(const Triangle& t, std::size_t k) {
    const std::size_t next = (k + 1) % 3, last = (k + 2) % 3;
    const std::uint32_t edge = t.sides.at(k), middle = middles_[edge];
    const std::uint32_t node = node_between(t.nodes.at(k), t.nodes.at(next), middle);
    const auto inner = static_cast<std::uint32_t>(surface_.edges.size());
    surface_.edges.push_back({0, SmoothSurface::none});
    divide({{t.corners.at(k), middle, t.corners.at(last)},
            {t.nodes.at(k), node, t.nodes.at(last)},
            {half_at(edge, t.corners.at(k)), inner, t.sides.at(last)},
            t.source});
    divide({{middle, t.corners.at(next), t.corners.at(last)},
            {node, t.nodes.at(next), t.nodes.at(last)},
            {half_at(edge, t.corners.at(next)), t.sides.at(next), inner},
            t.source});
  }

  void keep(const Triangle& triangle) {
    surface_.corners.push_back(triangle.corners);
    surface_.nodes.push_back(triangle.nodes);
    surface_.sides.push_back(triangle.sides);
    surface_.sources.push_back(triangle.source);
  }

  void name_owners() {
    surface_.owners.assign(surface_.vertices_mm.size(), SmoothSurface::none);
    for (auto& edge : surface_.edges) edge.owner = SmoothSurface::none;
    for (std::uint32_t t = 0; t < surface_.corners.size(); ++t) {
      for (std::size_t k = 0; k < 3; ++k) {
        std::uint32_t& owner = surface_.owners[surface_.corners[t].at(k)];
        owner = std::min(owner, t);
        if (surface_.sides[t].at(k) == SmoothSurface::none) continue;
        std::uint32_t& edge_owner = surface_.edges[surface_.sides[t].at(k)].owner;
        edge_owner = std::min(edge_owner, t);
      }
    }
  }

  SmoothSurface& surface_;
  double longest_mm_;
  std::size_t marked_ = 0;
  std::vector<std::uint32_t> halves_, middles_;
  std::vector<std::array<std::uint32_t, 2>> ends_;
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> nodes_;
};

}  // namespace

SmoothSurface refined(SmoothSurface surface, Length longest_edge, std::size_t most_triangles) {
  require(longest_edge > Length{}, "the longest edge of a refined surface must be positive");
  while (Pass(surface, longest_edge.mm()).run())
    require(surface.corners.size() <= most_triangles,
            fmt::format("edges of {:.4g} um would make more than {} triangles of the part's surface; take longer waves "
                        "or a smaller part",
                        longest_edge.um(), most_triangles));
  return surface;
}

}  // namespace mezzotint
