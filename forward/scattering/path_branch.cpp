#include "forward/scattering/path_branch.h"

// One translation unit, compiled once for each instruction set.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "forward/scattering/path_branch.cpp"  // NOLINT
#include <hwy/foreach_target.h>                                  // IWYU pragma: keep
#include <hwy/highway.h>

#include <algorithm>
#include <array>

#include "forward/scattering/path_walk.h"

HWY_BEFORE_NAMESPACE();
namespace mezzotint::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using Floats = hn::CappedTag<float, 16>;
using Ints = hn::RebindToSigned<Floats>;
using Bytes = hn::Rebind<std::uint8_t, Floats>;

constexpr Floats df;
constexpr Ints di;
constexpr Bytes db;

void push(const HitBatch& hits, const FirstBranch& branch, std::uint64_t first_number, std::size_t count,
          PathBatch& next) {
  RayBatch& rays = next.rays;
  std::size_t at = next.count;
  for (std::size_t k = 0; k < count; k += hn::Lanes(df)) {
    const auto weight = hn::LoadU(df, branch.weight.data() + k);
    const auto within = hn::FirstN(df, std::min(count - k, hn::Lanes(df)));
    const auto mask = hn::And(within, hn::Gt(weight, hn::Zero(df)));
    const auto mask_i = hn::RebindMask(di, mask);
    const auto put = [&](const std::vector<float>& from, std::vector<float>& to) {
      hn::StoreU(hn::Compress(hn::LoadU(df, from.data() + k), mask), df, to.data() + at);
    };
    const auto put_i = [&](const std::int32_t* from, std::int32_t* to) {
      hn::StoreU(hn::Compress(hn::LoadU(di, from + k), mask_i), di, to + at);
    };
    put_i(hits.cell_x.data(), rays.cell_x.data());
    put_i(hits.cell_y.data(), rays.cell_y.data());
    put(hits.x, rays.x);
    put(hits.y, rays.y);
    put(hits.z, rays.z);
    put(branch.x, rays.dx);
    put(branch.y, rays.dy);
    put(branch.z, rays.dz);
    put(branch.weight, next.weight);
    put_i(reinterpret_cast<const std::int32_t*>(branch.bin.data()), reinterpret_cast<std::int32_t*>(next.bin.data()));
    const auto half = hn::PromoteTo(di, hn::LoadU(db, hits.triangle.data() + k));
    hn::StoreU(hn::DemoteTo(db, hn::Compress(half, mask_i)), db, rays.left.data() + at);
    HWY_ALIGN std::int32_t number[16];
    hn::Store(hn::Compress(hn::Iota(di, static_cast<std::int32_t>(k)), mask_i), di, number);
    for (std::size_t lane = 0; lane < hn::Lanes(df); ++lane)
      next.number[at + lane] = first_number + static_cast<std::uint32_t>(number[lane]);
    at += hn::CountTrue(df, mask);
  }
  std::fill(rays.side.data() + next.count, rays.side.data() + at, branch.side);
  std::fill(next.branch.data() + next.count, next.branch.data() + at, branch.number);
  next.count = at;
}

void sort(const RayBatch& rays, const HitBatch& hits, std::size_t count, std::array<std::uint32_t*, 4> lists,
          std::array<std::size_t, 4>& counts) {
  const auto value = [](RayEnd end) { return hn::Set(di, static_cast<std::int32_t>(end)); };
  for (std::size_t k = 0; k < count; k += hn::Lanes(df)) {
    const auto* ends = reinterpret_cast<const std::uint8_t*>(hits.end.data()) + k;
    const auto* sides = reinterpret_cast<const std::uint8_t*>(rays.side.data()) + k;
    const auto end = hn::PromoteTo(di, hn::LoadU(db, ends));
    const auto outside = hn::Eq(hn::PromoteTo(di, hn::LoadU(db, sides)), hn::Zero(di));
    const auto within = hn::FirstN(di, std::min(count - k, hn::Lanes(df)));
    const auto met = hn::And(within, hn::Eq(end, value(RayEnd::Surface)));
    const auto reflected = hn::And(within, hn::And(outside, hn::Eq(end, value(RayEnd::Above))));
    const auto transmitted = hn::And(within, hn::AndNot(outside, hn::Eq(end, value(RayEnd::Below))));
    const auto known = hn::Or(met, hn::Or(reflected, transmitted));
    const auto number = hn::Iota(di, static_cast<std::int32_t>(k));
    const auto put = [&](std::size_t list, hn::Mask<Ints> mask) {
      hn::StoreU(hn::Compress(number, mask), di, reinterpret_cast<std::int32_t*>(lists[list]) + counts[list]);
      counts[list] += hn::CountTrue(di, mask);
    };
    put(0, met);
    put(1, reflected);
    put(2, transmitted);
    if (!hn::AllFalse(di, hn::AndNot(known, within))) put(3, hn::AndNot(known, within));
  }
}

}  // namespace mezzotint::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace mezzotint {

HWY_EXPORT(push);
HWY_EXPORT(sort);

void push_branch(const HitBatch& hits, const FirstBranch& branch, std::uint64_t first_number, std::size_t count,
                 PathBatch& next) {
  HWY_DYNAMIC_DISPATCH(push)(hits, branch, first_number, count, next);
}

void EndLists::sort(const RayBatch& rays, const HitBatch& hits, std::size_t count) {
  std::array<std::size_t, 4> counts{};
  HWY_DYNAMIC_DISPATCH(sort)
  (rays, hits, count, {met_.data(), reflected_.data(), transmitted_.data(), lost_.data()}, counts);
  met = std::span(met_).first(counts[0]);
  reflected = std::span(reflected_).first(counts[1]);
  transmitted = std::span(transmitted_).first(counts[2]);
  lost = std::span(lost_).first(counts[3]);
}

}  // namespace mezzotint

#endif
