#include "forward/tracing/periodic_tile.h"

#include <Eigen/Geometry>
#include <limits>
#include <string>

#include "forward/base/error.h"
#include "forward/surface/mesh.h"

namespace mezzotint {

namespace {

void require_traceable(const HeightField& field) {
  require(field.columns() >= 2 && field.rows() >= 2, "rays need a height field of at least 2 × 2 samples");
  const std::size_t missing = field.missing_count();
  require(missing == 0, "the height field misses " + std::to_string(missing) + " samples; fill them before tracing");
  // Triangles are counted in 32 bits, two a cell, with four copies of a mirrored field and a border around.
  require(field.grid().size() <= (std::size_t{1} << 28), "rays are traced through at most 2^28 samples");
}

// Samples of a period: those of the field, or there and back again without the ends twice.
std::uint32_t period(std::size_t samples, bool mirrored) {
  return static_cast<std::uint32_t>(mirrored ? 2 * (samples - 1) : samples);
}

std::size_t reflect_index(std::uint32_t index, std::size_t samples) {
  return index < samples ? index : 2 * (samples - 1) - index;
}

double mean_height_um(const HeightField& field) {
  double sum = 0.0;
  for (const float z : field.heights_um()) sum += z;
  return sum / static_cast<double>(field.grid().size());
}

}  // namespace

PeriodicTile::PeriodicTile(const HeightField& field) : mirrored_(!field.periodic()) {
  require_traceable(field);
  columns_ = period(field.columns(), mirrored_);
  rows_ = period(field.rows(), mirrored_);
  const double unit_um = unit_um_ = field.grid().pitch_x.um();
  cell_y_ = field.grid().pitch_y.um() / unit_um;
  const HeightRange range = height_range(field);
  const double middle_um = 0.5 * (range.lowest.um() + range.highest.um());
  highest_ = (range.highest.um() - middle_um) / unit_um;
  mean_ = (mean_height_um(field) - middle_um) / unit_um;
  heights_.reserve(std::size_t{columns_} * rows_);
  for (std::uint32_t row = 0; row < rows_; ++row) {
    for (std::uint32_t column = 0; column < columns_; ++column) {
      const double z_um = field.at(reflect_index(column, field.columns()), reflect_index(row, field.rows()));
      heights_.push_back(static_cast<float>((z_um - middle_um) / unit_um));
    }
  }
}

SceneFrame PeriodicTile::frame() const {
  const double part = mirrored_ ? 0.5 : 1.0;
  return {.columns = columns_,
          .rows = rows_,
          .cell_y = cell_y_,
          .unit_um = unit_um_,
          .highest = highest_,
          .lowest = lowest(),
          .mean = mean_,
          .ends = mirrored_ ? SceneEnds::Mirrored : SceneEnds::Periodic,
          .aimed_columns = part * columns_,
          .aimed_rows = part * rows_};
}

void PeriodicTile::prepare_normals() {
  if (!normals_.empty()) return;
  const Grid grid{columns_, rows_, Length::from_um(1.0), Length::from_um(cell_y_)};
  normals_ = pseudo_normals(HeightField(grid, Continuation::Periodic, heights_));
}

PeriodicTile::Corners PeriodicTile::corners(std::uint32_t triangle) const {
  const std::uint32_t cell = triangle / 2;
  const std::uint32_t row = cell / columns_;
  const std::uint32_t column = cell - row * columns_;
  const std::uint32_t next_column = column + 1 == columns_ ? 0 : column + 1;
  const std::uint32_t next_row = row + 1 == rows_ ? 0 : row + 1;
  const std::uint32_t first = row * columns_ + column, opposite = next_row * columns_ + next_column;
  const double z = heights_[first], z_opposite = heights_[opposite] - z;
  const Eigen::Vector3d corner(column - 0.5 * length_x(), row * cell_y_ - 0.5 * length_y(), z);
  if (triangle % 2 == 0) {
    const std::uint32_t right = row * columns_ + next_column;
    return {{first, right, opposite}, corner, {1.0, 0.0, heights_[right] - z}, {1.0, cell_y_, z_opposite}};
  }
  const std::uint32_t above = next_row * columns_ + column;
  return {{first, opposite, above}, corner, {1.0, cell_y_, z_opposite}, {0.0, cell_y_, heights_[above] - z}};
}

Eigen::Vector3d PeriodicTile::point(std::uint32_t triangle, double u, double v) const {
  const Corners at = corners(triangle);
  return at.first + u * at.edge_u + v * at.edge_v;
}

Direction PeriodicTile::geometric_normal(std::uint32_t triangle) const {
  const Corners at = corners(triangle);
  return at.edge_u.cross(at.edge_v).normalized();
}

Direction PeriodicTile::interpolated_normal(std::uint32_t triangle, double u, double v) const {
  const auto samples = corners(triangle).samples;
  const std::array<double, 3> weights = {1.0 - u - v, u, v};
  Direction sum = Direction::Zero();
  for (std::size_t k = 0; k < 3; ++k) {
    const auto& normal = normals_[samples[k]];
    sum += weights[k] * Direction(normal[0], normal[1], normal[2]);
  }
  return sum.normalized();
}

}  // namespace mezzotint
