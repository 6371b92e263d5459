#include "forward/tracing/height_field_tracer.h"

// One translation unit, compiled once for each instruction set; the best that the machine has is taken at run time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "forward/tracing/height_field_tracer.cpp"  // NOLINT
#include <hwy/cache_control.h>
#include <hwy/foreach_target.h>  // IWYU pragma: keep
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
// No level speed is below this, so that no time to a border is infinite: 0 · ∞ is NaN.
constexpr float least_speed = 1e-18F;
constexpr float below_one = 0x1.fffffep-1F;

/// Rays on their way, one a lane. Everything runs in "travel space": along an axis with a negative direction a cell i
/// is numbered −1 − i (all its bits turned), so that every ray goes towards larger numbers. Rays from below run through
/// the relief turned over (z → −z).
struct Lanes {
  Vi ray;                                   // number in the batch
  Vi cell_x, cell_y;                        // travel space
  Vi state;                                 // level, flips, tiles crossed: see below
  Vf x, y, z;                               // place in the cell, travel space
  Vf speed_x, speed_y, dz, time_x, time_y;  // speeds ≥ 0; times to cross a cell
};

// The bits of `state`: 5 for the level, one a negative direction, and from bit 8 on the tiles crossed so far.
constexpr std::int32_t level_bits = 31, back_x_bit = 32, back_y_bit = 64, one_tile = 256;

HWY_INLINE Vf time_across(Vf speed) {
  const Floats df;
  return hn::Div(hn::Set(df, 1.0F), hn::Max(speed, hn::Set(df, least_speed)));
}

/// Rays that wait for the same thing. A ray costs some memory traffic to wait, but no lane.
class Pool {
public:
  static constexpr std::size_t capacity = 256;
  std::size_t count = 0;

  HWY_INLINE Lanes load(std::size_t first) const {
    const Floats df;
    const Ints di;
    const Vf speed_x = hn::LoadU(df, speed_x_ + first), speed_y = hn::LoadU(df, speed_y_ + first);
    return {hn::LoadU(di, ray_ + first),
            hn::LoadU(di, cell_x_ + first),
            hn::LoadU(di, cell_y_ + first),
            hn::LoadU(di, state_ + first),
            hn::LoadU(df, x_ + first),
            hn::LoadU(df, y_ + first),
            hn::LoadU(df, z_ + first),
            speed_x,
            speed_y,
            hn::LoadU(df, dz_ + first),
            time_across(speed_x),
            time_across(speed_y)};
  }
  // The rays of the mask, behind the others. Not CompressStore: to memory it is microcode on Zen 4 and 5.
  HWY_INLINE void append(const Lanes& lanes, Mi mask) {
    const Floats df;
    const Ints di;
    const Mf mask_f = hn::RebindMask(df, mask);
    const auto put_i = [&](std::int32_t* to, Vi from) { hn::StoreU(hn::Compress(from, mask), di, to + count); };
    const auto put_f = [&](float* to, Vf from) { hn::StoreU(hn::Compress(from, mask_f), df, to + count); };
    put_i(ray_, lanes.ray);
    put_i(cell_x_, lanes.cell_x);
    put_i(cell_y_, lanes.cell_y);
    put_i(state_, lanes.state);
    put_f(x_, lanes.x);
    put_f(y_, lanes.y);
    put_f(z_, lanes.z);
    put_f(speed_x_, lanes.speed_x);
    put_f(speed_y_, lanes.speed_y);
    put_f(dz_, lanes.dz);
    count += hn::CountTrue(di, mask);
  }

private:
  static constexpr std::size_t room = capacity + 2 * max_lanes;
  HWY_ALIGN std::int32_t ray_[room], cell_x_[room], cell_y_[room], state_[room] = {};
  HWY_ALIGN float x_[room] = {}, y_[room] = {}, z_[room] = {};
  HWY_ALIGN float speed_x_[room] = {}, speed_y_[room] = {}, dz_[room] = {}, time_x_[room] = {}, time_y_[room] = {};
};

