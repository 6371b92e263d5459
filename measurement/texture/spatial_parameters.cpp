#include "measurement/texture/spatial_parameters.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include <fmt/format.h>

#include "forward/base/error.h"
#include "measurement/texture/autocorrelation.h"
#include "measurement/texture/block_jackknife.h"
#include "measurement/texture/blocks.h"
#include "measurement/texture/power_spectrum.h"

namespace mezzotint {

namespace {

constexpr double threshold = 0.2;
constexpr int directions = 360;  // over half a turn: f(−t) = f(t)
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

// Bilinear between lags; NaN beyond the last.
double value_at(const Autocorrelation& f, double x, double y) {
  const double left = std::floor(x), low = std::floor(y);
  if (std::abs(left) >= static_cast<double>(f.lag_x) || std::abs(low) >= static_cast<double>(f.lag_y)) return nan;
  const auto i = static_cast<std::ptrdiff_t>(left), j = static_cast<std::ptrdiff_t>(low);
  const double u = x - left, v = y - low;
  return (1.0 - v) * ((1.0 - u) * f.at(i, j) + u * f.at(i + 1, j)) +
         v * ((1.0 - u) * f.at(i, j + 1) + u * f.at(i + 1, j + 1));
}

struct Decay {
  double length_um = 0.0;
  bool reached = false;  // else the length is how far could be looked
};

// From the middle in one direction to the first place where f is down to the threshold.
Decay decay_along(const Autocorrelation& f, double angle) {
  const double dx = std::cos(angle) / f.pitch_x.um(), dy = std::sin(angle) / f.pitch_y.um();
  const double step_um = 0.25 * std::min(f.pitch_x.um(), f.pitch_y.um());
  double last = 1.0;
  for (std::size_t k = 1;; ++k) {
    const double way = step_um * static_cast<double>(k), value = value_at(f, way * dx, way * dy);
    if (std::isnan(value)) return {way - step_um, false};
    if (value <= threshold) return {way - step_um * (threshold - value) / (last - value), true};
    last = value;
  }
}

struct Extremes {
  double shortest = HUGE_VAL, longest = 0.0, longest_angle = 0.0;
  bool any = false, all = true;
};

Extremes decays(const Autocorrelation& f) {
  Extremes result;
  for (int k = 0; k < directions; ++k) {
    const double angle = std::numbers::pi * k / directions;
    const Decay decay = decay_along(f, angle);
    result.any |= decay.reached;
    result.all &= decay.reached;
    if (decay.reached) result.shortest = std::min(result.shortest, decay.length_um);
    if (decay.length_um > result.longest) {
      result.longest = decay.length_um;
      result.longest_angle = angle;
    }
  }
  return result;
}

HeightField block_of(const HeightField& field, std::size_t block) {
  const auto begin = [](std::size_t k, std::size_t count) { return (k * count + blocks_a_side - 1) / blocks_a_side; };
  const std::size_t bx = block % blocks_a_side, by = block / blocks_a_side;
  const std::size_t x0 = begin(bx, field.columns()), x1 = begin(bx + 1, field.columns());
  const std::size_t y0 = begin(by, field.rows()), y1 = begin(by + 1, field.rows());
  return crop(field, x0, y0, x1 - x0, y1 - y0);
}

/// Sal and Str without one block each, from the mean of the other blocks' autocorrelations about the whole mean.
struct Jackknife {
  double sal = nan, str = nan;
  double str_of_blocks = nan;  ///< mean over single blocks
};

Jackknife jackknife(const HeightField& field, double sal_um) {
  const Grid& grid = field.grid();
  const std::size_t columns = grid.columns / blocks_a_side, rows = grid.rows / blocks_a_side;
  const double side_um =
      std::min(static_cast<double>(columns) * grid.pitch_x.um(), static_cast<double>(rows) * grid.pitch_y.um());
  if (!(sal_um < 0.25 * side_um)) return {};
  std::array<Autocorrelation, block_count> blocks;
  std::array<double, block_count> samples{};
  std::size_t lag_x = field.columns(), lag_y = field.rows();
  for (std::size_t block = 0; block < block_count; ++block) {
    const HeightField part = block_of(field, block);
    const auto measured = part.grid().size() - part.missing_count();
    if (2 * measured < part.grid().size()) continue;
    const HeightRange range = height_range(part);
    if (range.highest == range.lowest) continue;  // a flat block has nothing to say
    blocks[block] = autocorrelation(part);
    samples[block] = static_cast<double>(measured);
    lag_x = std::min(lag_x, blocks[block].lag_x);
    lag_y = std::min(lag_y, blocks[block].lag_y);
  }
  const auto mean_without = [&](std::size_t left_out) {
    Autocorrelation mean{lag_x, lag_y, grid.pitch_x, grid.pitch_y,
                         std::vector<double>((2 * lag_x + 1) * (2 * lag_y + 1), 0.0)};
    double total = 0.0;
    for (std::size_t block = 0; block < block_count; ++block) total += block == left_out ? 0.0 : samples[block];
    for (std::size_t block = 0; block < block_count; ++block) {
      if (block == left_out || samples[block] == 0.0) continue;
      std::size_t k = 0;
      for (auto y = -static_cast<std::ptrdiff_t>(lag_y); y <= static_cast<std::ptrdiff_t>(lag_y); ++y)
        for (auto x = -static_cast<std::ptrdiff_t>(lag_x); x <= static_cast<std::ptrdiff_t>(lag_x); ++x)
          mean.values[k++] += samples[block] / total * blocks[block].at(x, y);
    }
    return mean;
  };
  const Extremes whole = decays(mean_without(block_count));
  std::array<double, block_count> sal{}, str{};
  double own_str = 0.0, own = 0.0;
  for (std::size_t block = 0; block < block_count; ++block) {
    if (samples[block] > 0.0) {
      const Extremes alone = decays(blocks[block]);
      own_str += alone.any ? alone.shortest / alone.longest : 1.0;
      own += 1.0;
    }
    const Extremes without = samples[block] > 0.0 ? decays(mean_without(block)) : whole;
    sal[block] = without.shortest;
    str[block] = without.shortest / without.longest;
  }
  return {jackknife_standard_error(whole.shortest, sal, samples),
          whole.all ? jackknife_standard_error(whole.shortest / whole.longest, str, samples) : nan, own_str / own};
}

// A lay that turns, or several: each block has one, the whole has none.
std::string turning_note(double whole, double of_blocks) {
  constexpr double much = 2.5;
  if (!(whole > much * of_blocks)) return "";
  return fmt::format(
      "Str is {:.2g}, but {:.2g} on average within a sixteenth of the field: the lay turns across it, and Str and Std "
      "describe no part of it. Take a part (correct --crop)",
      whole, of_blocks);
}

}  // namespace

SpatialParameters spatial_parameters(const HeightField& field) {
  require(field.columns() >= 16 && field.rows() >= 16, "spatial parameters need 16 x 16 samples at least");
  const Extremes found = decays(autocorrelation(field));
  SpatialParameters result;
  const double sal = found.any ? found.shortest : nan;
  const Jackknife errors = jackknife(field, sal);
  result.Sal = {sal, "µm", errors.sal};
  result.Str = {found.any ? found.shortest / found.longest : nan, "1", errors.str};
  if (found.any && !found.all) {
    result.note =
        fmt::format("the autocorrelation does not fall to 0.2 within {:.4g} µm at {:.0f}°: Str is at most {:.3g}",
                    found.longest, found.longest_angle * 180.0 / std::numbers::pi, result.Str.value);
  } else if (!found.any) {
    result.note =
        "the autocorrelation does not fall to 0.2 within half of the field in any direction: measure a larger one";
  }
  if (result.note.empty()) result.note = turning_note(result.Str.value, errors.str_of_blocks);
  result.Std = {nan, "°", nan};
  if (field.missing_count() == 0) {
    const AngularSpectrum angular = angular_spectrum(power_spectrum(field));
    const auto most = std::ranges::max_element(angular.share);
    const double step = 180.0 / static_cast<double>(angular.share.size());
    // The direction is known to its step; a uniform error of ± half a step.
    result.Std = {step * static_cast<double>(most - angular.share.begin()), "°", step / std::sqrt(12.0)};
  }
  return result;
}

}  // namespace mezzotint
