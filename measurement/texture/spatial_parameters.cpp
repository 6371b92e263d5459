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
double bilinear(const Autocorrelation& f, double x, double y) {
  const auto lag_x = static_cast<std::ptrdiff_t>(f.lag_x), lag_y = static_cast<std::ptrdiff_t>(f.lag_y);
  const double left = std::floor(x), low = std::floor(y), u = x - left, v = y - low;
  const auto i = static_cast<std::ptrdiff_t>(left), j = static_cast<std::ptrdiff_t>(low);
  if (i < -lag_x || j < -lag_y || i + 1 > lag_x || j + 1 > lag_y) return nan;
  return (1.0 - v) * ((1.0 - u) * f.at(i, j) + u * f.at(i + 1, j)) +
         v * ((1.0 - u) * f.at(i, j + 1) + u * f.at(i + 1, j + 1));
}

// Lagrange's polynomial of the fifth degree through the six places −2 … 3.
std::array<double, 6> sixth_order_weights(double u) {
  std::array<double, 6> weights{};
  for (int k = 0; k < 6; ++k) {
    double weight = 1.0;
    for (int j = 0; j < 6; ++j) weight *= j == k ? 1.0 : (u - (j - 2)) / (k - j);
    weights[static_cast<std::size_t>(k)] = weight;
  }
  return weights;
}

// The same of the sixth order; NaN where one of the 36 lags around is beyond the last.
double smooth(const Autocorrelation& f, double x, double y) {
  const auto lag_x = static_cast<std::ptrdiff_t>(f.lag_x), lag_y = static_cast<std::ptrdiff_t>(f.lag_y);
  const auto i = static_cast<std::ptrdiff_t>(std::floor(x)) - 2, j = static_cast<std::ptrdiff_t>(std::floor(y)) - 2;
  if (i < -lag_x || j < -lag_y || i + 5 > lag_x || j + 5 > lag_y) return nan;
  const auto u = sixth_order_weights(x - std::floor(x)), v = sixth_order_weights(y - std::floor(y));
  double sum = 0.0;
  for (std::size_t row = 0; row < 6; ++row)
    for (std::size_t column = 0; column < 6; ++column)
      sum += v[row] * u[column] * f.at(i + static_cast<std::ptrdiff_t>(column), j + static_cast<std::ptrdiff_t>(row));
  return sum;
}

// From the middle in one direction to the first place where f is down to the threshold: walked in quarter steps, then
// found between two of them.
Decay decay_along(const Autocorrelation& f, double angle) {
  const Angle direction = Angle::from_radians(angle);
  const double dx = std::cos(angle) / f.pitch_x.um(), dy = std::sin(angle) / f.pitch_y.um();
  const double step_um = 0.25 * std::min(f.pitch_x.um(), f.pitch_y.um());
  double last = 1.0;
  for (std::size_t k = 1;; ++k) {
    const double way = step_um * static_cast<double>(k), value = bilinear(f, way * dx, way * dy);
    if (std::isnan(value)) return {direction, way - step_um, false};
    if (value > threshold) {
      last = value;
      continue;
    }
    // A chord lies below a crest and above a dale: the smooth curve may cross a little before or after.
    double above = std::max(0.0, way - 3.0 * step_um), below = way + 2.0 * step_um;
    const auto excess = [&](double at) { return smooth(f, at * dx, at * dy) - threshold; };
    if (!(excess(above) > 0.0) || !(excess(below) <= 0.0))
      return {direction, way - step_um * (threshold - value) / (last - value), true};
    for (int i = 0; i < 40; ++i) {
      const double middle = 0.5 * (above + below);
      (excess(middle) > 0.0 ? above : below) = middle;
    }
    return {direction, 0.5 * (above + below), true};
  }
}

// The best way near a direction, by golden sections. `sign` is 1 for the shortest, −1 for the longest. A kink beside it
// (a direction that does not reach the threshold) ends the search at the best that was seen.
Decay best_near(const Autocorrelation& f, double angle, Decay best, double sign) {
  constexpr double golden = 0.6180339887498949;
  double low = angle - std::numbers::pi / directions, high = angle + std::numbers::pi / directions;
  for (int i = 0; i < 24; ++i) {
    const double a = high - golden * (high - low), b = low + golden * (high - low);
    const Decay at_a = decay_along(f, a), at_b = decay_along(f, b);
    for (const Decay& decay : {at_a, at_b})
      if (decay.reached && sign * decay.length_um < sign * best.length_um) best = decay;
    (sign * at_a.length_um < sign * at_b.length_um ? high : low) =
        sign * at_a.length_um < sign * at_b.length_um ? b : a;
  }
  return best;
}

struct Extremes {
  double shortest = HUGE_VAL, longest = 0.0, longest_angle = 0.0;
  bool any = false, all = true;
};

