#include "fabrication/appearance/displaced_surface.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include <tbb/enumerable_thread_specific.h>

#include "fabrication/appearance/remembering_probe.h"
#include "forward/base/error.h"

namespace mezzotint {

namespace {

using Eigen::Vector3d;

// Points closer to the lowest plane than this stand on the platform.
constexpr double platform_mm = 1e-6;
constexpr std::size_t pieces = 256;

// A corner of a piece of the surface on its way to become micro-triangles.
struct Corner {
  Vector3d place_mm;  // on the part
  Vector3d normal;    // of the smooth piece
  Vector3d weights;   // in the triangle
  RasterPoint moved;  // displaced
};

// A side of a piece: inside of the triangle, or on one of its edges.
struct Side {
  std::uint32_t edge = SmoothSurface::none;
  bool crease = false;
  Vector3d from = Vector3d::Zero(), to = Vector3d::Zero();  // a crease's offsets at the ends
};

struct Piece {
  std::array<Corner, 3> corners;
  std::array<Side, 3> sides;  // from corner k to the next
};

struct ZRange {
  double low, high;  // layers
};

}  // namespace

struct DisplacedSurface::Parts {
  SmoothSurface surface;
  SurfaceRelief relief;
  RasterFrame frame;
  double longest_square_mm2;
  double platform;  // mm
  double highest_layer;
  std::vector<ZRange> ranges;         // a triangle
  std::vector<std::uint32_t> by_low;  // triangles in the order of their lower ends
  double tallest = 0.0;               // layers: the largest range
  // What a thread has met stays with it from layer to layer; it changes no result.
  mutable tbb::enumerable_thread_specific<std::optional<RememberingProbe>> probes;

  [[nodiscard]] RememberingProbe& probe() const {
    std::optional<RememberingProbe>& own = probes.local();
    if (!own) own.emplace(relief.make_probe());
    return *own;
  }

  [[nodiscard]] double largest_move_mm() const {
    return std::max(std::abs(relief.lowest.mm()), std::abs(relief.highest.mm()));
  }
  [[nodiscard]] RasterPoint raster(const Vector3d& point) const { return frame({point.x(), point.y(), point.z()}); }
  void sort_triangles();
};

namespace {

Vector3d at_corner(std::size_t k) { return Vector3d::Unit(static_cast<Eigen::Index>(k)); }

// A triangle being divided, for the layers of one band.
template <class PartsType, class Emit>
class Divider {
public:
  Divider(const PartsType& parts, double low, double high, Emit emit)
      : parts_(parts), probe_(parts.probe()), low_(low), high_(high), emit_(std::move(emit)) {}

  void divide(std::uint32_t triangle) {
    const SmoothSurface& surface = parts_.surface;
    triangle_ = triangle;
    if (surface.sides[triangle][0] == SmoothSurface::none) return;  // collapsed: it has no area and no edges
    Piece piece;
    for (std::size_t k = 0; k < 3; ++k) piece.corners.at(k) = vertex(triangle, k);
    for (std::size_t k = 0; k < 3; ++k) piece.sides.at(k) = side(triangle, k);
    spread_ = spread_of(piece);
    divide(piece);
  }

private:
  Corner vertex(std::uint32_t triangle, std::size_t k) {
    const SmoothSurface& surface = parts_.surface;
    const std::uint32_t at = surface.corners[triangle].at(k);
    const std::uint32_t owner = surface.owners[at];
    const auto& owner_corners = surface.corners[owner];
    const auto place = static_cast<std::size_t>(std::ranges::find(owner_corners, at) - owner_corners.begin());
    Corner corner{surface.vertices_mm[at], surface.normals[surface.nodes[triangle].at(k)], at_corner(k), {}};
    const Vector3d& offset = surface.on_crease[at] != 0 ? surface.offsets[at] : corner.normal;
    move(corner, owner, at_corner(place), offset);
    return corner;
  }

  Side side(std::uint32_t triangle, std::size_t k) const {
    const SmoothSurface& surface = parts_.surface;
    const std::uint32_t edge = surface.sides[triangle].at(k), crease = surface.edges[edge].crease;
    if (crease == SmoothSurface::none) return {edge, false, {}, {}};
    const auto& ends = surface.creases[crease];
    const bool upward = surface.corners[triangle].at(k) < surface.corners[triangle].at((k + 1) % 3);
    return {edge, true, upward ? ends.low : ends.high, upward ? ends.high : ends.low};
  }

  void move(Corner& corner, std::uint32_t triangle, const Vector3d& weights, const Vector3d& offset) {
    Vector3d moved = corner.place_mm;
    if (moved.z() > parts_.platform) moved += 1e-3 * probe_({triangle, weights, corner.place_mm}) * offset;
    corner.moved = parts_.raster(moved);
  }

