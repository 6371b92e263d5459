#include "forward/tracing/height_field_tracer.h"

// One translation unit, compiled once for each instruction set; the best that the machine has is taken at run time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "forward/tracing/height_field_tracer.cpp"  // NOLINT
#include <hwy/foreach_target.h>                                       // IWYU pragma: keep
#include <hwy/highway.h>

#include <vector>

HWY_BEFORE_NAMESPACE();
namespace mezzotint::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using Floats = hn::CappedTag<float, 16>;
using Ints = hn::RebindToSigned<Floats>;
using Vf = hn::Vec<Floats>;
using Vi = hn::Vec<Ints>;
using Mf = hn::Mask<Floats>;
using Mi = hn::Mask<Ints>;

constexpr std::size_t max_lanes = 16;
// States of a lane, in place of a pyramid level.
constexpr std::int32_t idle = -1;
// No level speed is below this, so that no time to a border is infinite: 0 · ∞ is NaN.
constexpr float least_speed = 1e-18F;
constexpr float below_one = 0x1.fffffep-1F;

/// The rays that are being traced, one a lane. Everything runs in "travel space": along an axis with a negative
/// direction a cell i is numbered −1 − i (all its bits turned), so that every ray goes towards larger numbers.
/// Rays from below run through the relief turned over (z → −z).
struct Lanes {
  Vi ray;                                   // number in the batch
  Vi cell_x, cell_y;                        // travel space
  Vi flip_x, flip_y;                        // 0, or −1 for a negative direction
  Vi end_x, end_y;                          // first cell beyond the tile
  Vf x, y, z;                               // place in the cell, travel space
  Vf speed_x, speed_y, dz, time_x, time_y;  // speeds ≥ 0; times to cross a cell
  Vi level;
  Vi tiles;  // crossed so far
  // What is found:
  Vi end;  // RayEnd
  Vf slope_x, slope_y;
  Vi half;
};

template <bool inside>
class Kernel {
public:
  Kernel(const HeightPyramid& relief, const RayBatch& rays, std::size_t count, HitBatch& hits)
      : relief_(relief), top_(inside ? -relief.lowest : relief.highest), rays_(rays), count_(count), hits_(hits) {
    queue_.resize(count + max_lanes);
  }

  void run() {
    set_aside_escaping();
    Lanes groups[group_count] = {empty(), empty()};
    bool open = true;
    while (open) {
      open = false;
      for (Lanes& lanes : groups) open |= advance(lanes);
    }
  }

private:
  Lanes empty() const {
    const Vf zero = hn::Zero(df_);
    const Vi none = hn::Zero(di_);
    Lanes lanes{none, none, none, none, none, none, none, zero, zero, zero, zero,
                zero, zero, zero, zero, none, none, none, zero, zero, none};
    lanes.level = hn::Set(di_, idle);
    lanes.ray = hn::Set(di_, -1);
    return lanes;
  }

  // Two groups of lanes take turns: while one waits for memory, the other computes.
  static constexpr std::size_t group_count = 2;

  // One step of a group; lanes are refilled when half of them are idle. False when nothing is left to do.
  HWY_INLINE bool advance(Lanes& lanes) {
    const std::size_t width = hn::Lanes(df_);
    Mi working = hn::Gt(lanes.level, hn::Set(di_, idle));
    const std::size_t busy = hn::CountTrue(di_, working);
    if (busy <= width / 2 && (next_ < waiting_ || busy == 0)) {
      finish(lanes);
      if (next_ == waiting_ && busy == 0) return false;
      refill(lanes, hn::Not(working));
      working = hn::Gt(lanes.level, hn::Set(di_, idle));
    }
    step(lanes, working);
    return true;
  }

