#include "measurement/correction/flatten_base.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include <fmt/format.h>

#include "forward/base/error.h"

namespace mezzotint {

namespace {

constexpr int most_iterations = 12;  // a degree
constexpr double width_of_base = 3.0;
constexpr double half_of_a_gaussian = 1.3489795;  // its middle half is so many standard deviations wide
constexpr std::size_t bins = 8192;

struct Base {
  double middle_um = 0.0, deviation_um = 0.0;
};

// The shortest interval that holds half of the samples, to one of 8192 bins of the range.
Base densest_half(const HeightField& field) {
  const HeightRange range = height_range(field);
  const double low = range.lowest.um(), width = (range.highest - range.lowest).um();
  if (width == 0.0) return {low, 0.0};
  std::array<std::uint32_t, bins> counts{};
  const double per_um = static_cast<double>(bins) / width;
  std::size_t total = 0;
  for (const float z : field.heights_um()) {
    if (std::isnan(z)) continue;
    ++counts[std::min(bins - 1, static_cast<std::size_t>((static_cast<double>(z) - low) * per_um))];
    ++total;
  }
  std::size_t first = 0, inside = 0, shortest = bins + 1, at = 0;
  for (std::size_t last = 0; last < bins; ++last) {
    inside += counts[last];
    while (2 * (inside - counts[first]) >= total) inside -= counts[first++];
    if (2 * inside >= total && last - first + 1 < shortest) {
      shortest = last - first + 1;
      at = first;
    }
  }
  const double length = static_cast<double>(shortest) / per_um;
  return {low + static_cast<double>(at) / per_um + 0.5 * length, length / half_of_a_gaussian};
}

// Marks the base; returns how many samples changed sides.
std::size_t mark(const HeightField& field, const Base& base, std::vector<std::uint8_t>& use) {
  std::size_t changed = 0;
  for (std::size_t i = 0; i < use.size(); ++i) {
    const double off = std::abs(static_cast<double>(field.heights_um()[i]) - base.middle_um);
    const std::uint8_t in = off <= width_of_base * base.deviation_um ? 1 : 0;
    changed += in != use[i] ? 1 : 0;
    use[i] = in;
  }
  return changed;
}

// Of the samples that are not base, the share that lies below it.
double share_below(const HeightField& flat, const std::vector<std::uint8_t>& base) {
  double below = 0.0, all = 0.0;
  for (std::size_t i = 0; i < base.size(); ++i) {
    const float z = flat.heights_um()[i];
    if (base[i] != 0 || std::isnan(z)) continue;
    all += 1.0;
    below += z < 0.0F ? 1.0 : 0.0;
  }
  return all > 0.0 ? below / all : 0.0;
}

std::string warning_of(const FlattenedBase& flat, double below) {
  constexpr double most = 0.75, mostly = 0.9;
  if (!flat.settled) return "the base did not settle: it may not be what most of the surface is; look at the result";
  if (flat.base_share >= most || below < mostly) return "";
  return fmt::format(
      "what was taken for the base is {:.0f} % of the samples, and the others lie below it: plateaus that cover more "
      "than half of a surface are taken for its base. Crop a part with more base, or level by a plane",
      100.0 * flat.base_share);
}

}  // namespace

FlattenedBase flatten_base(const HeightField& field, int degree) {
  require(degree >= 1 && degree <= highest_degree, "a base is flattened by a polynomial of degree 1 to 12");
  FlattenedBase result{subtract_polynomial(field, fit_polynomial(field, 1))};
  const auto measured = static_cast<double>(field.grid().size() - field.missing_count());
  std::vector<std::uint8_t> use(field.grid().size(), 0);
  for (int d = 1; d <= degree; ++d) {
    result.settled = false;
    for (int step = 0; step < most_iterations && !result.settled; ++step) {
      const std::size_t changed = mark(result.field, densest_half(result.field), use);
      result.settled = step > 0 && static_cast<double>(changed) <= 1e-3 * measured;
      if (result.settled) break;
      // Of the field itself, so that the rounding of many subtractions does not add up.
      result.field = subtract_polynomial(field, fit_polynomial(field, d, use));
      ++result.iterations;
    }
  }
  result.base_share = static_cast<double>(std::count(use.begin(), use.end(), 1)) / measured;
  result.warning = warning_of(result, share_below(result.field, use));
  return result;
}

}  // namespace mezzotint
