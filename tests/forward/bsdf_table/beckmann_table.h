#pragma once

#include <cmath>
#include <numbers>
#include <vector>

#include "forward/bsdf_table/build_bsdf_table.h"
#include "forward/optics/microfacet.h"

namespace mezzotint::test {

inline DirectionAngles degrees(double theta, double phi) {
  return {Angle::from_degrees(theta), Angle::from_degrees(phi)};
}

inline MapEstimate exact(const DirectionMap& map) { return {map, DirectionMap(map.size(), 0.0), map, map}; }

inline double albedo(const DirectionGrid& grid, const DirectionMap& map) {
  const std::vector<double> areas = projected_solid_angles(grid);
  double sum = 0.0;
  for (std::size_t k = 0; k < map.size(); ++k) sum += areas[k] * map[k];
  return sum;
}

/// A Bsdf without noise, of a Beckmann lobe that reflects everything that it reflects once.
inline ComputeBsdf beckmann(const BeckmannLobe& lobe, const DirectionGrid& grid) {
  return [=](const DirectionAngles& to_light) {
    Bsdf bsdf;
    bsdf.incidence = to_light;
    bsdf.grid = grid;
    bsdf.reflection = exact(reflection_map(lobe, Mirror{}, to_light, grid));
    bsdf.transmission = exact(DirectionMap(grid.size(), 0.0));
    bsdf.energy.reflected = {albedo(grid, bsdf.reflection.mean), 0.0};
    bsdf.provenance = {{"model", "beckmann"}};
    return bsdf;
  };
}

/// So many nodes and no refinement: rings equally far in sinθ.
inline BsdfTableOptions coarse(const BsdfSymmetry& symmetry, std::size_t rings, std::size_t azimuths = 5) {
  BsdfTableOptions options;
  options.symmetry = symmetry;
  options.coarse_rings = rings;
  options.coarse_azimuths = azimuths;
  options.most_incidences = symmetry.kind == SymmetryKind::Isotropic ? rings : 1 + (rings - 1) * azimuths;
  options.join_tolerance = 0.0;
  return options;
}

}  // namespace mezzotint::test
