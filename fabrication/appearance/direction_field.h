#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "fabrication/appearance/smooth_surface.h"
#include "forward/base/units.h"

namespace mezzotint {

/// What a direction field follows. The field is a line at every point: it has no head.
struct FieldGuide {
  enum class Kind {
    None,      ///< nothing: the smoothest field that there is
    Axis,      ///< an axis of the part, laid onto the surface; weak where the surface faces along it
    Curvature  ///< the direction in which the surface bends most; weak where it bends alike in all directions
  };
  Kind kind = Kind::Axis;
  Eigen::Vector3d axis = Eigen::Vector3d::UnitX();
  Angle turn;  ///< away from what it follows, counter-clockwise seen from outside
  /// Over about this distance the field smooths what it follows. 0: as it is, wherever it is.
  Length smoothing = Length::from_mm(0.5);
};

/// A triangle about which the field turns: by `index` whole turns when one walks around it, a multiple of ½.
struct FieldSingularity {
  std::uint32_t triangle = 0;
  double index = 0.0;
};

/// A smooth field of tangent lines.
///
/// Method   lines as complex numbers of twice their angle, in a tangent plane for each node; neighbours are compared by
///          parallel transport along the edge, weighted by cotangents: minimum of that energy plus the distance to the
///          guide over smoothing², one sparse Hermitian system; without a guide its lowest eigenvector.
/// Creases  nothing is transported over them: each smooth piece has a field of its own.
/// Source   Knöppel, Crane, Pinkall, Schröder, "Globally optimal direction fields", SIGGRAPH 2013.
struct DirectionField {
  std::vector<Eigen::Vector3d> directions;  ///< a node: a unit tangent; its sign means nothing
  std::vector<FieldSingularity> singularities;
  double index_sum = 0.0;  ///< over a closed smooth piece: its Euler characteristic (2 for a sphere, 0 for a torus)
};

/// @throws InvalidInput for an axis without length or a negative smoothing, MethodError where the system has no answer.
[[nodiscard]] DirectionField direction_field(const SmoothSurface& surface, const FieldGuide& guide);

/// Direction of strongest bending at every node, a tangent as long as the two principal curvatures differ (1/mm).
/// Source   Rusinkiewicz, "Estimating curvatures and their derivatives on triangle meshes", 3DPVT 2004.
[[nodiscard]] std::vector<Eigen::Vector3d> bending_directions(const SmoothSurface& surface);

/// The field's line at a point of a triangle, and the surface's normal there: both continuous within a smooth piece.
struct TangentFrame {
  Eigen::Vector3d along, normal;
};
[[nodiscard]] TangentFrame frame_at(const SmoothSurface& surface, const std::vector<Eigen::Vector3d>& directions,
                                    std::uint32_t triangle, const Eigen::Vector3d& weights);

}  // namespace mezzotint
