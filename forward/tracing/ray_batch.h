#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace mezzotint {

/// Which side of the surface a ray travels on: it can only meet faces that look at it.
enum class Side : std::uint8_t { Outside, Inside };

/// Where a ray ends.
enum class RayEnd : std::uint8_t {
  Surface,
  Above,     ///< left upwards, above the highest point
  Below,     ///< left downwards, below the lowest point
  Lost,      ///< found no end within the tiles that a ray may cross
  Sideways,  ///< left an open patch beside its ends
  Behind     ///< came upon the back of a face, so through the surface: a mesh that is open or not oriented outwards
};

/// A ray that has left no facet.
inline constexpr std::uint8_t no_half = 2;

/// Many rays, one array a component, so that vector units can load them.
///
/// Frame    a place is a cell of the tile (see PeriodicTile) and the place in it: x = cell_x + x, so that single
///          precision is spent on the cell and not on the distance from a corner of the patch. Directions are unit
///          vectors, the way the ray travels.
/// Units    cells of pitch_x for x and z and the direction; y is in cells of pitch_y, in [0, 1] like x.
/// Meshes   a ray that has left a facet of a mesh has the triangle's number in `cell_x`, and in x and y the weights of
///          its second and third corner; `left` is 0 there. What reads hits copies them as they are.
struct RayBatch {
  explicit RayBatch(std::size_t capacity = 0) { resize(capacity); }
  // Every array has room for a vector more than asked for, so that loads of whole vectors stay within.
  void resize(std::size_t count) {
    size_ = count;
    count += padding;
    for (auto* part : {&x, &y, &z, &dx, &dy, &dz}) part->resize(count);
    cell_x.resize(count);
    cell_y.resize(count);
    side.resize(count);
    left.resize(count, no_half);
  }
  [[nodiscard]] std::size_t size() const { return size_; }

  std::vector<std::int32_t> cell_x, cell_y;
  std::vector<float> x, y, z;
  std::vector<float> dx, dy, dz;
  std::vector<Side> side;
  std::vector<std::uint8_t> left;

private:
  static constexpr std::size_t padding = 16;
  std::size_t size_ = 0;
};

/// Where the rays of a batch ended, in their order. The place is set where `end` is Surface.
///
/// Frame    as RayBatch. `slope_x`, `slope_y` are the facet's ∂z/∂x and ∂z/∂y (its normal is (−slope_x, −slope_y, 1),
///          not normalised), dimensionless. `triangle` is 0 for the cell's lower right half, 1 for the other.
/// Meshes   places as in RayBatch, and two arrays more, empty otherwise: the normal is (−slope_x, −slope_y, rise), of
///          length 1, and `way` the length of the ray in cells.
struct HitBatch {
  explicit HitBatch(std::size_t capacity = 0) { resize(capacity); }
  void resize(std::size_t count) {
    size_ = count;
    count += padding;
    for (auto* part : {&x, &y, &z, &slope_x, &slope_y}) part->resize(count);
    cell_x.resize(count);
    cell_y.resize(count);
    triangle.resize(count);
    end.resize(count);
  }
  /// Makes room for the arrays that only meshes have.
  void with_mesh_arrays() {
    rise.resize(size_ + padding);
    way.resize(size_ + padding);
  }
  [[nodiscard]] std::size_t size() const { return size_; }

  std::vector<std::int32_t> cell_x, cell_y;
  std::vector<float> x, y, z;
  std::vector<float> slope_x, slope_y;
  std::vector<float> rise, way;
  std::vector<std::uint8_t> triangle;
  std::vector<RayEnd> end;

private:
  static constexpr std::size_t padding = 16;
  std::size_t size_ = 0;
};

}  // namespace mezzotint
