#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>

#include "forward/base/random.h"
#include "forward/tracing/periodic_tile.h"
#include "forward/tracing/ray_batch.h"

namespace mezzotint::test {

/// Ray k of a batch from a place in cells of the tile.
inline void set_ray(RayBatch& rays, std::size_t k, double x, double y, double z, const Direction& way, Side side,
                    const PeriodicTile& tile) {
  const double columns = tile.columns(), rows = tile.rows();
  const double cell_x = std::floor(x), cell_y = std::floor(y);
  rays.x[k] = static_cast<float>(x - cell_x);
  rays.y[k] = static_cast<float>(y - cell_y);
  rays.z[k] = static_cast<float>(z);
  rays.cell_x[k] = static_cast<std::int32_t>(cell_x - columns * std::floor(cell_x / columns));
  rays.cell_y[k] = static_cast<std::int32_t>(cell_y - rows * std::floor(cell_y / rows));
  rays.dx[k] = static_cast<float>(way.x());
  rays.dy[k] = static_cast<float>(way.y());
  rays.dz[k] = static_cast<float>(way.z());
  rays.side[k] = side;
  rays.left[k] = no_half;
}

/// Rays of one beam from above (Outside) or below (Inside), at random points.
inline RayBatch beam(const PeriodicTile& tile, std::size_t count, double theta_deg, Side side, std::uint64_t seed = 1) {
  RayBatch rays(count);
  const RandomStream random(seed, RandomPurpose::Test);
  const double theta = theta_deg * std::numbers::pi / 180.0, down = side == Side::Outside ? -1.0 : 1.0;
  for (std::size_t k = 0; k < count; ++k) {
    const auto u = random.uniform4(k);
    const double phi = 2.0 * std::numbers::pi * u[2];
    const Direction way(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), down * std::cos(theta));
    const double z = side == Side::Outside ? tile.highest() + 0.01 : tile.lowest() - 0.01;
    set_ray(rays, k, u[0] * tile.columns(), u[1] * tile.rows(), z, way, side, tile);
  }
  return rays;
}

/// The rays reflected at their hits (those that had one), for a second look.
inline RayBatch reflected(const RayBatch& rays, const HitBatch& hits) {
  RayBatch next(rays.size());
  for (std::size_t k = 0; k < rays.size(); ++k) {
    const float a = hits.slope_x[k], b = hits.slope_y[k];
    const float twice = 2.0F * (rays.dz[k] - a * rays.dx[k] - b * rays.dy[k]) / (1.0F + a * a + b * b);
    next.dx[k] = rays.dx[k] + twice * a;
    next.dy[k] = rays.dy[k] + twice * b;
    next.dz[k] = rays.dz[k] - twice;
    next.x[k] = hits.x[k];
    next.y[k] = hits.y[k];
    next.z[k] = hits.z[k];
    next.cell_x[k] = hits.cell_x[k];
    next.cell_y[k] = hits.cell_y[k];
    next.side[k] = rays.side[k];
    next.left[k] = hits.triangle[k];
  }
  return next;
}

}  // namespace mezzotint::test