  // Of the rays on this side: one that rises more steeply than any facet has left the relief for good, the others
  // wait for a lane.
  void set_aside_escaping() {
    const std::size_t width = hn::Lanes(df_);
    const Vf zero = hn::Zero(df_), limit = hn::Set(df_, relief_.steepest * relief_.steepest * 1.00001F);
    const Vf top = hn::Set(df_, inside ? -relief_.lowest : relief_.highest);
    for (std::size_t first = 0; first < count_; first += width) {
      const Vf dx = hn::LoadU(df_, rays_.dx.data() + first), dy = hn::LoadU(df_, rays_.dy.data() + first);
      const Vf dz = hn::LoadU(df_, rays_.dz.data() + first), z = hn::LoadU(df_, rays_.z.data() + first);
      const Vf up = inside ? hn::Neg(dz) : dz, height = inside ? hn::Neg(z) : z;
      const Vf level_square = hn::Add(hn::Mul(dx, dx), hn::Mul(dy, dy));
      const Mf gone =
          hn::And(hn::Ge(up, zero), hn::Or(hn::Gt(hn::Mul(up, up), hn::Mul(limit, level_square)), hn::Ge(height, top)));
      const Vi side = hn::PromoteTo(di_, hn::LoadU(bytes_, bytes(rays_.side) + first));
      const Vi number = hn::Add(hn::Iota(di_, 0), hn::Set(di_, static_cast<std::int32_t>(first)));
      const Mi ours = hn::And(hn::Eq(side, hn::Set(di_, inside ? 1 : 0)),
                              hn::Lt(number, hn::Set(di_, static_cast<std::int32_t>(count_))));
      const Mi gone_i = hn::RebindMask(di_, gone);
      const Vi before = hn::PromoteTo(di_, hn::LoadU(bytes_, bytes(hits_.end) + first));
      const Vi end = hn::IfThenElse(hn::And(ours, gone_i), hn::Set(di_, static_cast<std::int32_t>(way_out)), before);
      hn::StoreU(hn::DemoteTo(bytes_, end), bytes_, bytes(hits_.end) + first);
      waiting_ += hn::CompressStore(number, hn::AndNot(gone_i, ours), di_, queue_.data() + waiting_);
    }
  }

  static constexpr RayEnd way_out = inside ? RayEnd::Below : RayEnd::Above;
  template <class T>
  static const std::uint8_t* bytes(const std::vector<T>& part) {
    return reinterpret_cast<const std::uint8_t*>(part.data());
  }
  template <class T>
  static std::uint8_t* bytes(std::vector<T>& part) {
    return reinterpret_cast<std::uint8_t*>(part.data());
  }

  // Hands the rays in the idle lanes over to the caller.
  HWY_INLINE void finish(Lanes& lanes) {
    HWY_ALIGN std::int32_t ray[max_lanes], cell_x[max_lanes], cell_y[max_lanes], half[max_lanes], end[max_lanes];
    HWY_ALIGN float x[max_lanes], y[max_lanes], z[max_lanes], slope_x[max_lanes], slope_y[max_lanes];
    const Mi over = hn::And(hn::Eq(lanes.level, hn::Set(di_, idle)), hn::Gt(lanes.ray, hn::Set(di_, -1)));
    if (hn::AllFalse(di_, over)) return;
    const Vi place_x = hn::Xor(lanes.cell_x, lanes.flip_x), place_y = hn::Xor(lanes.cell_y, lanes.flip_y);
    if (hn::AllTrue(di_, over)) {
      const auto first = static_cast<std::size_t>(hn::GetLane(lanes.ray));
      const Vi in_order = hn::Add(hn::Iota(di_, 0), hn::Set(di_, static_cast<std::int32_t>(first)));
      if (hn::AllTrue(di_, hn::Eq(in_order, lanes.ray))) {
        hn::StoreU(place_x, di_, hits_.cell_x.data() + first);
        hn::StoreU(place_y, di_, hits_.cell_y.data() + first);
        hn::StoreU(lanes.x, df_, hits_.x.data() + first);
        hn::StoreU(lanes.y, df_, hits_.y.data() + first);
        hn::StoreU(lanes.z, df_, hits_.z.data() + first);
        hn::StoreU(lanes.slope_x, df_, hits_.slope_x.data() + first);
        hn::StoreU(lanes.slope_y, df_, hits_.slope_y.data() + first);
        hn::StoreU(hn::DemoteTo(bytes_, lanes.half), bytes_, hits_.triangle.data() + first);
        hn::StoreU(hn::DemoteTo(bytes_, lanes.end), bytes_, reinterpret_cast<std::uint8_t*>(hits_.end.data()) + first);
        lanes.ray = hn::Set(di_, -1);
        return;
      }
    }
    hn::Store(hn::IfThenElse(over, lanes.ray, hn::Set(di_, -1)), di_, ray);
    hn::Store(place_x, di_, cell_x);
    hn::Store(place_y, di_, cell_y);
    hn::Store(lanes.half, di_, half);
    hn::Store(lanes.end, di_, end);
    hn::Store(lanes.x, df_, x);
    hn::Store(lanes.y, df_, y);
    hn::Store(lanes.z, df_, z);
    hn::Store(lanes.slope_x, df_, slope_x);
    hn::Store(lanes.slope_y, df_, slope_y);
    for (std::size_t lane = 0; lane < hn::Lanes(df_); ++lane) {
      if (ray[lane] < 0) continue;
      const auto k = static_cast<std::size_t>(ray[lane]);
      hits_.end[k] = static_cast<RayEnd>(end[lane]);
      if (hits_.end[k] != RayEnd::Surface) continue;
      hits_.cell_x[k] = cell_x[lane];
      hits_.cell_y[k] = cell_y[lane];
      hits_.triangle[k] = static_cast<std::uint8_t>(half[lane]);
      hits_.x[k] = x[lane];
      hits_.y[k] = y[lane];
      hits_.z[k] = z[lane];
      hits_.slope_x[k] = slope_x[lane];
      hits_.slope_y[k] = slope_y[lane];
    }
    lanes.ray = hn::IfThenElse(over, hn::Set(di_, -1), lanes.ray);
  }

