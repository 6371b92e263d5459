#include "fabrication/appearance/direction_field.h"

#include <cmath>
#include <complex>
#include <numbers>

#include <Eigen/Geometry>
#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>

#include "fabrication/appearance/tangent_plane.h"
#include "forward/base/error.h"

namespace mezzotint {

namespace {

using Eigen::Vector3d;
using Complex = std::complex<double>;
using Matrix = Eigen::SparseMatrix<Complex>;
using Vector = Eigen::VectorXcd;

// A thin triangle's cotangents can be anything.
constexpr double largest_weight = 50.0;

class Connection {
public:
  explicit Connection(const SmoothSurface& surface) : surface_(surface) {
    planes_.reserve(surface.normals.size());
    for (const Vector3d& normal : surface.normals) planes_.emplace_back(normal);
  }
  [[nodiscard]] const TangentPlane& plane(std::uint32_t node) const { return planes_[node]; }

  // By what a line at node a is multiplied to become the same line at node b.
  [[nodiscard]] Complex transport(std::uint32_t a, std::uint32_t b) const {
    return plane(b).line(transported(planes_[a].u, surface_.normals[a], surface_.normals[b]));
  }

private:
  const SmoothSurface& surface_;
  std::vector<TangentPlane> planes_;
};

struct Energy {
  Matrix smoothness;
  Eigen::VectorXd areas;  // mm², a node
};

Energy smoothness_energy(const SmoothSurface& surface, const Connection& connection) {
  const auto count = static_cast<Eigen::Index>(surface.normals.size());
  std::vector<Eigen::Triplet<Complex>> entries;
  Energy energy{Matrix(count, count), Eigen::VectorXd::Zero(count)};
  for (std::size_t t = 0; t < surface.corners.size(); ++t) {
    const auto& [a, b, c] = surface.corners[t];
    const std::array<Vector3d, 3> at = {surface.vertices_mm[a], surface.vertices_mm[b], surface.vertices_mm[c]};
    const double area = 0.5 * (at[1] - at[0]).cross(at[2] - at[0]).norm();
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t i = (k + 1) % 3, j = (k + 2) % 3;
      const Vector3d p = at.at(i) - at.at(k), q = at.at(j) - at.at(k);
      const double cotangent = p.dot(q) / std::max(p.cross(q).norm(), 1e-300);
      const double weight = std::clamp(0.5 * cotangent, 0.02, largest_weight);
      const std::uint32_t from = surface.nodes[t].at(i), to = surface.nodes[t].at(j);
      const Complex turn = connection.transport(from, to);
      entries.emplace_back(from, from, weight);
      entries.emplace_back(to, to, weight);
      entries.emplace_back(to, from, -weight * turn);
      entries.emplace_back(from, to, -weight * std::conj(turn));
      energy.areas[surface.nodes[t].at(k)] += area / 3.0;
    }
  }
  energy.smoothness.setFromTriplets(entries.begin(), entries.end());
  // Nodes of triangles without area are held too.
  energy.areas.array() += 1e-3 * energy.areas.mean();
  return energy;
}

Vector guide_lines(const SmoothSurface& surface, const Connection& connection, const FieldGuide& guide) {
  const Complex turn = std::polar(1.0, 2.0 * guide.turn.radians());
  const bool by_axis = guide.kind == FieldGuide::Kind::Axis;
  const Vector3d axis = guide.axis.normalized();
  const std::vector<Vector3d> bending = by_axis ? std::vector<Vector3d>{} : bending_directions(surface);
  Vector lines(static_cast<Eigen::Index>(surface.normals.size()));
  double most = 0.0;
  for (std::uint32_t node = 0; node < surface.normals.size(); ++node) {
    lines[node] = turn * connection.plane(node).line(by_axis ? axis : bending[node]);
    most = std::max(most, std::abs(lines[node]));
  }
  // Curvatures have a size of their own; the strongest counts 1, as the axis does where it lies in the surface.
  if (!by_axis && most > 0.0) lines /= most;
  return lines;
}

Vector solve(const Matrix& system, const Vector& right) {
  const Eigen::SimplicialLDLT<Matrix> factors(system);
  if (factors.info() != Eigen::Success) throw MethodError("the direction field's system of equations has no solution");
  return factors.solve(right);
}

Matrix with_diagonal(Matrix matrix, const Eigen::VectorXd& diagonal) {
  for (Eigen::Index i = 0; i < diagonal.size(); ++i) matrix.coeffRef(i, i) += diagonal[i];
  return matrix;
}

// The lowest eigenvector by inverse iteration, from a start that no symmetry of the part makes orthogonal to it.
Vector smoothest(const Energy& energy) {
  const double scale = energy.areas.sum();
  const Matrix system = with_diagonal(energy.smoothness, energy.areas * (1e-6 / scale));
  const Eigen::SimplicialLDLT<Matrix> factors(system);
  if (factors.info() != Eigen::Success) throw MethodError("the direction field's system of equations has no solution");
  Vector lines(energy.areas.size());
  for (Eigen::Index i = 0; i < lines.size(); ++i) lines[i] = std::polar(1.0, std::sin(static_cast<double>(i)));
  for (int k = 0; k < 30; ++k) {
    lines = factors.solve(Vector(energy.areas.cast<Complex>().cwiseProduct(lines)));
    lines /= lines.norm();
  }
  return lines;
}

Vector field_lines(const SmoothSurface& surface, const Connection& connection, const FieldGuide& guide) {
  if (guide.kind != FieldGuide::Kind::None && guide.smoothing == Length{})
    return guide_lines(surface, connection, guide);
  const Energy energy = smoothness_energy(surface, connection);
  if (guide.kind == FieldGuide::Kind::None) return smoothest(energy);
  // A guide counts by its own strength: |u − q/|q||² with weight |q|.
  const Vector lines = guide_lines(surface, connection, guide);
  const Eigen::VectorXd weights =
      (energy.areas.array() * (lines.array().abs() + 1e-9) / (guide.smoothing.mm() * guide.smoothing.mm())).matrix();
  Vector right(lines.size());
  for (Eigen::Index i = 0; i < lines.size(); ++i) {
    const double size = std::abs(lines[i]);
    right[i] = size > 0.0 ? weights[i] * lines[i] / size : Complex(0.0);
  }
  return solve(with_diagonal(energy.smoothness, weights), right);
}

// By how many turns lines turn around a triangle, transport being undone: a multiple of ½.
double index_of(const std::array<std::uint32_t, 3>& nodes, const Connection& connection, const Vector& lines) {
  double turns = 0.0;
  Complex around = 1.0;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::uint32_t a = nodes.at(k), b = nodes.at((k + 1) % 3);
    const Complex transport = connection.transport(a, b);
    turns += std::arg(lines[b] * std::conj(transport * lines[a]));
    around *= transport;
  }
  // What transport alone turns lines by is the triangle's curvature, twice.
  return std::round((turns + std::arg(around)) / (2.0 * std::numbers::pi)) / 2.0;
}

}  // namespace

