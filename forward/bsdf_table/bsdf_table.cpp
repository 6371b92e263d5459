#include "forward/bsdf_table/bsdf_table.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "forward/base/error.h"

namespace mezzotint {

namespace {

void require_valid(const IncidenceRing& ring, const BsdfSymmetry& symmetry, std::size_t node_count) {
  const auto is_angle = [](Angle angle, double most) { return angle.radians() >= 0.0 && angle.radians() <= most; };
  require(is_angle(ring.theta, 0.5 * std::numbers::pi) && ring.theta.radians() < 0.5 * std::numbers::pi,
          "a ring of a BSDF table lies at 0 <= theta < 90 degrees");
  require(!ring.nodes.empty() && ring.nodes.size() == ring.azimuths.size(),
          "a ring of a BSDF table has a node for every azimuth, and one at least");
  require(ring.nodes.size() == 1 || (ring.theta.radians() > 0.0 && symmetry.kind != SymmetryKind::Isotropic),
          "the normal, and every ring of an isotropic BSDF table, has one azimuth");
  for (const Angle azimuth : ring.azimuths) {
    require(is_angle(azimuth, azimuth_range(symmetry.kind)), "an azimuth of a BSDF table lies outside of its range");
  }
  for (std::size_t k = 1; k < ring.azimuths.size(); ++k) {
    require(ring.azimuths[k - 1] < ring.azimuths[k], "the azimuths of a BSDF table do not ascend");
  }
  // Otherwise a look-up would find no node before the first azimuth.
  require(ring.azimuths.front().radians() == 0.0, "the azimuths of a BSDF table do not begin at its axis");
  for (const std::size_t node : ring.nodes) require(node < node_count, "a BSDF table names a node that it has not");
}

}  // namespace

void require_valid(const BsdfTable& table) {
  require_valid(table.grid);
  require(table.relative_index >= 1.0001 && table.relative_index <= 10.0,
          "the relative index of a BSDF table lies in [1.0001, 10]");
  require(std::isfinite(table.incidences.symmetry.axis.radians()), "the axis of a BSDF table is no number");
  const std::vector<IncidenceRing>& rings = table.incidences.rings;
  require(!rings.empty(), "a BSDF table has no direction of the light");
  for (const IncidenceRing& ring : rings) require_valid(ring, table.incidences.symmetry, table.nodes.size());
  for (std::size_t k = 1; k < rings.size(); ++k) {
    require(rings[k - 1].theta < rings[k].theta, "the rings of a BSDF table do not ascend in theta");
  }
}

DirectionMap reflection_map(const BsdfTable& table, const DirectionAngles& to_light, const DirectionGrid& grid,
                            std::size_t samples) {
  const Direction light = to_direction(to_light);
  require(light.z() > 0.0, "the light of a reflection map stands above the horizon");
  return average_over_bins(
      grid, [&](const Direction& viewer) { return evaluate(table, light, viewer).value; }, samples);
}

}  // namespace mezzotint
