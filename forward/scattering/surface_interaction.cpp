#include "forward/scattering/surface_interaction.h"

#include <algorithm>
#include <variant>

namespace mezzotint {

namespace {

// Reflection and refraction about a normal that looks to the side the ray comes from.
SurfaceInteraction scatter(const Material& material, const Ray& ray, const Direction& facing) {
  SurfaceInteraction result;
  // Embree decided in single precision that the facet looks at the ray; the cosine may be −1e-8 here.
  const double cosine = std::max(0.0, -ray.direction.dot(facing));
  result.normal = ray.side == Side::Outside ? facing : Direction(-facing);
  result.reflected = ray.direction + 2.0 * cosine * facing;
  const auto* dielectric = std::get_if<Dielectric>(&material);
  if (dielectric == nullptr) {
    result.reflectance = reflectance(material, std::min(1.0, cosine));
    return result;
  }
  const double index = ray.side == Side::Outside ? dielectric->eta : 1.0 / dielectric->eta;
  const DielectricFresnel fresnel = dielectric_fresnel(std::min(1.0, cosine), index);
  result.reflectance = fresnel.reflectance;
  result.refracts = fresnel.reflectance < 1.0;
  if (result.refracts) {
    result.refracted = ray.direction / index + (cosine / index - fresnel.cos_refracted) * facing;
  }
  return result;
}

// A normal can be used where the ray comes from its front and both branches stay on their side of the facet.
bool usable(const SurfaceInteraction& result, const Ray& ray, const Direction& facing, const Direction& facet) {
  return ray.direction.dot(facing) < 0.0 && result.reflected.dot(facet) > 0.0 &&
         (!result.refracts || result.refracted.dot(facet) < 0.0);
}

}  // namespace

SurfaceInteraction interact(const PeriodicTile& tile, const Material& material, NormalKind normals, const Ray& ray,
                            const SurfaceHit& hit) {
  const double sign = ray.side == Side::Outside ? 1.0 : -1.0;
  const Direction facet = sign * tile.geometric_normal(hit.triangle);
  if (normals == NormalKind::Geometric) return scatter(material, ray, facet);
  const Direction smooth = sign * tile.interpolated_normal(hit.triangle, hit.u, hit.v);
  const SurfaceInteraction result = scatter(material, ray, smooth);
  if (usable(result, ray, smooth, facet)) return result;
  SurfaceInteraction fallback = scatter(material, ray, facet);
  fallback.normal_fell_back = true;
  return fallback;
}

}  // namespace mezzotint
