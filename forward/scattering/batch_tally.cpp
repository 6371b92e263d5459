#include "forward/scattering/batch_tally.h"

#include <algorithm>
#include <cmath>

namespace mezzotint {

void BatchTally::leave_all(Fate fate, std::span<const std::uint32_t> which, const std::vector<std::uint32_t>& bins,
                           const std::vector<float>& weights, std::uint32_t order) {
  const std::size_t side = fate == Fate::Reflected ? 0 : 1;
  DirectionMap& map = side == 0 ? reflected : transmitted;
  double sum = 0.0, absolute = 0.0;  // in registers
  for (const std::uint32_t k : which) {
    const double weight = double{weights[k]};
    map[bins[k]] += weight;
    sum += weight;
    const double size = std::abs(weight);
    absolute += size;
    squares[side][bins[k]] += weight * weight;
    if (weight < 0.0) negative[side][bins[k]] += size;
    if (size > largest_weight[side]) largest_weight[side] = size;
  }
  arrivals[side] += static_cast<double>(which.size());
  arrived_weight[side] += absolute;
  add(fate, sum);
  if (side != 0 || orders.empty()) return;
  DirectionMap& of_order = orders[std::min<std::size_t>(order, orders.size()) - 1];
  for (const std::uint32_t k : which) of_order[bins[k]] += double{weights[k]};
}

void BatchTally::close_slice() {
  for (std::size_t k = 0; k < fate_count; ++k) total_energy[k] += energy[k];
  energy = {};
}

void BatchTally::add(const BatchTally& other) {
  const auto add_map = [](DirectionMap& to, const DirectionMap& from) {
    for (std::size_t k = 0; k < to.size(); ++k) to[k] += from[k];
  };
  add_map(reflected, other.reflected);
  add_map(transmitted, other.transmitted);
  for (std::size_t k = 0; k < orders.size(); ++k) add_map(orders[k], other.orders[k]);
  for (std::size_t k = 0; k < fate_count; ++k) total_energy[k] += other.total_energy[k];
  interactions += other.interactions;
  for (std::size_t map = 0; map < 2; ++map) {
    arrivals[map] += other.arrivals[map];
    arrived_weight[map] += other.arrived_weight[map];
    add_map(squares[map], other.squares[map]);
    add_map(negative[map], other.negative[map]);
    largest_weight[map] = std::max(largest_weight[map], other.largest_weight[map]);
  }
  normal_fallbacks += other.normal_fallbacks;
  leaked += other.leaked;
}

BatchStatistics::BatchStatistics(std::size_t size)
    : mean_(size), squares_(size), half_sums_{std::vector<double>(size), std::vector<double>(size)} {}

void BatchStatistics::add(std::span<const double> values) {
  const std::size_t half = static_cast<std::size_t>(count_) % 2;
  half_counts_[half] += 1.0;
  count_ += 1.0;
  for (std::size_t k = 0; k < values.size(); ++k) {
    const double deviation = values[k] - mean_[k];
    mean_[k] += deviation / count_;
    squares_[k] += deviation * (values[k] - mean_[k]);
    half_sums_[half][k] += values[k];
  }
}

MapEstimate BatchStatistics::estimate(std::span<const double> scale) const {
  MapEstimate result;
  const auto per_error = 1.0 / (count_ * (count_ - 1.0));
  for (std::size_t k = 0; k < mean_.size(); ++k) {
    result.mean.push_back(mean_[k] * scale[k]);
    result.standard_error.push_back(std::sqrt(squares_[k] * per_error) * scale[k]);
    result.half_a.push_back(half_sums_[0][k] / half_counts_[0] * scale[k]);
    result.half_b.push_back(half_sums_[1][k] / half_counts_[1] * scale[k]);
  }
  return result;
}

}  // namespace mezzotint
