#include "fabrication/calibration/wedge_lattice.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace mezzotint {

namespace {

constexpr double least_width = 6.0;  // samples

// Sum of squares between means and the rising ones nearest to them, in the order of the gray values.
double disorder(std::span<const double> grays, std::span<const WedgeProfile::Sums> strips) {
  std::vector<std::size_t> order(strips.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return grays[a] < grays[b]; });
  // Pool adjacent violators: (weight, sum) of each pool.
  std::vector<WedgeProfile::Sums> pools;
  double cost = 0.0;
  for (const std::size_t i : order) {
    if (strips[i].count <= 0.0) continue;
    pools.push_back({strips[i].count, strips[i].sum, strips[i].sum * strips[i].sum / strips[i].count});
    while (pools.size() > 1) {
      const WedgeProfile::Sums last = pools.back(), before = pools[pools.size() - 2];
      if (before.sum / before.count <= last.sum / last.count) break;
      pools.pop_back();
      pools.back() = {before.count + last.count, before.sum + last.sum, before.square + last.square};
    }
  }
  for (const WedgeProfile::Sums& pool : pools) cost += pool.about_mean();
  return cost;
}

double cost_of(const WedgeProfile& profile, std::size_t strips, std::span<const double> grays, const Lattice& lattice) {
  std::vector<WedgeProfile::Sums> sums(strips);
  double cost = 0.0;
  for (std::size_t i = 0; i < strips; ++i) {
    const double from = lattice.first + static_cast<double>(i) * lattice.width;
    sums[lattice.reversed ? strips - 1 - i : i] = profile.between(from, from + lattice.width);
  }
  for (const auto& strip : sums) cost += strip.about_mean();
  const WedgeProfile::Sums before = profile.between(0.0, lattice.first);
  const WedgeProfile::Sums after =
      profile.between(lattice.first + static_cast<double>(strips) * lattice.width, profile.length());
  const WedgeProfile::Sums frame{before.count + after.count, before.sum + after.sum, before.square + after.square};
  cost += frame.about_mean();
  return grays.empty() ? cost : cost + disorder(grays, sums);
}

// Moves first and last end by ever smaller steps.
Lattice refined(const WedgeProfile& profile, std::size_t strips, std::span<const double> grays, Lattice lattice) {
  const auto count = static_cast<double>(strips);
  for (double step = 0.2 * lattice.width; step > 0.02; step *= 0.5) {
    for (bool moved = true; moved;) {
      moved = false;
      for (const auto& [first, last] :
           {std::pair{step, 0.0}, {-step, 0.0}, {0.0, step}, {0.0, -step}, {step, step}, {-step, -step}}) {
        Lattice next = lattice;
        next.first += first;
        next.width += (last - first) / count;
        if (next.width < least_width || next.first < -0.5 * next.width ||
            next.first + count * next.width > profile.length() + 0.5 * next.width)
          continue;
        next.cost = cost_of(profile, strips, grays, next);
        if (next.cost < lattice.cost - 1e-12 * std::abs(lattice.cost)) {
          lattice = next;
          moved = true;
        }
      }
    }
  }
  return lattice;
}

}  // namespace

WedgeProfile::WedgeProfile(std::span<const double> heights_um) {
  sums_.push_back({});
  for (const double height : heights_um) {
    Sums sums = sums_.back();
    if (!std::isnan(height)) sums = {sums.count + 1.0, sums.sum + height, sums.square + height * height};
    sums_.push_back(sums);
  }
}

WedgeProfile::Sums WedgeProfile::until(double place) const {
  const double inside = std::clamp(place, 0.0, length());
  const auto whole = std::min(static_cast<std::size_t>(inside), sums_.size() - 2);
  const double part = inside - static_cast<double>(whole);
  const Sums &a = sums_[whole], &b = sums_[whole + 1];
  return {a.count + part * (b.count - a.count), a.sum + part * (b.sum - a.sum),
          a.square + part * (b.square - a.square)};
}

WedgeProfile::Sums WedgeProfile::between(double from, double to) const {
  if (to <= from) return {};
  const Sums a = until(from), b = until(to);
  return {b.count - a.count, b.sum - a.sum, b.square - a.square};
}

std::vector<double> WedgeProfile::jumps(double apart, std::size_t most) const {
  const auto count = sums_.size() - 1;
  std::vector<double> height(count + 1, 0.0);
  for (std::size_t i = 1; i < count; ++i) {
    const auto place = static_cast<double>(i);
    const Sums left = between(place - apart, place), right = between(place, place + apart);
    if (left.count >= 1.0 && right.count >= 1.0) height[i] = std::abs(right.sum / right.count - left.sum / left.count);
  }
  std::vector<std::size_t> order(count + 1);
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return height[a] > height[b]; });
  std::vector<double> places;
  for (const std::size_t i : order) {
    if (places.size() == most || !(height[i] > 0.0)) break;
    const auto place = static_cast<double>(i);
    const bool taken = std::any_of(places.begin(), places.end(), [&](double p) { return std::abs(p - place) < apart; });
    if (!taken) places.push_back(place);
  }
  return places;
}

Lattice fit_lattice(const WedgeProfile& profile, std::size_t strips, std::span<const double> grays) {
  const auto count = static_cast<double>(strips);
  // Strips fill at least a third of the profile: a jump has no other within half of the narrowest strip.
  const double apart = std::max(2.0, profile.length() / (6.0 * count));
  std::vector<double> places = profile.jumps(apart, std::min<std::size_t>(strips + 1, 24));
  places.push_back(0.0);
  places.push_back(profile.length());
  Lattice best;
  best.cost = std::numeric_limits<double>::infinity();
  const auto offer = [&](double first, double width) {
    if (width < least_width || first < -0.3 * width || first + count * width > profile.length() + 0.3 * width) return;
    for (const bool reversed : {false, true}) {
      Lattice lattice{first, width, reversed, 0.0};
      lattice.cost = cost_of(profile, strips, grays, lattice);
      if (lattice.cost < best.cost) best = lattice;
      if (grays.empty()) break;
    }
  };
  // Any two jumps may be any two borders.
  for (const double a : places) {
    for (const double b : places) {
      if (b <= a) continue;
      for (std::size_t between = 1; between <= strips; ++between) {
        const double width = (b - a) / static_cast<double>(between);
        if (width < least_width || count * width < profile.length() / 3.0) continue;
        for (std::size_t i = 0; i + between <= strips; ++i) offer(a - static_cast<double>(i) * width, width);
      }
    }
  }
  return std::isfinite(best.cost) ? refined(profile, strips, grays, best) : best;
}

}  // namespace mezzotint
