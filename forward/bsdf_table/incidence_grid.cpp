#include "forward/bsdf_table/incidence_grid.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace mezzotint {

namespace {

using Eigen::Matrix2d;
constexpr double pi = std::numbers::pi;
constexpr double negligible_weight = 1e-12;  // a node that was asked for itself, after sines and arc tangents

Matrix2d mirror_about(Angle axis) {
  const double cosine = std::cos(2.0 * axis.radians()), sine = std::sin(2.0 * axis.radians());
  return (Matrix2d() << cosine, sine, sine, -cosine).finished();
}

double axis_of(const BsdfSymmetry& symmetry) {
  const bool has_axis = symmetry.kind == SymmetryKind::Mirror || symmetry.kind == SymmetryKind::PointAndMirror;
  return has_axis ? symmetry.axis.radians() : 0.0;
}

struct Folded {
  double azimuth;
  Matrix2d turn;
};

Folded folded_mirror(const BsdfSymmetry& symmetry, double azimuth) {
  const Matrix2d mirror = mirror_about(symmetry.axis);
  Matrix2d turn = azimuth < 0.0 ? mirror : Matrix2d(Matrix2d::Identity());
  azimuth = std::abs(azimuth);
  if (symmetry.kind == SymmetryKind::PointAndMirror && azimuth > 0.5 * pi) {
    turn = -mirror * turn;
    azimuth = pi - azimuth;
  }
  return {azimuth, turn};
}

Folded folded(const BsdfSymmetry& symmetry, const Direction& to_light) {
  const double azimuth = std::remainder(std::atan2(to_light.y(), to_light.x()) - axis_of(symmetry), 2.0 * pi);
  switch (symmetry.kind) {
    case SymmetryKind::None:
      return {azimuth < 0.0 ? azimuth + 2.0 * pi : azimuth, Matrix2d::Identity()};
    case SymmetryKind::Point:
      return azimuth < 0.0 ? Folded{azimuth + pi, -Matrix2d::Identity()} : Folded{azimuth, Matrix2d::Identity()};
    case SymmetryKind::Mirror:
    case SymmetryKind::PointAndMirror:
      return folded_mirror(symmetry, azimuth);
    case SymmetryKind::Isotropic:
      break;
  }
  const double cosine = std::cos(azimuth), sine = std::sin(azimuth);
  return {0.0, (Matrix2d() << cosine, sine, -sine, cosine).finished()};
}

// A node that a symmetry leaves in place stands for itself and its images in equal parts; otherwise the BSDF would
// jump by the node's noise where the light crosses a mirror.
void add_with_images(const BsdfSymmetry& symmetry, bool at_normal, double azimuth, StencilPart part, Stencil& stencil) {
  const Matrix2d turn = part.turn, mirror = mirror_about(symmetry.axis);
  const auto add = [&](std::initializer_list<Matrix2d> images) {
    part.weight /= static_cast<double>(images.size());
    for (const Matrix2d& image : images) {
      part.turn = image * turn;
      stencil.add(part);
    }
  };
  const Matrix2d same = Matrix2d::Identity(), half_turn = -Matrix2d::Identity();
  const bool at_end = azimuth >= azimuth_range(symmetry.kind);
  if (symmetry.kind == SymmetryKind::Mirror && (at_normal || azimuth == 0.0 || at_end)) return add({same, mirror});
  if (symmetry.kind == SymmetryKind::PointAndMirror) {
    if (at_normal) return add({same, half_turn, mirror, -mirror});
    if (azimuth == 0.0) return add({same, mirror});
    if (at_end) return add({same, -mirror});
  }
  if (symmetry.kind == SymmetryKind::Point && at_normal) return add({same, half_turn});
  add({same});
}

struct RingShare {
  double weight;
  bool follows_theta;
};

void add_ring(const IncidenceGrid& grid, const IncidenceRing& ring, const RingShare& of_ring, const Folded& light,
              Stencil& stencil) {
  const auto add = [&](std::size_t k, double share, const Matrix2d& turn) {
    if (of_ring.weight * share <= negligible_weight) return;
    add_with_images(grid.symmetry, ring.theta.radians() == 0.0, ring.azimuths[k].radians(),
                    {ring.nodes[k], of_ring.weight * share, turn, of_ring.follows_theta}, stencil);
  };
  if (ring.nodes.size() == 1) return add(0, 1.0, light.turn);
  const auto above = std::upper_bound(ring.azimuths.begin(), ring.azimuths.end(), Angle::from_radians(light.azimuth));
  const bool past_last = above == ring.azimuths.end();
  const std::size_t last = ring.nodes.size() - 1;
  if (past_last && !range_wraps(grid.symmetry.kind)) return add(last, 1.0, light.turn);
  const std::size_t upper = past_last ? 0 : static_cast<std::size_t>(above - ring.azimuths.begin());
  const std::size_t lower = past_last ? last : upper - 1;
  const double end = past_last ? azimuth_range(grid.symmetry.kind) : ring.azimuths[upper].radians();
  const double begin = ring.azimuths[lower].radians();
  const double share = std::clamp((light.azimuth - begin) / (end - begin), 0.0, 1.0);
  const bool turned = past_last && grid.symmetry.kind == SymmetryKind::Point;
  add(lower, 1.0 - share, light.turn);
  add(upper, share, turned ? Matrix2d(-light.turn) : light.turn);
}

}  // namespace

double azimuth_range(SymmetryKind kind) {
  switch (kind) {
    case SymmetryKind::None:
      return 2.0 * pi;
    case SymmetryKind::Point:
    case SymmetryKind::Mirror:
      return pi;
    case SymmetryKind::PointAndMirror:
      return 0.5 * pi;
    case SymmetryKind::Isotropic:
      break;
  }
  return 0.0;
}

bool range_wraps(SymmetryKind kind) { return kind == SymmetryKind::None || kind == SymmetryKind::Point; }

DirectionAngles incidence_at(const IncidenceGrid& grid, std::size_t ring, std::size_t azimuth) {
  const double phi = axis_of(grid.symmetry) + grid.rings[ring].azimuths[azimuth].radians();
  return {grid.rings[ring].theta, Angle::from_radians(phi)};
}

Direction light_for(const StencilPart& part, const Direction& to_light, const DirectionAngles& node) {
  const Eigen::Vector2d across = part.turn * to_light.head<2>();
  const double sine = across.norm();
  if (part.follows_theta || sine == 0.0) return {across.x(), across.y(), to_light.z()};
  const double scale = std::sin(node.theta.radians()) / sine;
  return {scale * across.x(), scale * across.y(), std::cos(node.theta.radians())};
}

Stencil stencil_of(const IncidenceGrid& grid, const Direction& to_light) {
  const Angle theta = to_angles(to_light).theta;
  const Folded light = folded(grid.symmetry, to_light);
  const auto above = std::upper_bound(grid.rings.begin(), grid.rings.end(), theta,
                                      [](Angle value, const IncidenceRing& ring) { return value < ring.theta; });
  Stencil stencil;
  if (above == grid.rings.begin() || above == grid.rings.end()) {
    const IncidenceRing& ring = above == grid.rings.begin() ? *above : grid.rings.back();
    add_ring(grid, ring, {1.0, ring.follows_theta}, light, stencil);
    return stencil;
  }
  const IncidenceRing& lower = *(above - 1);
  const double share = (theta - lower.theta).radians() / (above->theta - lower.theta).radians();
  add_ring(grid, lower, {1.0 - share, lower.follows_theta}, light, stencil);
  add_ring(grid, *above, {share, lower.follows_theta}, light, stencil);
  return stencil;
}

}  // namespace mezzotint