  // The same weights in another triangle at the edge.
  [[nodiscard]] Vector3d weights_in(std::uint32_t other, const Vector3d& weights) const {
    if (other == triangle_) return weights;
    const auto &own = parts_.surface.corners[triangle_], &theirs = parts_.surface.corners[other];
    Vector3d result = Vector3d::Zero();
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t j = 0; j < 3; ++j)
        if (own.at(i) == theirs.at(j)) result[static_cast<Eigen::Index>(j)] = weights[static_cast<Eigen::Index>(i)];
    return result;
  }

  // The middle of a side: sums of two, the same from both sides.
  Corner middle(const Corner& a, const Corner& b, const Side& side, Vector3d& offset) {
    Corner corner{0.5 * (a.place_mm + b.place_mm), Vector3d(a.normal + b.normal), 0.5 * (a.weights + b.weights), {}};
    const double length = corner.normal.norm();
    corner.normal = length > 1e-9 ? Vector3d(corner.normal / length) : a.normal;
    offset = side.crease ? Vector3d(0.5 * (side.from + side.to)) : corner.normal;
    const std::uint32_t owner = side.edge == SmoothSurface::none ? triangle_ : parts_.surface.edges[side.edge].owner;
    move(corner, owner, weights_in(owner, corner.weights), offset);
    return corner;
  }

  // 1 over the least length that a mean of the corners' normals can have; 0 where it could vanish.
  static double spread_of(const Piece& piece) {
    const Vector3d mean =
        (piece.corners[0].normal + piece.corners[1].normal + piece.corners[2].normal).stableNormalized();
    double least = 1.0;
    for (const Corner& corner : piece.corners) least = std::min(least, corner.normal.dot(mean));
    return least > 0.1 ? 1.0 / least : 0.0;
  }

  [[nodiscard]] bool outside(const Piece& piece) const {
    double low = std::numeric_limits<double>::infinity(), high = -low, steep = 0.0;
    for (const Corner& corner : piece.corners) {
      const double z = parts_.frame.z * corner.place_mm.z() + parts_.frame.z0;
      low = std::min({low, z, corner.moved.z});
      high = std::max({high, z, corner.moved.z});
      steep = std::max(steep, std::abs(corner.normal.z()));
    }
    steep = spread_ > 0.0 ? std::min(1.0, steep * spread_) : 1.0;
    for (const Side& side : piece.sides)
      if (side.crease) steep = std::max({steep, std::abs(side.from.z()), std::abs(side.to.z())});
    const double reach = parts_.largest_move_mm() * parts_.frame.z * steep;
    return high + reach <= low_ || low - reach >= high_;
  }

  // Halves the longest side until none is too long (Rivara 1984): whatever the order, a side ends in the same halves
  // from both of its triangles, and slivers do not stay slivers.
  void divide(const Piece& piece) {
    if (outside(piece)) return;
    std::size_t longest = 0;
    std::array<double, 3> squares{};
    for (std::size_t k = 0; k < 3; ++k) {
      squares.at(k) = (piece.corners.at(k).place_mm - piece.corners.at((k + 1) % 3).place_mm).squaredNorm();
      if (squares.at(k) > squares.at(longest)) longest = k;
    }
    if (!(squares.at(longest) > parts_.longest_square_mm2))
      return emit_({piece.corners[0].moved, piece.corners[1].moved, piece.corners[2].moved});
    const std::size_t next = (longest + 1) % 3, last = (longest + 2) % 3;
    const Side& side = piece.sides.at(longest);
    Vector3d offset;
    const Corner between = middle(piece.corners.at(longest), piece.corners.at(next), side, offset);
    const Side first{side.edge, side.crease, side.from, offset}, second{side.edge, side.crease, offset, side.to};
    const Side inner;
    divide({{piece.corners.at(longest), between, piece.corners.at(last)}, {first, inner, piece.sides.at(last)}});
    divide({{between, piece.corners.at(next), piece.corners.at(last)}, {second, piece.sides.at(next), inner}});
  }