Extremes extremes(const Autocorrelation& f) {
  Extremes result;
  Decay shortest{{}, HUGE_VAL, false}, longest;
  for (const Decay& decay : decays_of(f)) {
    result.any |= decay.reached;
    result.all &= decay.reached;
    if (decay.reached && decay.length_um < shortest.length_um) shortest = decay;
    if (decay.length_um > longest.length_um) longest = decay;
  }
  result.longest_angle = longest.direction.radians();
  if (result.any) shortest = best_near(f, shortest.direction.radians(), shortest, 1.0);
  if (result.all) longest = best_near(f, result.longest_angle, longest, -1.0);
  result.shortest = shortest.length_um;
  result.longest = longest.length_um;
  return result;
}

HeightField block_of(const HeightField& field, std::size_t block) {
  const auto begin = [](std::size_t k, std::size_t count) { return (k * count + blocks_a_side - 1) / blocks_a_side; };
  const std::size_t bx = block % blocks_a_side, by = block / blocks_a_side;
  const std::size_t x0 = begin(bx, field.columns()), x1 = begin(bx + 1, field.columns());
  const std::size_t y0 = begin(by, field.rows()), y1 = begin(by + 1, field.rows());
  return crop(field, x0, y0, x1 - x0, y1 - y0);
}

/// Standard errors of Sal and Str, from the mean of the blocks' autocorrelations without one block each (a block's
/// about its own mean).
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
  if (std::ranges::count_if(samples, [](double count) { return count > 0.0; }) < 2) return {};
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
  const Extremes whole = extremes(mean_without(block_count));
  std::array<double, block_count> sal{}, str{};
  double own_str = 0.0, own = 0.0;
  for (std::size_t block = 0; block < block_count; ++block) {
    if (samples[block] > 0.0) {
      const Extremes alone = extremes(blocks[block]);
      own_str += alone.any ? alone.shortest / alone.longest : 1.0;
      own += 1.0;
    }
    const Extremes without = samples[block] > 0.0 ? extremes(mean_without(block)) : whole;
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

// Frequencies that both axes resolve: in the corners beyond, diagonals alone have power. Where most of it is there (a
// wave that one axis alone resolves), all frequencies.
AngularSpectrum directions_of(const HeightField& field) {
  const PowerSpectrum spectrum = power_spectrum(field);
  const double circle = 0.5 / std::max(field.grid().pitch_x.um(), field.grid().pitch_y.um());
  const AngularLimits limits{.most_per_um = circle};
  const double inside = angular_power_share(spectrum, limits);
  return angular_spectrum(spectrum, inside > 0.5 ? limits : AngularLimits{});
}

double strongest_deg(const AngularSpectrum& angular) {
  const auto most = std::ranges::max_element(angular.share) - angular.share.begin();
  return 180.0 / static_cast<double>(angular.share.size()) * static_cast<double>(most);
}

// Its standard error: a step's width, and how far the directions of the blocks lie from it. That is not divided by the
// root of their number: the strongest of many noisy directions is no mean, and gains little from a larger field.
Quantity texture_direction(const HeightField& field) {
  const AngularSpectrum whole = directions_of(field);
  const double degrees = strongest_deg(whole), step = 180.0 / static_cast<double>(whole.share.size());
  double squares = 0.0, blocks = 0.0;
  for (std::size_t block = 0; block < block_count; ++block) {
    const HeightField part = block_of(field, block);
    const HeightRange range = height_range(part);
    if (range.highest == range.lowest) continue;
    squares += std::pow(std::remainder(strongest_deg(directions_of(part)) - degrees, 180.0), 2);
    blocks += 1.0;
  }
  return {degrees, "°", std::sqrt(step * step / 12.0 + (blocks > 0.0 ? squares / blocks : 0.0))};
}

void require_large_enough(const HeightField& field) {
  require(field.columns() >= 16 && field.rows() >= 16, "spatial parameters need 16 x 16 samples at least");
}

}  // namespace

std::vector<Decay> decays_of(const Autocorrelation& autocorrelation) {
  std::vector<Decay> result;
  result.reserve(directions);
  for (int k = 0; k < directions; ++k)
    result.push_back(decay_along(autocorrelation, std::numbers::pi * k / directions));
  return result;
}

SpatialParameters spatial_parameters(const HeightField& field) {
  require_large_enough(field);
  return spatial_parameters(field, autocorrelation(field));
}

SpatialParameters spatial_parameters(const HeightField& field, const Autocorrelation& known) {
  require_large_enough(field);
  const Extremes found = extremes(known);
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
  result.Std = field.missing_count() == 0 ? texture_direction(field) : Quantity{nan, "°", nan};
  return result;
}

}  // namespace mezzotint
