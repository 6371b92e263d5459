#pragma once

#include <vector>

#include "forward/bsdf_table/adaptive_map.h"
#include "forward/bsdf_table/incidence_grid.h"
#include "forward/optics/bsdf.h"

namespace mezzotint {

/// The BSDF of a relief for all directions of the light: four dimensions, stored for some of them.
///
/// Frame    that of Bsdf; light from above only.
/// Shape    a node a stored direction of the light, each with an adaptive map of reflection, and of transmission
///          where any node has light there.
/// Between  nodes a lobe is moved with the light (LobeWarp), node by node, and the moved lobes are added by the
///          stencil's weights. So the albedo is linear between nodes in θ and φ, and nothing is negative.
/// Beyond   the last ring, its lobes go on moving with the light; their albedo stays.
struct BsdfTableNode {
  DirectionAngles incidence;
  EnergyAudit energy;
  AdaptiveMap reflection;
  AdaptiveMap transmission;
};
struct BsdfTable {
  DirectionGrid grid;
  double relative_index = 1.5;  ///< where lobes of transmission move to, by Snell's law
  IncidenceGrid incidences;     ///< its numbers are places in `nodes`
  std::vector<BsdfTableNode> nodes;
  Provenance provenance;
};
/// @throws InvalidInput for a table without rings, with rings or azimuths out of order or range, node numbers that do
///         not exist, or an index outside of [1.0001, 10].
void require_valid(const BsdfTable& table);

/// The functions of directions do not check the table: they stand in inner loops. Directions are unit vectors. A light
/// at or below the horizon gives 0. Each costs a stencil of up to four nodes (eight on mirrors), some 0.1 µs a node.

/// BRDF (viewer above) or BTDF (below), per steradian, with the noise of the stored maps as standard error: nodes
/// taken as independent; the error of interpolation is not in it.
[[nodiscard]] Estimate evaluate(const BsdfTable& table, const Direction& to_light, const Direction& to_viewer);

/// The share of light that is scattered at all: albedo of reflection plus transmission.
[[nodiscard]] double scattered_share(const BsdfTable& table, const Direction& to_light);

/// Draws a direction with density f cosθ / scattered_share, so that every sample has the same weight.
struct BsdfSample {
  Direction to_viewer = Direction::Zero();
  double pdf = 0.0;     ///< per steradian; 0: no light is scattered, and there is no direction
  double weight = 0.0;  ///< f · |cosθ| / pdf: the scattered share
};
/// @param u1,u2  uniform in [0, 1).
[[nodiscard]] BsdfSample sample(const BsdfTable& table, const Direction& to_light, double u1, double u2);

/// Density of `sample`, per steradian. Over both hemispheres it integrates to 1.
[[nodiscard]] double pdf(const BsdfTable& table, const Direction& to_light, const Direction& to_viewer);

/// The reflection for one direction of the light as a plain map: the table averaged over bins, at `samples` ×
/// `samples` points each. For pictures and comparisons; milliseconds.
/// @throws InvalidInput for a bad grid, a light below the horizon, or `samples` outside of 1 … 1024.
[[nodiscard]] DirectionMap reflection_map(const BsdfTable& table, const DirectionAngles& to_light,
                                          const DirectionGrid& grid, std::size_t samples = 4);

}  // namespace mezzotint
