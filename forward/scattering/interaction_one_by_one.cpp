#include <algorithm>
#include <cmath>
#include <variant>

#include "forward/scattering/interaction_batch.h"

namespace mezzotint {

namespace {

struct SurfaceInteraction {
  double reflectance = 1.0;
  bool refracts = false;
  Direction reflected, refracted;
};

// Reflection and refraction about a normal that looks to the side the ray comes from.
SurfaceInteraction scatter(const Material& material, const Direction& way, Side side, const Direction& facing) {
  SurfaceInteraction result;
  // A tracer decided in single precision that the facet looks at the ray; the cosine may be −1e-8 here.
  const double cosine = std::max(0.0, -way.dot(facing));
  result.reflected = way + 2.0 * cosine * facing;
  const auto* dielectric = std::get_if<Dielectric>(&material);
  if (dielectric == nullptr) {
    result.reflectance = reflectance(material, std::min(1.0, cosine));
    return result;
  }
  const double index = side == Side::Outside ? dielectric->eta : 1.0 / dielectric->eta;
  const DielectricFresnel fresnel = dielectric_fresnel(std::min(1.0, cosine), index);
  result.reflectance = fresnel.reflectance;
  result.refracts = fresnel.reflectance < 1.0;
  if (result.refracts) result.refracted = way / index + (cosine / index - fresnel.cos_refracted) * facing;
  return result;
}

// A normal can be used where the ray comes from its front and both branches stay on their side of the facet.
bool usable(const SurfaceInteraction& result, const Direction& way, const Direction& facing, const Direction& facet) {
  return way.dot(facing) < 0.0 && result.reflected.dot(facet) > 0.0 &&
         (!result.refracts || result.refracted.dot(facet) < 0.0);
}

// Weights of a triangle's second and third corner at a place in its cell.
std::pair<double, double> weights(std::uint8_t triangle, double x, double y) {
  return triangle == 0 ? std::pair{x - y, y} : std::pair{x, y - x};
}

// A direction along the horizon may be a rounding error longer than 1; it belongs to the rim.
std::uint32_t bin_of(const DirectionGrid& grid, const Direction& way) {
  constexpr double largest = 1.0 - 4e-7;
  const double square = way.x() * way.x() + way.y() * way.y();
  const double inward = square > largest ? std::sqrt(largest / square) : 1.0;
  return static_cast<std::uint32_t>(grid.bin_of(way.x() * inward, way.y() * inward));
}

void store(const SurfaceInteraction& one, const DirectionGrid& grid, std::size_t k, InteractionBatch& result) {
  result.reflectance[k] = static_cast<float>(one.reflectance);
  result.refracts[k] = one.refracts ? 1 : 0;
  result.reflected_x[k] = static_cast<float>(one.reflected.x());
  result.reflected_y[k] = static_cast<float>(one.reflected.y());
  result.reflected_z[k] = static_cast<float>(one.reflected.z());
  result.reflected_bin[k] = bin_of(grid, one.reflected);
  if (!one.refracts) return;
  result.refracted_bin[k] = bin_of(grid, one.refracted);
  result.refracted_x[k] = static_cast<float>(one.refracted.x());
  result.refracted_y[k] = static_cast<float>(one.refracted.y());
  result.refracted_z[k] = static_cast<float>(one.refracted.z());
}

}  // namespace

void interact_one_by_one(const PeriodicTile* tile, const Material& material, const DirectionGrid& grid,
                         NormalKind normals, const RayBatch& rays, const HitBatch& hits, std::size_t count,
                         InteractionBatch& result) {
  for (std::size_t k = 0; k < count; ++k) {
    if (hits.end[k] != RayEnd::Surface) continue;
    const Direction way = Direction(rays.dx[k], rays.dy[k], rays.dz[k]).normalized();
    const double sign = rays.side[k] == Side::Outside ? 1.0 : -1.0;
    const double rise = hits.rise.empty() ? 1.0 : double{hits.rise[k]};
    const Direction facet = sign * Direction(-hits.slope_x[k], -hits.slope_y[k], rise).normalized();
    if (normals == NormalKind::Geometric) {
      store(scatter(material, way, rays.side[k], facet), grid, k, result);
      continue;
    }
    const auto cell =
        static_cast<std::uint32_t>(hits.cell_y[k]) * tile->columns() + static_cast<std::uint32_t>(hits.cell_x[k]);
    const auto [u, v] = weights(hits.triangle[k], double{hits.x[k]}, double{hits.y[k]});
    const Direction smooth = sign * tile->interpolated_normal(2 * cell + hits.triangle[k], u, v);
    const SurfaceInteraction about_smooth = scatter(material, way, rays.side[k], smooth);
    const bool good = usable(about_smooth, way, smooth, facet);
    if (!good) ++result.normal_fallbacks;
    store(good ? about_smooth : scatter(material, way, rays.side[k], facet), grid, k, result);
  }
}

}  // namespace mezzotint