/// Rays wait in two pools, for a step through the pyramid and for the two facets of a cell, and are taken from there a
/// vector at a time: all lanes have the same to do, and what comes next hardly depends on what is found.
template <bool inside>
class Kernel {
public:
  Kernel(const HeightPyramid& relief, const RayBatch& rays, std::size_t count, HitBatch& hits)
      : relief_(relief), top_(inside ? -relief.lowest : relief.highest), rays_(rays), count_(count), hits_(hits) {}

  void run() {
    for (;;) {
      while (next_ < count_ && steps_.count + leaves_.count + max_lanes <= Pool::capacity) admit();
      if (steps_.count + leaves_.count == 0) return;
      step_all();
      while (leaves_.count >= width()) meet_some();
      if (next_ >= count_ && steps_.count < width()) {
        while (leaves_.count > 0) meet_some();
      }
    }
  }

private:
  static constexpr RayEnd way_out = inside ? RayEnd::Below : RayEnd::Above;
  static std::size_t width() { return hn::Lanes(Floats()); }
  template <class T>
  static const std::uint8_t* bytes(const std::vector<T>& part) {
    return reinterpret_cast<const std::uint8_t*>(part.data());
  }
  template <class T>
  static std::uint8_t* bytes(std::vector<T>& part) {
    return reinterpret_cast<std::uint8_t*>(part.data());
  }
  HWY_INLINE Vi flip_x(const Lanes& lanes) const { return hn::ShiftRight<31>(hn::ShiftLeft<26>(lanes.state)); }
  HWY_INLINE Vi flip_y(const Lanes& lanes) const { return hn::ShiftRight<31>(hn::ShiftLeft<25>(lanes.state)); }

  // A ray from afar comes to a cell that nobody has looked at; its heights are asked for some vectors ahead.
  HWY_INLINE void fetch(std::size_t first) const {
    if (first >= count_ || rays_.left[first] != no_half) return;
    const float* bounds = inside ? relief_.below() : relief_.above();
    const std::size_t line = static_cast<std::size_t>(relief_.columns) + 1, end = HWY_MIN(first + width(), count_);
    for (std::size_t k = first; k < end; ++k) {
      const auto x = rays_.cell_x[k], y = rays_.cell_y[k];
      const float* samples = relief_.samples() + static_cast<std::size_t>(y) * line + static_cast<std::size_t>(x);
      hwy::Prefetch(bounds + relief_.node(0, x, y));
      hwy::Prefetch(samples);
      hwy::Prefetch(samples + line);
    }
  }

  // The next rays of the batch, so far as they are on this side. One that rises more steeply than any facet has left
  // the relief for good; the others look at their own cell first.
  HWY_INLINE void admit() {
    const std::size_t first = next_;
    next_ += width();
    fetch(first + 4 * width());
    const Vi side = hn::PromoteTo(di_, hn::LoadU(bytes_, bytes(rays_.side) + first));
    const Vi number = hn::Add(hn::Iota(di_, 0), hn::Set(di_, static_cast<std::int32_t>(first)));
    const Mi ours = hn::And(hn::Eq(side, hn::Set(di_, inside ? 1 : 0)),
                            hn::Lt(number, hn::Set(di_, static_cast<std::int32_t>(count_))));
    if (hn::AllFalse(di_, ours)) return;
    // Who meets nothing is gone.
    blend_bytes(bytes(hits_.end) + first, ours, hn::Set(di_, static_cast<std::int32_t>(way_out)));
    const auto load = [&](const std::vector<float>& part) { return hn::LoadU(df_, part.data() + first); };
    const Vf dx = load(rays_.dx), dy = load(rays_.dy), dz = load(rays_.dz), z = load(rays_.z);
    const Vf up = inside ? hn::Neg(dz) : dz, height = inside ? hn::Neg(z) : z;
    const Vf level_square = hn::Add(hn::Mul(dx, dx), hn::Mul(dy, dy));
    const Vf limit = hn::Set(df_, relief_.steepest * relief_.steepest * 1.00001F);
    const Mf gone = hn::And(hn::Ge(up, hn::Zero(df_)), hn::Or(hn::Gt(hn::Mul(up, up), hn::Mul(limit, level_square)),
                                                              hn::Ge(height, hn::Set(df_, top_))));
    const Mi fresh = hn::AndNot(hn::RebindMask(di_, gone), ours);
    if (hn::AllFalse(di_, fresh)) return;
    Lanes lanes = start(number, dx, dy, up, load(rays_.x), load(rays_.y), height,
                        hn::LoadU(di_, rays_.cell_x.data() + first), hn::LoadU(di_, rays_.cell_y.data() + first));
    Sorted sorted = step(lanes, fresh);
    if (2 * hn::CountTrue(di_, sorted.at_leaf) >= width()) {
      Found found;
      const Mi met = meet_facets(lanes, sorted.at_leaf, found);
      store_in_order(lanes, found, met, first);
      sorted.onward = hn::Or(sorted.onward, leave_cell(lanes, found, hn::AndNot(met, sorted.at_leaf)));
    } else {
      leaves_.append(lanes, sorted.at_leaf);
    }
    steps_.append(lanes, sorted.onward);
  }