  // The next waiting rays into the lanes of the mask, in order.
  HWY_INLINE void refill(Lanes& lanes, Mi mask) {
    const std::size_t width = hn::Lanes(df_);
    HWY_ALIGN std::int32_t number[max_lanes];
    HWY_ALIGN std::int32_t take[max_lanes];
    hn::Store(hn::VecFromMask(di_, mask), di_, take);
    for (std::size_t lane = 0; lane < width; ++lane) {
      number[lane] = -1;
      if (take[lane] != 0 && next_ < waiting_) number[lane] = queue_[next_++];
    }
    const Vi rays = hn::Load(di_, number);
    const Mi fresh = hn::Gt(rays, hn::Set(di_, -1));
    const std::int32_t first = number[0];
    if (hn::AllTrue(di_, fresh) && number[width - 1] - first == static_cast<std::int32_t>(width) - 1) {
      const auto at = static_cast<std::size_t>(first);
      const auto load = [&](const std::vector<float>& part) { return hn::LoadU(df_, part.data() + at); };
      return start(lanes, fresh, rays, load(rays_.dx), load(rays_.dy), load(rays_.dz), load(rays_.x), load(rays_.y),
                   load(rays_.z), hn::LoadU(di_, rays_.cell_x.data() + at), hn::LoadU(di_, rays_.cell_y.data() + at));
    }
    const Vi safe = hn::Max(rays, hn::Zero(di_));
    const auto load = [&](const std::vector<float>& part) { return hn::GatherIndex(df_, part.data(), safe); };
    start(lanes, fresh, rays, load(rays_.dx), load(rays_.dy), load(rays_.dz), load(rays_.x), load(rays_.y),
          load(rays_.z), hn::GatherIndex(di_, rays_.cell_x.data(), safe),
          hn::GatherIndex(di_, rays_.cell_y.data(), safe));
  }

