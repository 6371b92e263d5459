#include "forward/scattering/interaction_batch.h"

// One translation unit, compiled once for each instruction set.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "forward/scattering/interaction_geometric.cpp"  // NOLINT
#include <hwy/foreach_target.h>                                            // IWYU pragma: keep
#include <hwy/highway.h>

#include <variant>

HWY_BEFORE_NAMESPACE();
namespace mezzotint::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using Floats = hn::CappedTag<float, 16>;
using Ints = hn::RebindToSigned<Floats>;
using Vf = hn::Vec<Floats>;
using Mf = hn::Mask<Floats>;

constexpr Floats df;

// Unpolarised Fresnel reflectance; Born & Wolf §1.5. `cos_refracted` is 0 at total internal reflection.
HWY_INLINE Vf dielectric(Vf cosine, Vf index, Vf& cos_refracted) {
  const Vf one = hn::Set(df, 1.0F), zero = hn::Zero(df);
  const Vf sine_square = hn::Div(hn::Sub(one, hn::Mul(cosine, cosine)), hn::Mul(index, index));
  cos_refracted = hn::Sqrt(hn::Max(zero, hn::Sub(one, sine_square)));
  const Vf a = hn::Mul(index, cosine), b = hn::Mul(index, cos_refracted);
  const Vf s = hn::Div(hn::Sub(cosine, b), hn::Add(cosine, b));
  const Vf p = hn::Div(hn::Sub(a, cos_refracted), hn::Add(a, cos_refracted));
  const Vf mean = hn::Mul(hn::Set(df, 0.5F), hn::Add(hn::Mul(s, s), hn::Mul(p, p)));
  return hn::IfThenElse(hn::Lt(sine_square, one), hn::Min(mean, one), one);
}

// The same for a complex index, by its real form.
HWY_INLINE Vf conductor(Vf cosine, Vf eta, Vf kappa) {
  const Vf one = hn::Set(df, 1.0F), two = hn::Set(df, 2.0F), half = hn::Set(df, 0.5F);
  const Vf cos2 = hn::Mul(cosine, cosine), sin2 = hn::Sub(one, cos2);
  const Vf eta2 = hn::Mul(eta, eta), kappa2 = hn::Mul(kappa, kappa);
  const Vf t0 = hn::Sub(hn::Sub(eta2, kappa2), sin2);
  const Vf sum = hn::Sqrt(hn::Add(hn::Mul(t0, t0), hn::Mul(hn::Set(df, 4.0F), hn::Mul(eta2, kappa2))));
  const Vf a = hn::Sqrt(hn::Max(hn::Zero(df), hn::Mul(half, hn::Add(sum, t0))));
  const Vf t1 = hn::Add(sum, cos2), t2 = hn::Mul(two, hn::Mul(a, cosine));
  const Vf s = hn::Div(hn::Sub(t1, t2), hn::Add(t1, t2));
  const Vf t3 = hn::Add(hn::Mul(cos2, sum), hn::Mul(sin2, sin2)), t4 = hn::Mul(t2, sin2);
  const Vf p = hn::Mul(s, hn::Div(hn::Sub(t3, t4), hn::Add(t3, t4)));
  return hn::Mul(half, hn::Add(s, p));
}

// The bin of a direction. One along the horizon may be a rounding error longer than 1; it belongs to the rim.
HWY_INLINE hn::Vec<Ints> bin_of(const DirectionGrid& grid, Vf x, Vf y) {
  const Ints di;
  const Vf one = hn::Set(df, 1.0F), largest = hn::Set(df, 1.0F - 4e-7F);
  const Vf square = hn::Add(hn::Mul(x, x), hn::Mul(y, y));
  const Vf inward = hn::IfThenElse(hn::Gt(square, largest), hn::Sqrt(hn::Div(largest, square)), one);
  const auto along = [&](Vf place, std::size_t bins) {
    const Vf scaled = hn::Mul(hn::Add(hn::Mul(place, inward), one), hn::Set(df, 0.5F * static_cast<float>(bins)));
    return hn::Min(hn::ConvertTo(di, scaled), hn::Set(di, static_cast<std::int32_t>(bins) - 1));
  };
  return hn::Add(hn::Mul(along(y, grid.height), hn::Set(di, static_cast<std::int32_t>(grid.width))),
                 along(x, grid.width));
}

