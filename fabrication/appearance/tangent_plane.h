#pragma once

#include <cmath>
#include <complex>

#include <Eigen/Core>
#include <Eigen/Geometry>

/// Inside of fabrication/appearance.

namespace mezzotint {

/// Two unit vectors that span the plane across a normal; right-handed with it. A function of the normal alone.
struct TangentPlane {
  Eigen::Vector3d u, v;
  explicit TangentPlane(const Eigen::Vector3d& normal) : u(normal.unitOrthogonal()), v(normal.cross(u)) {}

  /// A line of that direction: e^(2iα) times the squared length of its projection.
  [[nodiscard]] std::complex<double> line(const Eigen::Vector3d& direction) const {
    const std::complex<double> z(direction.dot(u), direction.dot(v));
    return z * z;
  }
  [[nodiscard]] Eigen::Vector3d direction(const std::complex<double>& line) const {
    const double angle = 0.5 * std::arg(line);
    return std::cos(angle) * u + std::sin(angle) * v;
  }
};

/// The turn of a vector by the shortest rotation that takes one unit normal to another.
[[nodiscard]] inline Eigen::Vector3d transported(const Eigen::Vector3d& vector, const Eigen::Vector3d& from,
                                                 const Eigen::Vector3d& to) {
  // Rodrigues' formula with the unnormalised axis; opposite normals have no shortest rotation.
  const Eigen::Vector3d axis = from.cross(to);
  const double cosine = from.dot(to);
  if (cosine < -0.999999) return vector;
  return cosine * vector + axis.cross(vector) + axis * (axis.dot(vector) / (1.0 + cosine));
}

}  // namespace mezzotint