  HWY_INLINE void start(Lanes& lanes, Mi fresh, Vi rays, Vf dx, Vf dy_physical, Vf dz, Vf x, Vf y, Vf z, Vi cell_x,
                        Vi cell_y) {
    const Mf fresh_f = hn::RebindMask(df_, fresh);
    const Vf zero = hn::Zero(df_), one = hn::Set(df_, 1.0F);
    const auto set_f = [&](Vf& part, Vf value) { part = hn::IfThenElse(fresh_f, value, part); };
    const auto set_i = [&](Vi& part, Vi value) { part = hn::IfThenElse(fresh, value, part); };
    const Vf dy = hn::Mul(dy_physical, hn::Set(df_, 1.0F / relief_.cell_y));
    const Mf back_x = hn::Lt(dx, zero), back_y = hn::Lt(dy, zero);
    const Vi flip_x = hn::VecFromMask(di_, hn::RebindMask(di_, back_x));
    const Vi flip_y = hn::VecFromMask(di_, hn::RebindMask(di_, back_y));
    const Vf speed_x = hn::Abs(dx), speed_y = hn::Abs(dy);
    const Vf up = inside ? hn::Neg(dz) : dz, height = inside ? hn::Neg(z) : z;
    set_i(lanes.ray, rays);
    set_i(lanes.flip_x, flip_x);
    set_i(lanes.flip_y, flip_y);
    set_i(lanes.cell_x, hn::Xor(cell_x, flip_x));
    set_i(lanes.cell_y, hn::Xor(cell_y, flip_y));
    set_i(lanes.end_x, hn::AndNot(flip_x, hn::Set(di_, relief_.columns)));
    set_i(lanes.end_y, hn::AndNot(flip_y, hn::Set(di_, relief_.rows)));
    set_f(lanes.x, hn::IfThenElse(back_x, hn::Sub(one, x), x));
    set_f(lanes.y, hn::IfThenElse(back_y, hn::Sub(one, y), y));
    set_f(lanes.z, height);
    set_f(lanes.speed_x, speed_x);
    set_f(lanes.speed_y, speed_y);
    set_f(lanes.dz, up);
    set_f(lanes.time_x, hn::Div(one, hn::Max(speed_x, hn::Set(df_, least_speed))));
    set_f(lanes.time_y, hn::Div(one, hn::Max(speed_y, hn::Set(df_, least_speed))));
    set_i(lanes.tiles, hn::Zero(di_));
    const Mf gone = hn::And(hn::Ge(up, zero), hn::Ge(height, hn::Set(df_, top_)));
    set_i(lanes.level, hn::IfThenElse(hn::RebindMask(di_, gone), hn::Set(di_, idle), hn::Zero(di_)));
    set_i(lanes.end, hn::Set(di_, static_cast<std::int32_t>(way_out)));
  }

  HWY_INLINE Vf highest_in_block(const Lanes& lanes, Vi x, Vi y, Mi working) const {
    const Vi rows = hn::Shr(hn::Add(hn::Set(di_, std::int32_t{1} << relief_.log2_rows), y), lanes.level);
    const Vi node =
        hn::Add(hn::Shl(rows, hn::Sub(hn::Set(di_, relief_.log2_columns), lanes.level)), hn::Shr(x, lanes.level));
    return hn::GatherIndex(df_, inside ? relief_.below() : relief_.above(), hn::IfThenElseZero(working, node));
  }

  HWY_INLINE void step(Lanes& lanes, Mi working) {
    const Vi one = hn::Set(di_, 1), zero = hn::Zero(di_);
    const Vi level = hn::Max(lanes.level, zero);
    const Vi within = hn::Sub(hn::Shl(one, level), one);
    const Vi x = hn::Xor(lanes.cell_x, lanes.flip_x), y = hn::Xor(lanes.cell_y, lanes.flip_y);
    const Vf highest = highest_in_block(lanes, x, y, working);
    const Vi exit_x = hn::Min(hn::Add(hn::Or(lanes.cell_x, within), one), lanes.end_x);
    const Vi exit_y = hn::Min(hn::Add(hn::Or(lanes.cell_y, within), one), lanes.end_y);
    const Vf to_x = hn::Mul(hn::Sub(hn::ConvertTo(df_, hn::Sub(exit_x, lanes.cell_x)), lanes.x), lanes.time_x);
    const Vf to_y = hn::Mul(hn::Sub(hn::ConvertTo(df_, hn::Sub(exit_y, lanes.cell_y)), lanes.y), lanes.time_y);
    const Mf by_x = hn::Le(to_x, to_y);
    const Vf time = hn::Min(to_x, to_y);
    const Vf exit_z = hn::Add(lanes.z, hn::Mul(lanes.dz, time));
    const Mi clear = hn::And(working, hn::RebindMask(di_, hn::Gt(hn::Min(lanes.z, exit_z), highest)));
    const Mi at_leaf = hn::And(working, hn::AndNot(clear, hn::Eq(level, zero)));
    const Mi descend = hn::AndNot(clear, hn::And(working, hn::Gt(level, zero)));
    Mi advance = clear;
    const std::size_t leaves = hn::CountTrue(di_, at_leaf);
    if (leaves * 2 >= hn::CountTrue(di_, working) && leaves > 0) {
      const Mi met = meet_facet(lanes, at_leaf, x, y, time);
      advance = hn::Or(advance, hn::AndNot(met, at_leaf));
    }
    lanes.level = hn::IfThenElse(descend, hn::Sub(lanes.level, one), lanes.level);
    leave_block(lanes, advance, by_x, time, exit_x, exit_y, exit_z);
  }

