#include "forward/bsdf_table/symmetry_check.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace mezzotint {

namespace {

constexpr std::size_t lattice = 16;
constexpr double spread_by = 0.15;  // of the disc's radius, 9°

// Where the light is asked for; the symmetry says that it sees there what it saw at `from`.
std::vector<DirectionAngles> images(const BsdfSymmetry& symmetry, const DirectionAngles& from) {
  const auto turned = [&](double degrees) {
    return DirectionAngles{from.theta, from.phi + Angle::from_degrees(degrees)};
  };
  const DirectionAngles mirrored{from.theta, symmetry.axis * 2.0 - from.phi};
  switch (symmetry.kind) {
    case SymmetryKind::None:
      return {};
    case SymmetryKind::Point:
      return {turned(180.0)};
    case SymmetryKind::Mirror:
      return {mirrored};
    case SymmetryKind::PointAndMirror:
      return {turned(180.0), mirrored};
    case SymmetryKind::Isotropic:
      return {turned(52.0)};
  }
  return {};
}

// The light of a map, spread by a Gaussian, at points of a square lattice over the disc. A lobe that is thinner than a
// bin may lie on its border and fall to either side; so spread, it hardly matters.
std::vector<double> spread(const DirectionGrid& grid, const DirectionMap& map) {
  const std::vector<double> areas = projected_solid_angles(grid);
  const auto centre = [](std::size_t k, std::size_t count) {
    return (2.0 * static_cast<double>(k) + 1.0) / static_cast<double>(count) - 1.0;
  };
  std::vector<double> light(lattice * lattice);
  for (std::size_t k = 0; k < map.size(); ++k) {
    if (areas[k] * map[k] == 0.0) continue;
    const double x = centre(k % grid.width, grid.width), y = centre(k / grid.width, grid.height);
    for (std::size_t point = 0; point < light.size(); ++point) {
      const double dx = centre(point % lattice, lattice) - x, dy = centre(point / lattice, lattice) - y;
      light[point] += areas[k] * map[k] * std::exp(-0.5 * (dx * dx + dy * dy) / (spread_by * spread_by));
    }
  }
  return light;
}

// relative_l2 by two independent halves.
double difference(const Bsdf& asked, const DirectionMap& expected_map) {
  const std::vector<double> a = spread(asked.grid, asked.reflection.half_a);
  const std::vector<double> b = spread(asked.grid, asked.reflection.half_b);
  const std::vector<double> expected = spread(asked.grid, expected_map);
  double squares = 0.0, power = 0.0;
  for (std::size_t k = 0; k < expected.size(); ++k) {
    squares += (a[k] - expected[k]) * (b[k] - expected[k]);
    power += expected[k] * expected[k];
  }
  return power > 0.0 ? std::sqrt(std::max(0.0, squares) / power) : 0.0;
}

}  // namespace

SymmetryCheck check_symmetry(const BsdfTable& table, const ComputeBsdf& compute) {
  const std::vector<IncidenceRing>& rings = table.incidences.rings;
  const std::size_t ring = rings.size() / 2, azimuth = rings[ring].azimuths.size() / 2;
  const DirectionAngles from = incidence_at(table.incidences, ring, azimuth);
  // Of two Gaussians that lie a bin apart, far closer than they are wide.
  SymmetryCheck check;
  check.by_bins =
      2.0 / static_cast<double>(std::min(table.grid.width, table.grid.height)) / (std::sqrt(2.0) * spread_by);
  for (const DirectionAngles& image : images(table.incidences.symmetry, from)) {
    check.difference = std::max(check.difference, difference(compute(image), reflection_map(table, image, table.grid)));
    ++check.asked;
  }
  return check;
}

}  // namespace mezzotint