DirectionField direction_field(const SmoothSurface& surface, const FieldGuide& guide) {
  require(guide.kind != FieldGuide::Kind::Axis || guide.axis.norm() > 0.0, "a field's axis needs a length");
  require(guide.smoothing >= Length{}, "a field is smoothed over a length of 0 or more");
  const Connection connection(surface);
  const Vector lines = field_lines(surface, connection, guide);
  DirectionField field;
  for (std::uint32_t node = 0; node < surface.normals.size(); ++node)
    field.directions.push_back(connection.plane(node).direction(lines[node]));
  for (std::uint32_t t = 0; t < surface.corners.size(); ++t) {
    const double index = index_of(surface.nodes[t], connection, lines);
    if (index == 0.0) continue;
    field.singularities.push_back({t, index});
    field.index_sum += index;
  }
  return field;
}

TangentFrame frame_at(const SmoothSurface& surface, const std::vector<Vector3d>& directions, std::uint32_t triangle,
                      const Vector3d& weights) {
  const auto& nodes = surface.nodes[triangle];
  Vector3d normal = Vector3d::Zero();
  for (std::size_t k = 0; k < 3; ++k) normal += weights[static_cast<Eigen::Index>(k)] * surface.normals[nodes.at(k)];
  normal.normalize();
  const TangentPlane plane(normal);
  Complex line = 0.0;
  for (std::size_t k = 0; k < 3; ++k)
    line += weights[static_cast<Eigen::Index>(k)] * plane.line(directions[nodes.at(k)]);
  return {plane.direction(line), normal};
}

}  // namespace mezzotint
