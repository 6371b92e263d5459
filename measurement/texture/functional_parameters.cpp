#include "measurement/texture/functional_parameters.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "measurement/texture/block_jackknife.h"
#include "measurement/texture/blocks.h"
#include "measurement/texture/height_counts.h"

namespace mezzotint {

namespace {

constexpr std::size_t parameter_count = 10;
using Values = std::array<double, parameter_count>;

// The stretch of 40 % of material ratio over which the curve falls least: the ratio at which it begins. The half steps
// at both ends, where the curve is level because nothing is known beyond, are left out.
double flattest_stretch(const BearingCurve& curve) {
  constexpr std::size_t steps = 6000;  // a tenth of a per mille of material ratio
  const double half = 0.5 / static_cast<double>(curve.samples()), range = std::max(0.0, 0.6 - 2.0 * half);
  std::array<double, steps + 1> falls{};
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k <= steps; ++k) {
    const double p = half + range * static_cast<double>(k) / steps;
    falls[k] = curve.height_um(p) - curve.height_um(p + 0.4);
    least = std::min(least, falls[k]);
  }
  const double equal = least + 1e-9 * std::abs(least);
  const auto is_least = [equal](double fall) { return fall <= equal; };
  const auto first = std::ranges::find_if(falls, is_least);
  const auto end = std::find_if_not(first, falls.end(), is_least);
  const double middle =
      0.5 * (static_cast<double>(first - falls.begin()) + static_cast<double>(end - falls.begin()) - 1.0);
  return half + range * middle / steps;
}

// In the order of FunctionalParameters.
Values values_of(const BearingCurve& curve) {
  const double begin = flattest_stretch(curve);
  const auto [top, bottom] = curve.line_through(begin, begin + 0.4);  // the equivalent straight line
  const double mr1 = curve.ratio(top), mr2 = curve.ratio(bottom);
  const double hills = curve.integral_um(0.0, mr1) - mr1 * top;
  const double dales = (1.0 - mr2) * bottom - curve.integral_um(mr2, 1.0);
  const auto material = [&](double p) { return curve.integral_um(0.0, p) - p * curve.height_um(p); };
  const auto voids = [&](double p) { return (1.0 - p) * curve.height_um(p) - curve.integral_um(p, 1.0); };
  return {top - bottom,
          mr1 > 0.0 ? 2.0 * std::max(0.0, hills) / mr1 : 0.0,
          mr2 < 1.0 ? 2.0 * std::max(0.0, dales) / (1.0 - mr2) : 0.0,
          mr1,
          mr2,
          material(0.1),
          material(0.8) - material(0.1),
          voids(0.1) - voids(0.8),
          voids(0.8),
          curve.height_um(0.025) - curve.height_um(0.5)};
}

/// Values of the whole surface, and without each of its blocks.
struct Jackknife {
  Values whole{};
  std::array<Values, block_count> without{};
  std::array<double, block_count> samples{};
};

Jackknife of_counts(const std::vector<HeightCounts>& blocks) {
  const HeightCounts sum = sum_of(blocks);
  Jackknife result{values_of(BearingCurve(sum))};
  for (std::size_t left_out = 0; left_out < block_count; ++left_out) {
    HeightCounts rest = sum;
    rest -= blocks[left_out];
    result.samples[left_out] = static_cast<double>(blocks[left_out].samples);
    result.without[left_out] = rest.samples >= 4 ? values_of(BearingCurve(rest)) : result.whole;
  }
  return result;
}

Jackknife of_heights(const HeightField& field) {
  std::array<std::vector<float>, block_count> blocks;
  for_each_in_blocks(field, [&](std::size_t block, double z) { blocks[block].push_back(static_cast<float>(z)); });
  Jackknife result{values_of(BearingCurve(field))};
  for (std::size_t left_out = 0; left_out < block_count; ++left_out) {
    result.samples[left_out] = static_cast<double>(blocks[left_out].size());
    std::vector<float> rest;
    for (std::size_t block = 0; block < block_count; ++block)
      if (block != left_out) rest.insert(rest.end(), blocks[block].begin(), blocks[block].end());
    const bool enough = result.samples[left_out] > 0.0 && rest.size() >= 4;
    result.without[left_out] = enough ? values_of(BearingCurve(std::move(rest))) : result.whole;
  }
  return result;
}

}  // namespace

FunctionalParameters functional_parameters(const HeightField& field) {
  const std::vector<HeightCounts> blocks = counts_in_blocks(field);
  const auto [whole, without, samples] = blocks.empty() ? of_heights(field) : of_counts(blocks);
  const auto quantity = [&whole = whole, &without = without, &samples = samples](std::size_t k, const char* unit) {
    std::array<double, block_count> column{};
    std::ranges::transform(without, column.begin(), [k](const Values& values) { return values[k]; });
    return Quantity{whole[k], unit, jackknife_standard_error(whole[k], column, samples)};
  };
  return {quantity(0, "µm"), quantity(1, "µm"), quantity(2, "µm"), quantity(3, "1"),  quantity(4, "1"),
          quantity(5, "µm"), quantity(6, "µm"), quantity(7, "µm"), quantity(8, "µm"), quantity(9, "µm")};
}

}  // namespace mezzotint
