#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "forward/optics/direction.h"

namespace mezzotint {

/// What turning or mirroring of the sample leaves its BSDF as it was.
enum class SymmetryKind {
  None,
  Point,           ///< half a turn about the normal: any relief that looks alike upside down
  Mirror,          ///< a mirror that contains the normal and the axis
  PointAndMirror,  ///< both, so two mirrors at right angles: ridges, gratings
  Isotropic        ///< any turn, and mirrors
};
struct BsdfSymmetry {
  SymmetryKind kind = SymmetryKind::Isotropic;
  Angle axis;  ///< of the mirror, from +x; without meaning for the other kinds
};

/// The range of azimuths, from the axis on, that tells all others: 2π, π, π, π/2, 0.
[[nodiscard]] double azimuth_range(SymmetryKind kind);
/// Whether the end of that range is its beginning again (None, Point), not a mirror.
[[nodiscard]] bool range_wraps(SymmetryKind kind);

/// Directions of the light: rings of equal θ, each with azimuths of its own.
///
/// Frame    azimuths run from the symmetry's axis (from +x where the kind has none) and lie in azimuth_range;
///          both ends of a range that does not wrap are nodes. A ring at θ = 0 has one node.
struct IncidenceRing {
  Angle theta;
  std::vector<Angle> azimuths;     ///< ascending
  std::vector<std::size_t> nodes;  ///< a number of the caller's for each
  /// Whether lobes follow the light's θ from here to the next ring; its φ they follow always. At grazing incidence on
  /// bins that are coarse for the lobe, staying is closer.
  bool follows_theta = true;
};
struct IncidenceGrid {
  BsdfSymmetry symmetry;
  std::vector<IncidenceRing> rings;  ///< ascending in θ
};
[[nodiscard]] DirectionAngles incidence_at(const IncidenceGrid& grid, std::size_t ring, std::size_t azimuth);

/// A node's share in a direction of the light, and the turn (or mirror) of the sample that brings that direction
/// near the node.
struct StencilPart {
  std::size_t node = 0;
  double weight = 0.0;
  Eigen::Matrix2d turn = Eigen::Matrix2d::Identity();
  bool follows_theta = true;
};
/// Where the light stands for a lobe that was stored for `node`: turned, and at the node's θ where the lobe stays
/// there.
[[nodiscard]] Direction light_for(const StencilPart& part, const Direction& to_light, const DirectionAngles& node);
/// At most four nodes, those on a mirror twice and that at the normal up to four times; parts of a node are
/// neighbours. The weights are positive and sum to 1.
class Stencil {
public:
  void add(const StencilPart& part) { parts_.at(count_++) = part; }
  [[nodiscard]] const StencilPart* begin() const { return parts_.data(); }
  [[nodiscard]] const StencilPart* end() const { return parts_.data() + count_; }
  [[nodiscard]] std::size_t size() const { return count_; }

private:
  std::array<StencilPart, 8> parts_;
  std::size_t count_ = 0;
};

/// Weights linear in θ and φ; beyond the last ring its nodes alone.
[[nodiscard]] Stencil stencil_of(const IncidenceGrid& grid, const Direction& to_light);

}  // namespace mezzotint
