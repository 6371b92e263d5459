#include "fabrication/slicing/slab_source.h"

#include <algorithm>
#include <cmath>

namespace mezzotint {

namespace {

RasterTriangle placed(const PartMesh& part, const RasterFrame& frame, std::uint32_t index) {
  const auto& [a, b, c] = part.triangles[index];
  return {frame(part.vertices_mm[a]), frame(part.vertices_mm[b]), frame(part.vertices_mm[c])};
}

// A triangle that lies along the rows, as the flat faces of a plate do.
bool faces_no_row(const RasterTriangle& t) {
  return (t[1].z - t[0].z) * (t[2].y - t[0].y) == (t[1].y - t[0].y) * (t[2].z - t[0].z);
}

struct LayerRange {
  std::uint32_t first = 1, last = 0;
  [[nodiscard]] bool empty() const { return first > last; }
};

LayerRange layers_of(const RasterTriangle& t, std::size_t layer_count) {
  const auto [low, high] = std::minmax({t[0].z, t[1].z, t[2].z});
  const auto most = static_cast<double>(layer_count);
  if (!(high > 0.0) || !(low < most) || faces_no_row(t)) return {};
  const double last = std::min(std::ceil(high), most) - 1.0;
  return {static_cast<std::uint32_t>(std::max(std::floor(low), 0.0)), static_cast<std::uint32_t>(std::max(last, 0.0))};
}

// Triangles sorted by their first layer (a counting sort), and those of the present layer, which are kept while they
// reach on: in the order of the first layer, then of the mesh.
class MeshSweep {
public:
  MeshSweep(const PartMesh& part, const RasterFrame& frame, std::size_t layer_count)
      : part_(part), frame_(frame), begins_(layer_count + 1, 0) {
    std::vector<LayerRange> ranges;
    ranges.reserve(part.triangles.size());
    for (std::uint32_t i = 0; i < part.triangles.size(); ++i) {
      ranges.push_back(layers_of(placed(part, frame, i), layer_count));
      if (!ranges.back().empty()) ++begins_[ranges.back().first + 1];
    }
    for (std::size_t layer = 0; layer < layer_count; ++layer) begins_[layer + 1] += begins_[layer];
    sorted_.resize(begins_.back());
    std::vector<std::size_t> next(begins_.begin(), begins_.end() - 1);
    for (std::uint32_t i = 0; i < ranges.size(); ++i) {
      if (!ranges[i].empty()) sorted_[next[ranges[i].first]++] = {i, ranges[i].last};
    }
  }

  FeedLayer feed(std::size_t layer) {
    std::erase_if(present_, [layer](const Entry& entry) { return entry.last < layer; });
    present_.insert(present_.end(), sorted_.begin() + static_cast<std::ptrdiff_t>(begins_[layer]),
                    sorted_.begin() + static_cast<std::ptrdiff_t>(begins_[layer + 1]));
    std::vector<std::uint32_t> triangles;
    triangles.reserve(present_.size());
    for (const Entry& entry : present_) triangles.push_back(entry.triangle);
    return [this, triangles = std::move(triangles)](const AddTriangles& add) { give(triangles, add); };
  }

private:
  void give(const std::vector<std::uint32_t>& triangles, const AddTriangles& add) const {
    constexpr std::size_t bulk = 256;
    std::array<RasterTriangle, bulk> buffer;
    for (std::size_t begin = 0; begin < triangles.size(); begin += bulk) {
      const std::size_t count = std::min(bulk, triangles.size() - begin);
      for (std::size_t i = 0; i < count; ++i) buffer[i] = placed(part_, frame_, triangles[begin + i]);
      add(std::span(buffer).first(count));
    }
  }

  struct Entry {
    std::uint32_t triangle, last;
  };
  const PartMesh& part_;
  RasterFrame frame_;
  std::vector<std::size_t> begins_;  ///< where in sorted_ the triangles of a first layer begin
  std::vector<Entry> sorted_, present_;
};

}  // namespace

SlabSource mesh_source(const PartMesh& part, const RasterFrame& frame, std::size_t layer_count) {
  const auto sweep = std::make_shared<MeshSweep>(part, frame, layer_count);
  return [sweep](std::size_t layer) { return sweep->feed(layer); };
}

}  // namespace mezzotint
