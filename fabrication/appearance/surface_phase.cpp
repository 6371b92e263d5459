#include "fabrication/appearance/surface_phase.h"

#include <algorithm>
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
using Matrix = Eigen::SparseMatrix<double>;
using Vector = Eigen::VectorXd;  // real and imaginary part of every node in turn

// The field of a triangle, all three lines pointing the same way as the first one.
struct Oriented {
  std::array<Vector3d, 3> at, along;
  std::array<double, 3> signs;  // of the nodes' own directions
};

class Waves {
public:
  Waves(const SmoothSurface& surface, const std::vector<Vector3d>& directions, Length wavelength)
      : surface_(surface), directions_(directions), per_mm_(1.0 / wavelength.mm()) {}

  [[nodiscard]] Oriented oriented(std::size_t t) const {
    Oriented triangle{};
    const auto& nodes = surface_.nodes[t];
    for (std::size_t k = 0; k < 3; ++k) {
      triangle.at.at(k) = surface_.vertices_mm[surface_.corners[t].at(k)];
      const Vector3d there =
          transported(directions_[nodes[0]], surface_.normals[nodes[0]], surface_.normals[nodes.at(k)]);
      triangle.signs.at(k) = there.dot(directions_[nodes.at(k)]) < 0.0 ? -1.0 : 1.0;
      triangle.along.at(k) = triangle.signs.at(k) * directions_[nodes.at(k)];
    }
    return triangle;
  }
  // Periods from corner a to corner b, as the field wants them.
  [[nodiscard]] double periods(const Oriented& triangle, std::size_t a, std::size_t b) const {
    const Vector3d edge = triangle.at.at(b) - triangle.at.at(a);
    return 0.5 * per_mm_ * edge.dot(triangle.along.at(a) + triangle.along.at(b));
  }

private:
  const SmoothSurface& surface_;
  const std::vector<Vector3d>& directions_;
  double per_mm_;
};

struct Energy {
  Matrix matrix;
  Vector areas;  // of every unknown
};

using Entries = std::vector<Eigen::Triplet<double>>;

// |z_b' − e^(iω) z_a'|²·w, z' conjugated where its sign is −1.
void add_edge(Entries& entries, std::uint32_t a, std::uint32_t b, double sign_a, double sign_b, double turns,
              double weight) {
  const double angle = 2.0 * std::numbers::pi * turns, c = std::cos(angle), s = std::sin(angle);
  const auto row = [](std::uint32_t node, int part) { return static_cast<Eigen::Index>(2 * node) + part; };
  for (const std::uint32_t node : {a, b})
    for (const int part : {0, 1}) entries.emplace_back(row(node, part), row(node, part), weight);
  // z_b'ᵀ R z_a', R the rotation by ω, with the imaginary parts' signs taken in.
  const std::array<std::array<double, 2>, 2> turn = {{{c, -s * sign_a}, {s * sign_b, c * sign_a * sign_b}}};
  for (int i = 0; i < 2; ++i) {
    for (int j = 0; j < 2; ++j) {
      const double value = -weight * turn.at(static_cast<std::size_t>(i)).at(static_cast<std::size_t>(j));
      entries.emplace_back(row(b, i), row(a, j), value);
      entries.emplace_back(row(a, j), row(b, i), value);
    }
  }
}

Energy wave_energy(const SmoothSurface& surface, const Waves& waves) {
  const auto count = static_cast<Eigen::Index>(2 * surface.normals.size());
  Energy energy{Matrix(count, count), Vector::Zero(count)};
  Entries entries;
  for (std::size_t t = 0; t < surface.corners.size(); ++t) {
    const Oriented triangle = waves.oriented(t);
    const auto& nodes = surface.nodes[t];
    const double area = 0.5 * (triangle.at[1] - triangle.at[0]).cross(triangle.at[2] - triangle.at[0]).norm();
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t i = (k + 1) % 3, j = (k + 2) % 3;
      const Vector3d p = triangle.at.at(i) - triangle.at.at(k), q = triangle.at.at(j) - triangle.at.at(k);
      const double weight = std::clamp(0.5 * p.dot(q) / std::max(p.cross(q).norm(), 1e-300), 0.02, 50.0);
      add_edge(entries, nodes.at(i), nodes.at(j), triangle.signs.at(i), triangle.signs.at(j),
               waves.periods(triangle, i, j), weight);
      for (const Eigen::Index part : {0, 1})
        energy.areas[2 * static_cast<Eigen::Index>(nodes.at(k)) + part] += area / 3.0;
    }
  }
  energy.matrix.setFromTriplets(entries.begin(), entries.end());
  // Nodes of triangles without area are held too.
  energy.areas.array() += 1e-3 * energy.areas.mean();
  return energy;
}  // NOLINT(clang-analyzer-unix.Malloc): Eigen frees it

void make_unit(Vector& numbers) {
  for (Eigen::Index i = 0; i + 1 < numbers.size(); i += 2) {
    const double size = std::hypot(numbers[i], numbers[i + 1]);
    if (size > 0.0)
      numbers.segment<2>(i) /= size;
    else
      numbers.segment<2>(i) << 1.0, 0.0;
  }
}