void shade(const Material& material, const DirectionGrid& grid, const RayBatch& rays, const HitBatch& hits,
           std::size_t count, InteractionBatch& result) {
  const hn::Rebind<std::uint8_t, Floats> db;
  const Ints di;
  const Vf one = hn::Set(df, 1.0F), zero = hn::Zero(df);
  const auto* clear = std::get_if<Dielectric>(&material);
  const auto* metal = std::get_if<Conductor>(&material);
  const auto eta = clear != nullptr ? static_cast<float>(clear->eta) : 1.0F;
  for (std::size_t k = 0; k < count; k += hn::Lanes(df)) {
    const auto load = [&](const std::vector<float>& part) { return hn::LoadU(df, part.data() + k); };
    const Vf a = load(hits.slope_x), b = load(hits.slope_y);
    const Vf dx = load(rays.dx), dy = load(rays.dy), dz = load(rays.dz);
    const auto* sides = reinterpret_cast<const std::uint8_t*>(rays.side.data()) + k;
    const Mf inside = hn::RebindMask(df, hn::Ne(hn::PromoteTo(di, hn::LoadU(db, sides)), hn::Zero(di)));
    // The normal (−a, −b, 1)/length, turned to the side that the ray comes from.
    const Vf square = hn::Add(one, hn::Add(hn::Mul(a, a), hn::Mul(b, b)));
    const Vf per_length = hn::Div(one, hn::Sqrt(square));
    const Vf sign = hn::IfThenElse(inside, hn::Neg(per_length), per_length);
    const Vf nx = hn::Neg(hn::Mul(a, sign)), ny = hn::Neg(hn::Mul(b, sign)), nz = sign;
    const Vf facing = hn::Neg(hn::Add(hn::Mul(dx, nx), hn::Add(hn::Mul(dy, ny), hn::Mul(dz, nz))));
    const Vf cosine = hn::Min(one, hn::Max(zero, facing));
    const Vf twice = hn::Add(cosine, cosine);
    const Vf reflected_x = hn::Add(dx, hn::Mul(twice, nx)), reflected_y = hn::Add(dy, hn::Mul(twice, ny));
    hn::StoreU(reflected_x, df, result.reflected_x.data() + k);
    hn::StoreU(reflected_y, df, result.reflected_y.data() + k);
    hn::StoreU(bin_of(grid, reflected_x, reflected_y), di,
               reinterpret_cast<std::int32_t*>(result.reflected_bin.data()) + k);
    hn::StoreU(hn::Add(dz, hn::Mul(twice, nz)), df, result.reflected_z.data() + k);
    if (clear != nullptr) {
      const Vf index = hn::IfThenElse(inside, hn::Set(df, 1.0F / eta), hn::Set(df, eta));
      const Vf per_index = hn::IfThenElse(inside, hn::Set(df, eta), hn::Set(df, 1.0F / eta));
      Vf cos_refracted;
      const Vf share = dielectric(cosine, index, cos_refracted);
      const Vf along = hn::Sub(hn::Mul(cosine, per_index), cos_refracted);
      hn::StoreU(share, df, result.reflectance.data() + k);
      const Vf refracted_x = hn::Add(hn::Mul(dx, per_index), hn::Mul(along, nx));
      const Vf refracted_y = hn::Add(hn::Mul(dy, per_index), hn::Mul(along, ny));
      hn::StoreU(refracted_x, df, result.refracted_x.data() + k);
      hn::StoreU(refracted_y, df, result.refracted_y.data() + k);
      hn::StoreU(bin_of(grid, refracted_x, refracted_y), di,
                 reinterpret_cast<std::int32_t*>(result.refracted_bin.data()) + k);
      hn::StoreU(hn::Add(hn::Mul(dz, per_index), hn::Mul(along, nz)), df, result.refracted_z.data() + k);
      const hn::Vec<Ints> goes_on = hn::IfThenElseZero(hn::RebindMask(di, hn::Lt(share, one)), hn::Set(di, 1));
      hn::StoreU(hn::DemoteTo(db, goes_on), db, result.refracts.data() + k);
    } else {
      const Vf share = metal == nullptr ? one
                                        : conductor(cosine, hn::Set(df, static_cast<float>(metal->eta)),
                                                    hn::Set(df, static_cast<float>(metal->kappa)));
      hn::StoreU(share, df, result.reflectance.data() + k);
      hn::StoreU(hn::DemoteTo(db, hn::Zero(di)), db, result.refracts.data() + k);
    }
  }
}

}  // namespace mezzotint::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace mezzotint {

HWY_EXPORT(shade);

void interact_geometric(const Material& material, const DirectionGrid& grid, const RayBatch& rays, const HitBatch& hits,
                        std::size_t count, InteractionBatch& result) {
  HWY_DYNAMIC_DISPATCH(shade)(material, grid, rays, hits, count, result);
}

}  // namespace mezzotint

#endif