  HWY_INLINE void leave_block(Lanes& lanes, Mi advance, Mf by_x, Vf time, Vi exit_x, Vi exit_y, Vf exit_z) {
    const Vi one = hn::Set(di_, 1), zero = hn::Zero(di_);
    const Mf advance_f = hn::RebindMask(df_, advance);
    // Along the axis by which it leaves, the ray comes to a border; along the other one to some place within.
    const Mi by_x_i = hn::RebindMask(di_, by_x);
    const Vf way = hn::Mul(hn::IfThenElse(by_x, lanes.speed_y, lanes.speed_x), time);
    const Vf sum = hn::Add(hn::IfThenElse(by_x, lanes.y, lanes.x), way);
    const Vf whole = hn::Floor(sum);
    const Vi last = hn::Sub(hn::IfThenElse(by_x_i, exit_y, exit_x), one);
    const Vi stay = hn::Add(hn::IfThenElse(by_x_i, lanes.cell_y, lanes.cell_x), hn::ConvertTo(di_, whole));
    const Mi beyond = hn::Gt(stay, last);  // by rounding
    const Vf place = hn::IfThenElse(hn::RebindMask(df_, beyond), hn::Set(df_, below_one), hn::Sub(sum, whole));
    const Vi inner = hn::Min(stay, last);
    Vi cell_x = hn::IfThenElse(by_x_i, exit_x, inner), cell_y = hn::IfThenElse(by_x_i, inner, exit_y);
    const Vf place_x = hn::IfThenZeroElse(by_x, place), place_y = hn::IfThenElseZero(by_x, place);
    // Round the end of the tile.
    const Mi round_x = hn::Eq(cell_x, lanes.end_x), round_y = hn::Eq(cell_y, lanes.end_y);
    cell_x = hn::Sub(cell_x, hn::IfThenElseZero(round_x, hn::Set(di_, relief_.columns)));
    cell_y = hn::Sub(cell_y, hn::IfThenElseZero(round_y, hn::Set(di_, relief_.rows)));
    const Mi round = hn::And(advance, hn::Or(round_x, round_y));
    lanes.tiles = hn::Add(lanes.tiles, hn::IfThenElseZero(round, one));
    // Up only into a block that is new: the one that holds the last too was not clear.
    const Vi up = hn::Min(hn::Add(lanes.level, one), hn::Set(di_, relief_.top_level));
    const Vi moved = hn::Or(hn::Xor(cell_x, lanes.cell_x), hn::Xor(cell_y, lanes.cell_y));
    const Mi leaves_parent = hn::Ne(hn::Shr(moved, hn::Max(up, zero)), zero);
    lanes.cell_x = hn::IfThenElse(advance, cell_x, lanes.cell_x);
    lanes.cell_y = hn::IfThenElse(advance, cell_y, lanes.cell_y);
    lanes.x = hn::IfThenElse(advance_f, place_x, lanes.x);
    lanes.y = hn::IfThenElse(advance_f, place_y, lanes.y);
    lanes.z = hn::IfThenElse(advance_f, exit_z, lanes.z);
    lanes.level = hn::IfThenElse(hn::And(advance, leaves_parent), up, lanes.level);
    const Mi out = hn::And(
        advance, hn::RebindMask(di_, hn::And(hn::Ge(lanes.z, hn::Set(df_, top_)), hn::Ge(lanes.dz, hn::Zero(df_)))));
    const Mi lost = hn::And(advance, hn::Gt(lanes.tiles, hn::Set(di_, HeightFieldTracer::most_tiles)));
    lanes.level = hn::IfThenElse(hn::Or(out, lost), hn::Set(di_, idle), lanes.level);
    const Mi only_lost = hn::AndNot(out, lost);
    if (!hn::AllFalse(di_, only_lost)) {
      lanes.end = hn::IfThenElse(only_lost, hn::Set(di_, static_cast<std::int32_t>(RayEnd::Lost)), lanes.end);
    }
  }