// Minimises the energy with all numbers of size 1, drawn towards the numbers themselves by `hold` (1/mm²).
void settle(const Energy& energy, double hold, int steps, Vector& numbers) {
  Matrix system = energy.matrix;
  for (Eigen::Index i = 0; i < energy.areas.size(); ++i) system.coeffRef(i, i) += hold * energy.areas[i];
  const Eigen::SimplicialLDLT<Matrix> factors(system);
  if (factors.info() != Eigen::Success) throw MethodError("the equations for the phases of waves have no solution");
  for (int k = 0; k < steps; ++k) {
    numbers = factors.solve(Vector(energy.areas.cwiseProduct(numbers)));
    make_unit(numbers);
  }
}

// 0 … 1 once around the triangle's middle, in thirds and linear along the sides.
double around(const Eigen::Vector3d& w) {
  const auto third = [](double start, double from, double to, double opposite) {
    const double room = 1.0 - 3.0 * opposite;
    return (start + (room > 0.0 ? (to - from) / room : 0.0)) / 6.0;
  };
  if (w[2] <= w[0] && w[2] <= w[1]) return third(1.0, w[0], w[1], w[2]);
  if (w[0] <= w[1] && w[0] <= w[2]) return third(3.0, w[1], w[2], w[0]);
  return third(5.0, w[2], w[0], w[1]);
}

// Gradient of what is linear in a triangle.
Vector3d gradient(const std::array<Vector3d, 3>& at, const std::array<float, 3>& values) {
  const Vector3d across = (at[1] - at[0]).cross(at[2] - at[0]);
  Vector3d sum = Vector3d::Zero();
  for (std::size_t k = 0; k < 3; ++k)
    sum += static_cast<double>(values.at(k)) * across.cross(at.at((k + 2) % 3) - at.at((k + 1) % 3));
  return sum / std::max(across.squaredNorm(), 1e-300);
}

double to_nearest(double turns) { return turns - std::round(turns); }

// The nodes' phases, unwrapped along the triangle's sides as the field wants it.
SurfacePhase::Corners unwrapped(const Waves& waves, const Oriented& triangle, const std::array<std::uint32_t, 3>& nodes,
                                const Vector& numbers) {
  std::array<double, 3> own{};
  for (std::size_t k = 0; k < 3; ++k) {
    const auto at = 2 * static_cast<Eigen::Index>(nodes.at(k));
    own.at(k) = triangle.signs.at(k) * std::atan2(numbers[at + 1], numbers[at]) / (2.0 * std::numbers::pi);
  }
  const auto step = [&](std::size_t a, std::size_t b) {
    const double wanted = waves.periods(triangle, a, b);
    return wanted + to_nearest(own.at(b) - own.at(a) - wanted);
  };
  const double second = own[0] + step(0, 1), third = second + step(1, 2);
  const double left = third + step(2, 0) - own[0];
  return {{static_cast<float>(own[0]), static_cast<float>(second), static_cast<float>(third)},
          static_cast<std::int8_t>(std::clamp(std::lround(left), -100L, 100L))};
}

// Area-weighted mean of squares.
struct MeanSquare {
  double squares = 0.0, areas = 0.0;
  void add(double value, double area) {
    squares += area * value * value;
    areas += area;
  }
  [[nodiscard]] double root() const { return areas > 0.0 ? std::sqrt(squares / areas) : 0.0; }
};

}  // namespace

SurfacePhase surface_phase(const SmoothSurface& surface, const std::vector<Vector3d>& directions, Length wavelength) {
  require(wavelength > Length{}, "a wavelength must be positive");
  require(directions.size() == surface.normals.size(), "a phase needs one direction a node of the surface");
  const Waves waves(surface, directions, wavelength);
  const Energy energy = wave_energy(surface, waves);
  Vector numbers(energy.areas.size());
  for (Eigen::Index i = 0; i < numbers.size(); ++i) numbers[i] = std::cos(1.7 * static_cast<double>(i * i % 1009));
  settle(energy, 1e-6 / energy.areas.sum(), 20, numbers);
  settle(energy, 1e-2 / (wavelength.mm() * wavelength.mm()), 20, numbers);

  SurfacePhase phase;
  MeanSquare error;
  for (std::size_t t = 0; t < surface.corners.size(); ++t) {
    const Oriented triangle = waves.oriented(t);
    phase.triangles.push_back(unwrapped(waves, triangle, surface.nodes[t], numbers));
    const SurfacePhase::Corners& corners = phase.triangles.back();
    if (corners.winding != 0) ++phase.figures.defects;
    const double area = 0.5 * (triangle.at[1] - triangle.at[0]).cross(triangle.at[2] - triangle.at[0]).norm();
    const double frequency = gradient(triangle.at, corners.turns).norm() * wavelength.mm();
    if (corners.winding == 0 && area > 0.0 && frequency > 0.0) error.add(1.0 / frequency - 1.0, area);
  }
  phase.figures.wavelength_error = error.root();
  return phase;
}

double phase_at(const SurfacePhase& phase, std::uint32_t triangle, const Vector3d& weights) {
  const SurfacePhase::Corners& corners = phase.triangles[triangle];
  double turns = 0.0;
  for (std::size_t k = 0; k < 3; ++k)
    turns += weights[static_cast<Eigen::Index>(k)] * static_cast<double>(corners.turns.at(k));
  if (corners.winding == 0) return turns;
  // A defect: the periods that are left over are spread around its middle.
  const double less = corners.winding * (weights[1] + 2.0 * weights[2]) / 3.0;
  return turns - less + corners.winding * around(weights);
}

}  // namespace mezzotint