  HWY_INLINE Lanes start(Vi ray, Vf dx, Vf dy_physical, Vf up, Vf x, Vf y, Vf height, Vi cell_x, Vi cell_y) const {
    const Vf zero = hn::Zero(df_), one = hn::Set(df_, 1.0F);
    const Vf dy = hn::Mul(dy_physical, hn::Set(df_, 1.0F / relief_.cell_y));
    const Mf back_x = hn::Lt(dx, zero), back_y = hn::Lt(dy, zero);
    const Vi flip_x = hn::VecFromMask(di_, hn::RebindMask(di_, back_x));
    const Vi flip_y = hn::VecFromMask(di_, hn::RebindMask(di_, back_y));
    const Vi state = hn::Or(hn::And(flip_x, hn::Set(di_, back_x_bit)), hn::And(flip_y, hn::Set(di_, back_y_bit)));
    const Vf speed_x = hn::Abs(dx), speed_y = hn::Abs(dy);
    return {ray,
            hn::Xor(cell_x, flip_x),
            hn::Xor(cell_y, flip_y),
            state,
            hn::IfThenElse(back_x, hn::Sub(one, x), x),
            hn::IfThenElse(back_y, hn::Sub(one, y), y),
            height,
            speed_x,
            speed_y,
            up,
            time_across(speed_x),
            time_across(speed_y)};
  }

  // A round of steps for all that wait for one; those that go on stay, closed up.
  HWY_INLINE void step_all() {
    const std::size_t waiting = steps_.count;
    steps_.count = 0;
    for (std::size_t first = 0; first < waiting; first += width()) {
      Lanes lanes = steps_.load(first);
      Sorted sorted{hn::MaskFromVec(hn::Zero(di_)), hn::FirstN(di_, HWY_MIN(waiting - first, width()))};
      for (int k = 0; k < steps_together; ++k) {
        const Sorted next = step(lanes, sorted.onward);
        sorted = {hn::Or(sorted.at_leaf, next.at_leaf), next.onward};
      }
      leaves_.append(lanes, sorted.at_leaf);
      steps_.append(lanes, sorted.onward);
    }
  }

  // The last of those that wait at a leaf, as many as there are lanes.
  HWY_INLINE void meet_some() {
    const std::size_t here = HWY_MIN(leaves_.count, width());
    leaves_.count -= here;
    Lanes lanes = leaves_.load(leaves_.count);
    const Mi at_leaf = hn::FirstN(di_, here);
    Found found;
    const Mi met = meet_facets(lanes, at_leaf, found);
    store_one_by_one(lanes, found, met);
    steps_.append(lanes, leave_cell(lanes, found, hn::AndNot(met, at_leaf)));
  }

  HWY_INLINE Vf highest_in_block(Vi x, Vi y, Vi level, Mi working) const {
    const Vi rows = hn::Shr(hn::Add(hn::Set(di_, std::int32_t{1} << relief_.log2_rows), y), level);
    const Vi node = hn::Add(hn::Shl(rows, hn::Sub(hn::Set(di_, relief_.log2_columns), level)), hn::Shr(x, level));
    return hn::GatherIndex(df_, inside ? relief_.below() : relief_.above(), hn::IfThenElseZero(working, node));
  }

  // Where the lanes of a step stand now; who is in neither has found its end.
  struct Sorted {
    Mi at_leaf, onward;
  };