  // Two neighbours at a time: a gather costs by the element.
  HWY_INLINE void gather_pairs(const float* base, Vi index, Vf& left, Vf& right) const {
#if HWY_TARGET == HWY_AVX3
    const hn::Repartition<std::int64_t, Floats> dl;
    const hn::Half<Ints> half;
    const auto* pairs = reinterpret_cast<const std::int64_t*>(base);
    const auto low =
        hn::BitCast(df_, hn::Vec<decltype(dl)>{_mm512_i32gather_epi64(hn::LowerHalf(half, index).raw, pairs, 4)});
    const auto high =
        hn::BitCast(df_, hn::Vec<decltype(dl)>{_mm512_i32gather_epi64(hn::UpperHalf(half, index).raw, pairs, 4)});
    left = hn::ConcatEven(df_, high, low);
    right = hn::ConcatOdd(df_, high, low);
#else
    left = hn::GatherIndex(df_, base, index);
    right = hn::GatherIndex(df_, base + 1, index);
#endif
  }

  // The two facets of a cell, up to `time`. Lanes that meet one hold the hit and become idle.
  HWY_INLINE Mi meet_facet(Lanes& lanes, Mi at_leaf, Vi cell_x, Vi cell_y, Vf time) {
    const Vf zero = hn::Zero(df_), one = hn::Set(df_, 1.0F);
    const Vi stride = hn::Set(di_, relief_.columns + 1);
    const Vi corner = hn::IfThenElseZero(at_leaf, hn::Add(hn::Mul(cell_y, stride), cell_x));
    const float* samples = relief_.samples();
    Vf z00, z10, z01, z11;
    gather_pairs(samples, corner, z00, z10);
    gather_pairs(samples + relief_.columns + 1, corner, z01, z11);
    if (inside) {
      z00 = hn::Neg(z00);
      z10 = hn::Neg(z10);
      z01 = hn::Neg(z01);
      z11 = hn::Neg(z11);
    }
    const Mf back_x = hn::RebindMask(df_, hn::Ne(lanes.flip_x, hn::Zero(di_)));
    const Mf back_y = hn::RebindMask(df_, hn::Ne(lanes.flip_y, hn::Zero(di_)));
    const Vf x = hn::IfThenElse(back_x, hn::Sub(one, lanes.x), lanes.x);
    const Vf y = hn::IfThenElse(back_y, hn::Sub(one, lanes.y), lanes.y);
    const Vf dx = hn::IfThenElse(back_x, hn::Neg(lanes.speed_x), lanes.speed_x);
    const Vf dy = hn::IfThenElse(back_y, hn::Neg(lanes.speed_y), lanes.speed_y);

    // Over which half the ray starts, and when it crosses the diagonal.
    const Vf off = hn::Sub(x, y), off_speed = hn::Sub(dx, dy);
    const Mf right = hn::Or(hn::Gt(off, zero), hn::And(hn::Eq(off, zero), hn::Gt(off_speed, zero)));
    const Vf crossing = hn::Div(hn::Neg(off), off_speed);
    const Mf crosses = hn::And(hn::Gt(crossing, zero), hn::Lt(crossing, time));
    const Vf first_end = hn::IfThenElse(crosses, crossing, time);

    const Vf low_x = hn::Sub(z10, z00), low_y = hn::Sub(z11, z10);  // slopes of the lower right half
    const Vf up_x = hn::Sub(z11, z01), up_y = hn::Sub(z01, z00);
    const Vf ax = hn::IfThenElse(right, low_x, up_x), ay = hn::IfThenElse(right, low_y, up_y);
    const Vf bx = hn::IfThenElse(right, up_x, low_x), by = hn::IfThenElse(right, up_y, low_y);
    const Vf over = hn::Sub(lanes.z, z00);
    const Vf a0 = hn::Sub(over, hn::Add(hn::Mul(ax, x), hn::Mul(ay, y)));
    const Vf b0 = hn::Sub(over, hn::Add(hn::Mul(bx, x), hn::Mul(by, y)));
    const Vf a_rate = hn::Sub(lanes.dz, hn::Add(hn::Mul(ax, dx), hn::Mul(ay, dy)));
    const Vf b_rate = hn::Sub(lanes.dz, hn::Add(hn::Mul(bx, dx), hn::Mul(by, dy)));
    const Mf leaf = hn::RebindMask(df_, at_leaf);
    const Mf met_a =
        hn::And(leaf, hn::And(hn::Lt(a_rate, zero), hn::Lt(hn::Add(a0, hn::Mul(a_rate, first_end)), zero)));
    const Mf met_b =
        hn::AndNot(met_a, hn::And(hn::And(leaf, crosses),
                                  hn::And(hn::Lt(b_rate, zero), hn::Lt(hn::Add(b0, hn::Mul(b_rate, time)), zero))));
    const Mf met = hn::Or(met_a, met_b);
    if (hn::AllFalse(df_, met)) return hn::RebindMask(di_, met);

    const Vf rate = hn::IfThenElse(met_a, a_rate, b_rate), start = hn::IfThenElse(met_a, a0, b0);
    const Vf earliest = hn::IfThenElse(met_a, zero, crossing), latest = hn::IfThenElse(met_a, first_end, time);
    const Vf when = hn::Min(hn::Max(hn::Div(hn::Neg(start), rate), earliest), latest);
    const Vf slope_x = hn::IfThenElse(met_a, ax, bx), slope_y = hn::IfThenElse(met_a, ay, by);
    const Vf hit_x = hn::Min(hn::Max(hn::Add(x, hn::Mul(dx, when)), zero), one);
    const Vf hit_y = hn::Min(hn::Max(hn::Add(y, hn::Mul(dy, when)), zero), one);
    const Vf height = hn::Add(z00, hn::Add(hn::Mul(slope_x, hit_x), hn::Mul(slope_y, hit_y)));
    const Mi met_i = hn::RebindMask(di_, met);
    const Vi is_right = hn::VecFromMask(di_, hn::RebindMask(di_, right));  // −1 or 0
    const Vi first_half = hn::Add(is_right, hn::Set(di_, 1));              // 0 right, 1 left
    const Vi half = hn::IfThenElse(hn::RebindMask(di_, met_a), first_half, hn::Sub(hn::Set(di_, 1), first_half));
    lanes.x = hn::IfThenElse(met, hit_x, lanes.x);
    lanes.y = hn::IfThenElse(met, hit_y, lanes.y);
    lanes.z = hn::IfThenElse(met, inside ? hn::Neg(height) : height, lanes.z);
    lanes.slope_x = hn::IfThenElse(met, inside ? hn::Neg(slope_x) : slope_x, lanes.slope_x);
    const Vf per_y = hn::Set(df_, (inside ? -1.0F : 1.0F) / relief_.cell_y);
    lanes.slope_y = hn::IfThenElse(met, hn::Mul(per_y, slope_y), lanes.slope_y);
    lanes.half = hn::IfThenElse(met_i, half, lanes.half);
    lanes.end = hn::IfThenElse(met_i, hn::Set(di_, static_cast<std::int32_t>(RayEnd::Surface)), lanes.end);
    lanes.level = hn::IfThenElse(met_i, hn::Set(di_, idle), lanes.level);
    return met_i;
  }

  const Floats df_{};
  const Ints di_{};
  const HeightPyramid& relief_;
  const float top_;  ///< of the relief, turned over for rays from below
  const RayBatch& rays_;
  std::size_t count_;
  HitBatch& hits_;
  const hn::Rebind<std::uint8_t, Floats> bytes_{};
  std::vector<std::int32_t> queue_;  ///< numbers of the rays that need a lane
  std::size_t waiting_ = 0;          ///< so many of them
  std::size_t next_ = 0;             ///< the first that has not had one
};

void trace(const HeightPyramid& relief, const RayBatch& rays, std::size_t count, HitBatch& hits) {
  Kernel<false>(relief, rays, count, hits).run();
  Kernel<true>(relief, rays, count, hits).run();
}

}  // namespace mezzotint::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace mezzotint {

HWY_EXPORT(trace);

void HeightFieldTracer::closest_hits(const RayBatch& rays, std::size_t count, HitBatch& hits) const {
  HWY_DYNAMIC_DISPATCH(trace)(pyramid_, rays, count, hits);
}

}  // namespace mezzotint

#endif
