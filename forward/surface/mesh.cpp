#include "forward/surface/mesh.h"

#include <cmath>
#include <limits>

#include "forward/base/error.h"

namespace mezzotint {

namespace {

constexpr std::uint32_t unused = std::numeric_limits<std::uint32_t>::max();

bool whole_cell(const HeightField& field, std::size_t column, std::size_t row) {
  return !std::isnan(field.at(column, row) + field.at(column + 1, row) + field.at(column, row + 1) +
                     field.at(column + 1, row + 1));
}

// Triangles whose corners are still sample numbers.
std::vector<std::array<std::uint32_t, 3>> sample_triangles(const HeightField& field) {
  std::vector<std::array<std::uint32_t, 3>> triangles;
  triangles.reserve(2 * (field.columns() - 1) * (field.rows() - 1));
  const auto columns = static_cast<std::uint32_t>(field.columns());
  for (std::uint32_t row = 0; row + 1 < field.rows(); ++row) {
    for (std::uint32_t column = 0; column + 1 < columns; ++column) {
      if (!whole_cell(field, column, row)) continue;
      const std::uint32_t corner = row * columns + column;
      triangles.push_back({corner, corner + 1, corner + columns + 1});
      triangles.push_back({corner, corner + columns + 1, corner + columns});
    }
  }
  return triangles;
}

// The vertex number of every sample that a triangle uses, in the order of the samples.
std::vector<std::uint32_t> number_used_samples(const std::vector<std::array<std::uint32_t, 3>>& triangles,
                                               std::size_t sample_count) {
  std::vector<std::uint32_t> numbers(sample_count, unused);
  for (const auto& triangle : triangles) {
    for (const std::uint32_t sample : triangle) numbers[sample] = 0;
  }
  std::uint32_t next = 0;
  for (std::uint32_t& number : numbers) {
    if (number != unused) number = next++;
  }
  return numbers;
}

std::array<float, 3> position_um(const HeightField& field, std::size_t sample) {
  const std::size_t column = sample % field.columns(), row = sample / field.columns();
  return {static_cast<float>(static_cast<double>(column) * field.grid().pitch_x.um()),
          static_cast<float>(static_cast<double>(row) * field.grid().pitch_y.um()), field.heights_um()[sample]};
}

TriangleMesh mesh_of(const HeightField& field, const std::vector<std::array<float, 3>>& normals) {
  TriangleMesh mesh;
  mesh.triangles = sample_triangles(field);
  require(!mesh.triangles.empty(), "no cell with four measured corners: the relief has no triangles");
  const auto numbers = number_used_samples(mesh.triangles, field.grid().size());
  for (std::size_t sample = 0; sample < numbers.size(); ++sample) {
    if (numbers[sample] == unused) continue;
    mesh.vertices_um.push_back(position_um(field, sample));
    mesh.normals.push_back(normals[sample]);
  }
  for (auto& triangle : mesh.triangles) {
    for (std::uint32_t& corner : triangle) corner = numbers[corner];
  }
  return mesh;
}

}  // namespace

TriangleMesh to_mesh(const HeightField& field) {
  require(field.columns() >= 2 && field.rows() >= 2, "a mesh needs a height field of at least 2 × 2 samples");
  return mesh_of(field, pseudo_normals(field));
}

TriangleMesh to_closed_mesh(const HeightField& field) {
  require(field.periodic(), "only a periodic relief can be closed at its ends");
  require(field.columns() >= 2 && field.rows() >= 2, "a mesh needs a height field of at least 2 × 2 samples");
  const std::size_t columns = field.columns(), rows = field.rows();
  HeightField whole({columns + 1, rows + 1, field.grid().pitch_x, field.grid().pitch_y}, Continuation::Mirrored);
  const auto normals = pseudo_normals(field);
  std::vector<std::array<float, 3>> whole_normals;
  whole_normals.reserve(whole.grid().size());
  for (std::size_t r = 0; r <= rows; ++r) {
    for (std::size_t c = 0; c <= columns; ++c) {
      whole.at(c, r) = field.at(c % columns, r % rows);
      whole_normals.push_back(normals[(r % rows) * columns + c % columns]);
    }
  }
  return mesh_of(whole, whole_normals);
}

}  // namespace mezzotint