  // Across a block that lies below the ray, or down into one that may not.
  HWY_INLINE Sorted step(Lanes& lanes, Mi working) {
    const Vi one = hn::Set(di_, 1), zero = hn::Zero(di_);
    const Vi level = hn::And(lanes.state, hn::Set(di_, level_bits));
    const Vi within = hn::Sub(hn::Shl(one, level), one);
    const Vi turn_x = flip_x(lanes), turn_y = flip_y(lanes);
    const Vf highest = highest_in_block(hn::Xor(lanes.cell_x, turn_x), hn::Xor(lanes.cell_y, turn_y), level, working);
    const Vi end_x = hn::AndNot(turn_x, hn::Set(di_, relief_.columns));
    const Vi end_y = hn::AndNot(turn_y, hn::Set(di_, relief_.rows));
    const Vi exit_x = hn::Min(hn::Add(hn::Or(lanes.cell_x, within), one), end_x);
    const Vi exit_y = hn::Min(hn::Add(hn::Or(lanes.cell_y, within), one), end_y);
    const Vf to_x = hn::Mul(hn::Sub(hn::ConvertTo(df_, hn::Sub(exit_x, lanes.cell_x)), lanes.x), lanes.time_x);
    const Vf to_y = hn::Mul(hn::Sub(hn::ConvertTo(df_, hn::Sub(exit_y, lanes.cell_y)), lanes.y), lanes.time_y);
    const Mf by_x = hn::Le(to_x, to_y);
    const Vf time = hn::Min(to_x, to_y);
    const Vf exit_z = hn::Add(lanes.z, hn::Mul(lanes.dz, time));
    const Mi clear = hn::And(working, hn::RebindMask(di_, hn::Gt(hn::Min(lanes.z, exit_z), highest)));
    const Mi blocked = hn::AndNot(clear, working);
    const Mi at_leaf = hn::And(blocked, hn::Eq(level, zero));
    const Mi descend = hn::AndNot(at_leaf, blocked);
    lanes.state = hn::IfThenElse(descend, hn::Sub(lanes.state, one), lanes.state);
    const Mi onward = leave_block(lanes, clear, level, by_x, time, exit_x, exit_y, exit_z);
    return {at_leaf, hn::Or(descend, onward)};
  }

  // Those that go on.
  HWY_INLINE Mi leave_block(Lanes& lanes, Mi leaving, Vi level, Mf by_x, Vf time, Vi exit_x, Vi exit_y, Vf exit_z) {
    const Vi one = hn::Set(di_, 1), zero = hn::Zero(di_);
    const Mf leaving_f = hn::RebindMask(df_, leaving);
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
    const Mi round_x = hn::Eq(cell_x, hn::AndNot(flip_x(lanes), hn::Set(di_, relief_.columns)));
    const Mi round_y = hn::Eq(cell_y, hn::AndNot(flip_y(lanes), hn::Set(di_, relief_.rows)));
    cell_x = hn::Sub(cell_x, hn::IfThenElseZero(round_x, hn::Set(di_, relief_.columns)));
    cell_y = hn::Sub(cell_y, hn::IfThenElseZero(round_y, hn::Set(di_, relief_.rows)));
    const Vi tiles = hn::IfThenElseZero(hn::Or(round_x, round_y), hn::Set(di_, one_tile));
    // Up only into a block that is new: the one that holds the last too was not clear.
    const Vi up = hn::Min(hn::Add(level, one), hn::Set(di_, relief_.top_level));
    const Vi moved = hn::Or(hn::Xor(cell_x, lanes.cell_x), hn::Xor(cell_y, lanes.cell_y));
    const Vi rise = hn::IfThenElseZero(hn::Ne(hn::Shr(moved, up), zero), hn::Sub(up, level));
    lanes.cell_x = hn::IfThenElse(leaving, cell_x, lanes.cell_x);
    lanes.cell_y = hn::IfThenElse(leaving, cell_y, lanes.cell_y);
    lanes.x = hn::IfThenElse(leaving_f, place_x, lanes.x);
    lanes.y = hn::IfThenElse(leaving_f, place_y, lanes.y);
    lanes.z = hn::IfThenElse(leaving_f, exit_z, lanes.z);
    lanes.state = hn::IfThenElse(leaving, hn::Add(lanes.state, hn::Add(tiles, rise)), lanes.state);
    const Mi out = hn::RebindMask(di_, hn::And(hn::Ge(exit_z, hn::Set(df_, top_)), hn::Ge(lanes.dz, hn::Zero(df_))));
    const Mi onward = hn::AndNot(out, leaving);
    const Mi lost = hn::And(onward, hn::Gt(lanes.state, hn::Set(di_, one_tile * HeightFieldTracer::most_tiles)));
    if (hn::AllFalse(di_, lost)) return onward;
    lose(lanes, lost);
    return hn::AndNot(lost, onward);
  }

