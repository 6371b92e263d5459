#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "forward/optics/direction.h"
#include "forward/surface/height_field.h"
#include "forward/tracing/scene_frame.h"

namespace mezzotint {

/// A relief as the tracers see it: one tile that repeats in x and y, two triangles a cell, split as `to_mesh`
/// splits them. A mirrored field becomes the first quarter of a tile of (2·columns − 2) × (2·rows − 2) samples
/// that goes on by reflection, without steps.
///
/// Frame    centred: x in [−length_x/2, length_x/2), z = 0 half-way between the lowest and the highest point,
///          so that single precision is spent on the relief and not on an offset.
/// Units    cells: everything is divided by pitch_x, heights too, so that directions keep their meaning.
/// Shape    triangle 2·(row·columns + column) of a cell has corners (c, r), (c+1, r), (c+1, r+1); the next one
///          (c, r), (c+1, r+1), (c, r+1).
class PeriodicTile {
public:
  /// @throws InvalidInput for fewer than 2 × 2 samples or a field with missing samples.
  explicit PeriodicTile(const HeightField& field);

  [[nodiscard]] std::uint32_t columns() const { return columns_; }
  [[nodiscard]] std::uint32_t rows() const { return rows_; }
  [[nodiscard]] double cell_y() const { return cell_y_; }
  [[nodiscard]] double length_x() const { return columns_; }
  [[nodiscard]] double length_y() const { return rows_ * cell_y_; }
  [[nodiscard]] double highest() const { return highest_; }
  [[nodiscard]] double lowest() const { return -highest_; }
  /// What a cell is worth: pitch_x.
  [[nodiscard]] double unit_um() const { return unit_um_; }
  /// Mean height: the macrosurface, at which rays are aimed.
  [[nodiscard]] double mean() const { return mean_; }

  /// Whether only the first quarter of the tile was measured.
  [[nodiscard]] bool mirrored() const { return mirrored_; }
  /// What following light needs to know of it; rays are aimed at what was measured.
  [[nodiscard]] SceneFrame frame() const;

  /// Height of a sample; column < columns(), row < rows().
  [[nodiscard]] float height(std::uint32_t column, std::uint32_t row) const {
    return heights_[std::size_t{row} * columns_ + column];
  }

  /// The point of a triangle with weights 1 − u − v, u and v at its corners.
  [[nodiscard]] Eigen::Vector3d point(std::uint32_t triangle, double u, double v) const;
  [[nodiscard]] Direction geometric_normal(std::uint32_t triangle) const;
  /// Angle-weighted pseudo-normals of the corners, interpolated.
  [[nodiscard]] Direction interpolated_normal(std::uint32_t triangle, double u, double v) const;

  /// Makes `interpolated_normal` possible: the normals are costly, and geometric ones do without.
  void prepare_normals();

private:
  struct Corners {
    std::array<std::uint32_t, 3> samples;
    Eigen::Vector3d first;
    Eigen::Vector3d edge_u;
    Eigen::Vector3d edge_v;
  };
  [[nodiscard]] Corners corners(std::uint32_t triangle) const;

  std::uint32_t columns_ = 0;
  std::uint32_t rows_ = 0;
  double unit_um_ = 1.0;
  double cell_y_ = 1.0;
  double highest_ = 0.0;
  double mean_ = 0.0;
  bool mirrored_ = false;
  std::vector<float> heights_;
  std::vector<std::array<float, 3>> normals_;
};

}  // namespace mezzotint