  const PartsType& parts_;
  RememberingProbe& probe_;
  double low_, high_;
  Emit emit_;
  std::uint32_t triangle_ = 0;
  double spread_ = 1.0;
};

template <class PartsType, class Emit>
Divider<PartsType, Emit> divider(const PartsType& parts, double low, double high, Emit emit) {
  return {parts, low, high, std::move(emit)};
}

// Micro-triangles by layer, handed on by the piece.
class LayerBuffers {
public:
  LayerBuffers(std::size_t first, std::size_t layers, const TakeMicroTriangles& take)
      : first_(first), buffers_(layers), take_(take) {
    for (auto& buffer : buffers_) buffer.reserve(pieces);
  }
  void add(const RasterTriangle& triangle) {
    const auto [low, high] = std::minmax({triangle[0].z, triangle[1].z, triangle[2].z});
    const auto count = static_cast<double>(buffers_.size()), from = static_cast<double>(first_);
    const auto begin = static_cast<std::size_t>(std::clamp(std::floor(low - from), 0.0, count)),
               end = static_cast<std::size_t>(std::clamp(std::ceil(high - from), 0.0, count));
    for (std::size_t layer = begin; layer < end; ++layer) {
      buffers_[layer].push_back(triangle);
      if (buffers_[layer].size() == pieces) flush(layer);
    }
  }
  void finish() {
    for (std::size_t layer = 0; layer < buffers_.size(); ++layer) flush(layer);
  }

private:
  void flush(std::size_t layer) {
    if (!buffers_[layer].empty()) take_(first_ + layer, buffers_[layer]);
    buffers_[layer].clear();
  }
  std::size_t first_;
  std::vector<std::vector<RasterTriangle>> buffers_;
  const TakeMicroTriangles& take_;
};

double lowest_place(const SmoothSurface& surface) {
  double low = std::numeric_limits<double>::infinity();
  for (const auto& corners : surface.corners)
    for (const std::uint32_t vertex : corners) low = std::min(low, surface.vertices_mm[vertex].z());
  return low;
}

}  // namespace

void DisplacedSurface::Parts::sort_triangles() {
  const double reach = 3.0 * largest_move_mm() * frame.z;
  highest_layer = 0.0;
  for (std::uint32_t t = 0; t < surface.corners.size(); ++t) {
    ZRange range{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
    for (const std::uint32_t vertex : surface.corners[t]) {
      const double z = frame.z * surface.vertices_mm[vertex].z() + frame.z0;
      range = {std::min(range.low, z - reach), std::max(range.high, z + reach)};
    }
    ranges.push_back(range);
    by_low.push_back(t);
    tallest = std::max(tallest, range.high - range.low);
    highest_layer = std::max(highest_layer, range.high - reach + largest_move_mm() * frame.z);
  }
  std::ranges::sort(by_low, [this](std::uint32_t a, std::uint32_t b) {
    return ranges[a].low != ranges[b].low ? ranges[a].low < ranges[b].low : a < b;
  });
}

DisplacedSurface::DisplacedSurface(SmoothSurface surface, SurfaceRelief relief, const RasterFrame& frame,
                                   Length longest_edge) {
  require(longest_edge > Length{}, "the longest edge of a micro-triangle must be positive");
  require(static_cast<bool>(relief.make_probe) && relief.lowest <= relief.highest,
          "a relief needs a probe, and its lowest point must not be above its highest");
  const double platform = lowest_place(surface) + platform_mm;
  auto parts = std::make_unique<Parts>(Parts{
      std::move(surface), std::move(relief), frame, longest_edge.mm() * longest_edge.mm(), platform, 0.0, {}, {}});
  parts->sort_triangles();
  parts_ = std::move(parts);
}
DisplacedSurface::~DisplacedSurface() = default;
DisplacedSurface::DisplacedSurface(DisplacedSurface&&) noexcept = default;
DisplacedSurface& DisplacedSurface::operator=(DisplacedSurface&&) noexcept = default;

double DisplacedSurface::highest_layer() const { return parts_->highest_layer; }

void DisplacedSurface::for_each_triangle(std::size_t first_layer, std::size_t layers,
                                         const TakeMicroTriangles& take) const {
  const auto low = static_cast<double>(first_layer), high = static_cast<double>(first_layer + layers);
  LayerBuffers buffers(first_layer, layers, take);
  auto dividing = divider(*parts_, low, high, [&buffers](const RasterTriangle& t) { buffers.add(t); });
  const auto& ranges = parts_->ranges;
  // Those that begin far enough below end below.
  const auto begin = std::ranges::lower_bound(parts_->by_low, low - parts_->tallest, {},
                                              [&ranges](std::uint32_t t) { return ranges[t].low; });
  for (auto at = begin; at != parts_->by_low.end() && ranges[*at].low < high; ++at)
    if (ranges[*at].high > low) dividing.divide(*at);
  buffers.finish();
}

void DisplacedSurface::for_all_triangles(const std::function<void(const RasterTriangle&)>& take) const {
  constexpr double everywhere = std::numeric_limits<double>::infinity();
  auto dividing = divider(*parts_, -everywhere, everywhere, [&take](const RasterTriangle& t) { take(t); });
  for (std::uint32_t t = 0; t < parts_->surface.corners.size(); ++t) dividing.divide(t);
}

}  // namespace mezzotint
