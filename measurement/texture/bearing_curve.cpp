#include "measurement/texture/bearing_curve.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

#include "forward/base/error.h"
#include "measurement/texture/height_counts.h"

namespace mezzotint {

namespace {

void require_enough(std::size_t samples) {
  require(samples >= 4, "a material ratio curve needs four measured samples at least");
}

// Counted where they are many, else sorted.
BearingCurve curve_of(const HeightField& field) {
  if (field.grid().size() > BearingCurve::most_exact) {
    const std::vector<HeightCounts> blocks = counts_in_blocks(field);
    if (!blocks.empty()) return BearingCurve(sum_of(blocks));
  }
  std::vector<float> heights_um;
  heights_um.reserve(field.grid().size());
  std::ranges::copy_if(field.heights_um(), std::back_inserter(heights_um), [](float z) { return !std::isnan(z); });
  return BearingCurve(std::move(heights_um));
}

}  // namespace

BearingCurve::BearingCurve(const HeightField& field) : BearingCurve(curve_of(field)) {}

BearingCurve::BearingCurve(std::vector<float> heights_um)
    : samples_(heights_um.size()), heights_um_(std::move(heights_um)), ratios_(samples_) {
  require_enough(samples_);
  std::ranges::sort(heights_um_, std::greater<>());
  for (std::size_t k = 0; k < samples_; ++k)
    ratios_[k] = (static_cast<double>(k) + 0.5) / static_cast<double>(samples_);
  integrate();
}

BearingCurve::BearingCurve(const HeightCounts& counts) : samples_(counts.samples) {
  require_enough(samples_);
  const double bin_um = (static_cast<double>(counts.highest_um) - static_cast<double>(counts.lowest_um)) /
                        static_cast<double>(HeightCounts::bins);
  std::size_t above = 0;
  const auto add = [&](std::size_t edge) {
    heights_um_.push_back(
        static_cast<float>(static_cast<double>(counts.highest_um) - static_cast<double>(edge) * bin_um));
    ratios_.push_back(static_cast<double>(above) / static_cast<double>(samples_));
  };
  for (std::size_t bin = 0; bin < HeightCounts::bins; ++bin) {
    if (counts.counts[bin] == 0) continue;
    // A gap in the heights is a cliff: both of its ends are places of the curve.
    if (heights_um_.empty() || counts.counts[bin - 1] == 0) add(bin);
    above += counts.counts[bin];
    add(bin + 1);
  }
  integrate();
}

void BearingCurve::integrate() {
  sums_.resize(heights_um_.size());
  double sum = ratios_.front() * static_cast<double>(heights_um_.front());
  sums_[0] = sum;
  for (std::size_t k = 1; k < heights_um_.size(); ++k) {
    sum += 0.5 * (ratios_[k] - ratios_[k - 1]) *
           (static_cast<double>(heights_um_[k - 1]) + static_cast<double>(heights_um_[k]));
    sums_[k] = sum;
  }
}

double BearingCurve::height_um(double ratio) const {
  const auto after = std::ranges::upper_bound(ratios_, ratio);
  if (after == ratios_.begin()) return heights_um_.front();
  if (after == ratios_.end()) return heights_um_.back();
  const auto k = static_cast<std::size_t>(after - ratios_.begin());
  const double rest = (ratio - ratios_[k - 1]) / (ratios_[k] - ratios_[k - 1]);
  return (1.0 - rest) * static_cast<double>(heights_um_[k - 1]) + rest * static_cast<double>(heights_um_[k]);
}

double BearingCurve::ratio(double height_um) const {
  if (height_um > static_cast<double>(heights_um_.front())) return 0.0;
  if (height_um <= static_cast<double>(heights_um_.back())) return 1.0;
  // The last height that is at least as high, and the next one below.
  const auto below = std::partition_point(heights_um_.begin(), heights_um_.end(),
                                          [&](float z) { return static_cast<double>(z) >= height_um; });
  const auto k = static_cast<std::size_t>(below - heights_um_.begin());
  const double high = heights_um_[k - 1], low = heights_um_[k];
  return ratios_[k - 1] + (ratios_[k] - ratios_[k - 1]) * (high - height_um) / (high - low);
}

double BearingCurve::integral_to(double ratio) const {
  const double place = std::clamp(ratio, 0.0, 1.0);
  const auto after = std::ranges::upper_bound(ratios_, place);
  if (after == ratios_.begin()) return place * static_cast<double>(heights_um_.front());
  const auto k = static_cast<std::size_t>(after - ratios_.begin()) - 1;
  return sums_[k] + (place - ratios_[k]) * 0.5 * (static_cast<double>(heights_um_[k]) + height_um(place));
}

// A place counts for the ratios that are nearer to it than to its neighbours: all alike where each is a sample.
BearingCurve::Line BearingCurve::line_through(double from, double to) const {
  constexpr double rounding = 1e-12;
  const auto first = std::ranges::lower_bound(ratios_, from - rounding) - ratios_.begin();
  const auto end = std::ranges::upper_bound(ratios_, to + rounding) - ratios_.begin();
  const auto at = [this](std::ptrdiff_t k) { return ratios_[static_cast<std::size_t>(k)]; };
  const auto last = static_cast<std::ptrdiff_t>(ratios_.size()) - 1;
  const auto begin_of = [&](std::ptrdiff_t k) { return k == 0 ? 0.0 : 0.5 * (at(k - 1) + at(k)); };
  double weights = 0.0, ratio = 0.0, height = 0.0, squares = 0.0, moment = 0.0;
  const auto for_each = [&](const auto& visit) {
    for (std::ptrdiff_t k = first; k < end; ++k)
      visit((k == last ? 1.0 : begin_of(k + 1)) - begin_of(k), at(k),
            static_cast<double>(heights_um_[static_cast<std::size_t>(k)]));
  };
  for_each([&](double weight, double q, double z) {
    weights += weight;
    ratio += weight * q;
    height += weight * z;
  });
  for_each([&](double weight, double q, double z) {
    squares += weight * (q - ratio / weights) * (q - ratio / weights);
    moment += weight * (q - ratio / weights) * z;
  });
  if (!(squares > 0.0)) {
    const double high = height_um(from), fall = (high - height_um(to)) / (to - from);
    return {high + from * fall, high + (from - 1.0) * fall};
  }
  const double fall = -moment / squares, top = height / weights + fall * ratio / weights;
  return {top, top - fall};
}

double BearingCurve::integral_um(double from, double to) const { return integral_to(to) - integral_to(from); }

}  // namespace mezzotint