  HWY_NOINLINE void lose(const Lanes& lanes, Mi lost) {
    HWY_ALIGN std::int32_t ray[max_lanes];
    hn::Store(hn::IfThenElse(lost, lanes.ray, hn::Set(di_, -1)), di_, ray);
    for (std::size_t lane = 0; lane < width(); ++lane)
      if (ray[lane] >= 0) hits_.end[static_cast<std::size_t>(ray[lane])] = RayEnd::Lost;
  }

  // What the two facets of a cell have to say.
  struct Found {
    Mf by_x;  // how the ray leaves the cell, should it meet none
    Vf time;
    Vf x, y, z, slope_x, slope_y;
    Vi half;
  };

  HWY_INLINE Mi leave_cell(Lanes& lanes, const Found& found, Mi leaving) {
    const Vi one = hn::Set(di_, 1);
    return leave_block(lanes, leaving, hn::Zero(di_), found.by_x, found.time, hn::Add(lanes.cell_x, one),
                       hn::Add(lanes.cell_y, one), hn::Add(lanes.z, hn::Mul(lanes.dz, found.time)));
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

  // The lanes that meet a facet of their cell.
  HWY_INLINE Mi meet_facets(const Lanes& lanes, Mi at_leaf, Found& found) const {
    const Vf zero = hn::Zero(df_), one = hn::Set(df_, 1.0F);
    const Vi turn_x = flip_x(lanes), turn_y = flip_y(lanes);
    const Vi stride = hn::Set(di_, relief_.columns + 1);
    const Vi cell = hn::Add(hn::Mul(hn::Xor(lanes.cell_y, turn_y), stride), hn::Xor(lanes.cell_x, turn_x));
    const Vi corner = hn::IfThenElseZero(at_leaf, cell);
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
    const Vf to_x = hn::Mul(hn::Sub(one, lanes.x), lanes.time_x), to_y = hn::Mul(hn::Sub(one, lanes.y), lanes.time_y);
    const Vf time = hn::Min(to_x, to_y);
    found.by_x = hn::Le(to_x, to_y);
    found.time = time;
    const Mf back_x = hn::RebindMask(df_, hn::Ne(turn_x, hn::Zero(di_)));
    const Mf back_y = hn::RebindMask(df_, hn::Ne(turn_y, hn::Zero(di_)));
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

    const Vf rate = hn::IfThenElse(met_a, a_rate, b_rate), begin = hn::IfThenElse(met_a, a0, b0);
    const Vf earliest = hn::IfThenElse(met_a, zero, crossing), latest = hn::IfThenElse(met_a, first_end, time);
    const Vf when = hn::Min(hn::Max(hn::Div(hn::Neg(begin), rate), earliest), latest);
    const Vf slope_x = hn::IfThenElse(met_a, ax, bx), slope_y = hn::IfThenElse(met_a, ay, by);
    found.x = hn::Min(hn::Max(hn::Add(x, hn::Mul(dx, when)), zero), one);
    found.y = hn::Min(hn::Max(hn::Add(y, hn::Mul(dy, when)), zero), one);
    const Vf height = hn::Add(z00, hn::Add(hn::Mul(slope_x, found.x), hn::Mul(slope_y, found.y)));
    found.z = inside ? hn::Neg(height) : height;
    found.slope_x = inside ? hn::Neg(slope_x) : slope_x;
    found.slope_y = hn::Mul(hn::Set(df_, (inside ? -1.0F : 1.0F) / relief_.cell_y), slope_y);
    const Mi is_left = hn::RebindMask(di_, hn::Xor(right, met_a));  // of the half that was met
    found.half = hn::IfThenElseZero(is_left, hn::Set(di_, 1));
    return hn::RebindMask(di_, hn::Or(met_a, met_b));
  }

  static HWY_INLINE void blend_bytes(std::uint8_t* to, Mi mask, Vi value) {
    const Ints di;
    const hn::Rebind<std::uint8_t, Floats> db;
    const Vi before = hn::PromoteTo(di, hn::LoadU(db, to));
    hn::StoreU(hn::DemoteTo(db, hn::IfThenElse(mask, value, before)), db, to);
  }

  // The hits of lanes that hold the rays first, first + 1, …
  HWY_INLINE void store_in_order(const Lanes& lanes, const Found& found, Mi met, std::size_t first) {
    const Mf met_f = hn::RebindMask(df_, met);
    const auto put = [&](std::vector<float>& part, Vf value) {
      hn::BlendedStore(value, met_f, df_, part.data() + first);
    };
    hn::BlendedStore(hn::Xor(lanes.cell_x, flip_x(lanes)), met, di_, hits_.cell_x.data() + first);
    hn::BlendedStore(hn::Xor(lanes.cell_y, flip_y(lanes)), met, di_, hits_.cell_y.data() + first);
    put(hits_.x, found.x);
    put(hits_.y, found.y);
    put(hits_.z, found.z);
    put(hits_.slope_x, found.slope_x);
    put(hits_.slope_y, found.slope_y);
    blend_bytes(hits_.triangle.data() + first, met, found.half);
    blend_bytes(bytes(hits_.end) + first, met, hn::Set(di_, static_cast<std::int32_t>(RayEnd::Surface)));
  }

  HWY_INLINE void store_one_by_one(const Lanes& lanes, const Found& found, Mi met) {
    HWY_ALIGN std::int32_t ray[max_lanes], cell_x[max_lanes], cell_y[max_lanes], half[max_lanes];
    HWY_ALIGN float x[max_lanes], y[max_lanes], z[max_lanes], slope_x[max_lanes], slope_y[max_lanes];
    const Mf met_f = hn::RebindMask(df_, met);
    hn::Store(hn::Compress(lanes.ray, met), di_, ray);
    hn::Store(hn::Compress(hn::Xor(lanes.cell_x, flip_x(lanes)), met), di_, cell_x);
    hn::Store(hn::Compress(hn::Xor(lanes.cell_y, flip_y(lanes)), met), di_, cell_y);
    hn::Store(hn::Compress(found.half, met), di_, half);
    hn::Store(hn::Compress(found.x, met_f), df_, x);
    hn::Store(hn::Compress(found.y, met_f), df_, y);
    hn::Store(hn::Compress(found.z, met_f), df_, z);
    hn::Store(hn::Compress(found.slope_x, met_f), df_, slope_x);
    hn::Store(hn::Compress(found.slope_y, met_f), df_, slope_y);
    const std::size_t count = hn::CountTrue(di_, met);
    for (std::size_t lane = 0; lane < count; ++lane) {
      const auto k = static_cast<std::size_t>(ray[lane]);
      hits_.end[k] = RayEnd::Surface;
      hits_.cell_x[k] = cell_x[lane];
      hits_.cell_y[k] = cell_y[lane];
      hits_.triangle[k] = static_cast<std::uint8_t>(half[lane]);
      hits_.x[k] = x[lane];
      hits_.y[k] = y[lane];
      hits_.z[k] = z[lane];
      hits_.slope_x[k] = slope_x[lane];
      hits_.slope_y[k] = slope_y[lane];
    }
  }

  static constexpr int steps_together = 2;
  const Floats df_{};
  const Ints di_{};
  const hn::Rebind<std::uint8_t, Floats> bytes_{};
  const HeightPyramid& relief_;
  const float top_;  ///< of the relief, turned over for rays from below
  const RayBatch& rays_;
  std::size_t count_;
  HitBatch& hits_;
  std::size_t next_ = 0;  ///< the first ray that has not been looked at
  Pool steps_, leaves_;
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
