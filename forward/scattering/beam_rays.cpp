#include "forward/scattering/beam_rays.h"

// One translation unit, compiled once for each instruction set.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "forward/scattering/beam_rays.cpp"  // NOLINT
#include <hwy/cache_control.h>
#include <hwy/foreach_target.h>  // IWYU pragma: keep
#include <hwy/highway.h>

#include <algorithm>
#include <array>

#include "forward/scattering/incident_light.h"

HWY_BEFORE_NAMESPACE();
namespace mezzotint::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using Doubles = hn::CappedTag<double, 8>;
using Floats = hn::Rebind<float, Doubles>;
using Ints = hn::Rebind<std::int32_t, Doubles>;
using Vd = hn::Vec<Doubles>;

constexpr Doubles dd;
constexpr Floats df;
constexpr Ints di;

// The cell of a place, brought back into a tile that `repeats`; the place in the cell goes to `within`.
HWY_INLINE hn::Vec<Ints> cell_of(Vd place, double count, bool repeats, float* within) {
  const Vd cell = hn::Floor(place), tile = hn::Set(dd, count);
  hn::StoreU(hn::DemoteTo(df, hn::Sub(place, cell)), df, within);
  const auto inside = hn::And(hn::Ge(cell, hn::Zero(dd)), hn::Lt(cell, tile));
  if (!repeats || hn::AllTrue(dd, inside)) return hn::DemoteTo(di, cell);
  // Exact: cells are whole numbers below 2^53, and a quotient of such is never rounded up to a whole number.
  return hn::DemoteTo(di, hn::Sub(cell, hn::Mul(tile, hn::Floor(hn::Div(cell, tile)))));
}

HWY_INLINE hn::Vec<Ints> front_index(const SceneFrame& frame, Vd aim_x, Vd aim_y) {
  const auto line = hn::Mul(hn::DemoteTo(di, aim_y), hn::Set(di, static_cast<std::int32_t>(frame.columns)));
  return hn::Add(line, hn::DemoteTo(di, aim_x));
}

// The front is as large as the relief and is looked at in one place a ray: it comes from far unless asked for early.
HWY_INLINE void fetch_front(const SceneFrame& frame, const Beam& beam, const double* aim_x, const double* aim_y,
                            std::size_t count) {
  HWY_ALIGN std::int32_t index[8];
  for (std::size_t k = 0; k < count; k += hn::Lanes(dd)) {
    hn::Store(front_index(frame, hn::LoadU(dd, aim_x + k), hn::LoadU(dd, aim_y + k)), di, index);
    for (std::size_t lane = 0; lane < hn::Lanes(dd); ++lane) hwy::Prefetch(beam.front->heights() + index[lane]);
  }
}

// `count` is a multiple of the vectors' width; arrays have room for it.
void aim(const SceneFrame& frame, const Beam& beam, const double* aim_x, const double* aim_y, std::size_t first,
         std::size_t count, RayBatch& rays) {
  const double columns = frame.columns, rows = frame.rows;
  const bool repeats = frame.ends != SceneEnds::Open;
  const Direction& light = beam.to_light;
  const Vd shift_x = hn::Set(dd, light.x() / light.z()), shift_y = hn::Set(dd, light.y() / (light.z() * frame.cell_y));
  const auto direction = [](double value) { return hn::Set(df, static_cast<float>(-value)); };
  const auto dx = direction(light.x()), dy = direction(light.y()), dz = direction(light.z());
  if (beam.front != nullptr) fetch_front(frame, beam, aim_x, aim_y, count);
  for (std::size_t k = 0; k < count; k += hn::Lanes(dd)) {
    const std::size_t at = first + k;
    const Vd x = hn::LoadU(dd, aim_x + k), y = hn::LoadU(dd, aim_y + k);
    auto z = hn::Set(df, beam.top);
    if (beam.front != nullptr) z = hn::GatherIndex(df, beam.front->heights(), front_index(frame, x, y));
    const Vd rise = hn::Sub(hn::PromoteTo(dd, z), hn::Set(dd, beam.plane));
    const Vd start_x = hn::Add(x, hn::Mul(rise, shift_x)), start_y = hn::Add(y, hn::Mul(rise, shift_y));
    hn::StoreU(cell_of(start_x, columns, repeats, rays.x.data() + at), di, rays.cell_x.data() + at);
    hn::StoreU(cell_of(start_y, rows, repeats, rays.y.data() + at), di, rays.cell_y.data() + at);
    hn::StoreU(z, df, rays.z.data() + at);
    hn::StoreU(dx, df, rays.dx.data() + at);
    hn::StoreU(dy, df, rays.dy.data() + at);
    hn::StoreU(dz, df, rays.dz.data() + at);
  }
}

}  // namespace mezzotint::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace mezzotint {

HWY_EXPORT(aim);

void aim_beam(const SceneFrame& frame, const Beam& beam, std::span<const double> aim_x, std::span<const double> aim_y,
              std::size_t first, AimedRays& aimed) {
  constexpr std::size_t widest = 8;
  const std::size_t count = aim_x.size(), whole = count / widest * widest;
  HWY_DYNAMIC_DISPATCH(aim)(frame, beam, aim_x.data(), aim_y.data(), first, whole, aimed.rays);
  if (whole < count) {
    std::array<double, widest> x{}, y{};
    std::copy(aim_x.begin() + whole, aim_x.end(), x.begin());
    std::copy(aim_y.begin() + whole, aim_y.end(), y.begin());
    HWY_DYNAMIC_DISPATCH(aim)(frame, beam, x.data(), y.data(), first + whole, widest, aimed.rays);
  }
  std::fill_n(aimed.rays.side.begin() + first, count, Side::Outside);
  std::fill_n(aimed.rays.left.begin() + first, count, no_half);
}

}  // namespace mezzotint

#endif
