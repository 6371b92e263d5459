#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "forward/optics/bsdf.h"
#include "forward/optics/direction_map.h"

namespace mezzotint {

/// Where light can go; the order of EnergyAudit.
enum class Fate : std::uint8_t { Reflected, Transmitted, Absorbed, LeftSideways, CutOff };
inline constexpr std::size_t fate_count = 5;
using EnergyTally = std::array<double, fate_count>;

/// What the paths of one batch add up to. One batch is walked by one thread at a time, in the order of its
/// samples, so that its sums have the same bits however many threads there are.
struct BatchTally {
  explicit BatchTally(const DirectionGrid& direction_grid)
      : grid(direction_grid), reflected(direction_grid.size()), transmitted(direction_grid.size()) {
    squares.fill(DirectionMap(direction_grid.size()));
    negative.fill(DirectionMap(direction_grid.size()));
  }

  void add(Fate fate, double weight) { energy[static_cast<std::size_t>(fate)] += weight; }
  /// Light that leaves for good into a bin after `order` interactions: Reflected or Transmitted.
  void leave(Fate fate, std::size_t bin, double weight, std::uint32_t order) {
    const std::size_t map = fate == Fate::Reflected ? 0 : 1;
    (map == 0 ? reflected : transmitted)[bin] += weight;
    if (map == 0 && !orders.empty()) orders[std::min<std::size_t>(order, orders.size()) - 1][bin] += weight;
    arrivals[map] += 1.0;
    const double size = std::abs(weight);
    arrived_weight[map] += size;
    squares[map][bin] += weight * weight;
    if (weight < 0.0) negative[map][bin] += size;
    if (size > largest_weight[map]) largest_weight[map] = size;
    add(fate, weight);
  }
  /// The same for the paths `which` of many.
  void leave_all(Fate fate, std::span<const std::uint32_t> which, const std::vector<std::uint32_t>& bins,
                 const std::vector<float>& weights, std::uint32_t order);
  /// Keeps the reflection apart by order of interaction: maps for 1, 2, …, and the last for that order and above.
  void keep_orders(std::uint32_t maps) { orders.assign(maps, DirectionMap(reflected.size())); }
  /// Moves the energies since the last call to the total: sums of sums stay exact to 1e-15 over 2^36 paths.
  void close_slice();

  /// Adds another tally of the same shape.
  void add(const BatchTally& other);

  DirectionGrid grid;
  DirectionMap reflected;
  DirectionMap transmitted;
  EnergyTally energy{};  ///< of the open slice
  EnergyTally total_energy{};
  std::uint64_t interactions = 0;
  /// Entries into each of the two maps (reflection, transmission), and the sum of their absolute weights.
  std::array<double, 2> arrivals{}, arrived_weight{};
  /// Of each of the two maps, bin by bin: the sum of squared weights, and of the absolute weights of those below 0
  /// (light that is taken from a splat); the largest absolute weight of all.
  std::array<DirectionMap, 2> squares, negative;
  std::array<double, 2> largest_weight{};
  std::uint64_t normal_fallbacks = 0;  ///< interactions whose interpolated normal could not be used
  std::vector<DirectionMap> orders;    ///< empty where not asked for
  double leaked = 0.0;                 ///< the part of CutOff that went through the surface by rounding
};

/// Mean and spread of values that come batch after batch (Welford), with the means of even and odd batches.
class BatchStatistics {
public:
  explicit BatchStatistics(std::size_t size);
  void add(std::span<const double> values);

  /// All estimates, value k multiplied by scale[k].
  [[nodiscard]] MapEstimate estimate(std::span<const double> scale) const;

private:
  double count_ = 0.0;
  std::vector<double> mean_;
  std::vector<double> squares_;
  std::array<std::vector<double>, 2> half_sums_;
  std::array<double, 2> half_counts_{};
};

}  // namespace mezzotint
