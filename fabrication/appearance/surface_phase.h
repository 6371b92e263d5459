#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "fabrication/appearance/smooth_surface.h"
#include "forward/base/units.h"

namespace mezzotint {

/// How well waves of one length cover a surface.
struct PhaseFigures {
  double wavelength_error = 0.0;  ///< RMS over the area of (local wavelength − wanted)/wanted
  std::size_t defects = 0;        ///< triangles in which waves begin or end
};

/// The phase of waves on a surface whose crests run across a field of lines, as one number a corner of every triangle.
///
/// The wanted waves have one length everywhere, which no single-valued phase can have on most curved surfaces: where
/// waves must begin or end, there are defects.
/// Method   a complex number a node, e^(i·phase); neighbours should differ by the wave's length along the edge; the
///          lowest eigenvector of that energy, then fixed-point steps that keep all of size 1. Since a line has no
///          head, a phase means its negative where the neighbour's line points the other way.
/// Frame    within a triangle the phase belongs to the orientation of its first corner's line.
/// Source   Knöppel, Crane, Pinkall, Schröder, "Stripe patterns on surfaces", SIGGRAPH 2015.
struct SurfacePhase {
  struct Corners {
    std::array<float, 3> turns;  ///< periods, unwrapped within the triangle
    std::int8_t winding = 0;     ///< periods that are left over around it: a defect
  };
  std::vector<Corners> triangles;
  PhaseFigures figures;
};

/// @param directions  a node: the waves' own direction, across their crests; the sign counts
/// @throws InvalidInput for a wavelength that is not positive, MethodError where the system has no answer.
[[nodiscard]] SurfacePhase surface_phase(const SmoothSurface& surface, const std::vector<Eigen::Vector3d>& directions,
                                         Length wavelength);

/// In periods.
[[nodiscard]] double phase_at(const SurfacePhase& phase, std::uint32_t triangle, const Eigen::Vector3d& weights);

}  // namespace mezzotint
