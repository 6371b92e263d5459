#include "measurement/pattern_fit/line_start.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <utility>
#include <vector>

#include "measurement/texture/power_spectrum.h"

namespace mezzotint {

namespace {

constexpr double pi = std::numbers::pi;

struct Wave {
  double x_per_um, y_per_um;
};

double magnitude(const Wave& wave) { return std::hypot(wave.x_per_um, wave.y_per_um); }

// The place of a parabola's top through ln of three densities, from the middle one.
double top(double left, double middle, double right) {
  const double a = std::log(left + 1e-300), b = std::log(middle + 1e-300), c = std::log(right + 1e-300);
  const double bend = a - 2.0 * b + c;
  return bend < 0.0 ? std::clamp(0.5 * (a - c) / bend, -0.5, 0.5) : 0.0;
}

// The highest peak whose place and mirror image lie more than four bins from `but`.
Wave peak(const PowerSpectrum& s, const Wave* but) {
  const double step_x = 1.0 / (static_cast<double>(s.columns) * s.pitch_x.um());
  const double step_y = 1.0 / (static_cast<double>(s.rows) * s.pitch_y.um());
  const auto at = [&s](std::size_t column, std::size_t row) { return s.density_um4[row * s.columns + column]; };
  double highest = 0.0;
  Wave best{0.0, 0.0};
  for (std::size_t row = 1; row + 1 < s.rows; ++row)
    for (std::size_t column = s.columns / 2; column + 1 < s.columns; ++column) {
      const double x = s.frequency_x_per_um(column), y = s.frequency_y_per_um(row);
      if (at(column, row) <= highest || std::max(std::abs(x) / step_x, std::abs(y) / step_y) < 1.5) continue;
      if (but != nullptr) {
        const double away = std::max(std::abs(x - but->x_per_um) / step_x, std::abs(y - but->y_per_um) / step_y);
        const double mirrored = std::max(std::abs(x + but->x_per_um) / step_x, std::abs(y + but->y_per_um) / step_y);
        if (std::min(away, mirrored) <= 4.0) continue;
      }
      highest = at(column, row);
      best = {x + step_x * top(at(column - 1, row), highest, at(column + 1, row)),
              y + step_y * top(at(column, row - 1), highest, at(column, row + 1))};
    }
  return best;
}

// 2/n Σ z exp(−2πi k·x): twice the complex amplitude of a wave.
std::complex<double> amplitude(const HeightField& field, const Wave& k) {
  std::complex<double> sum = 0.0;
  double count = 0.0;
  for (std::size_t row = 0; row < field.rows(); ++row)
    for (std::size_t column = 0; column < field.columns(); ++column) {
      const double z = field.at(column, row);
      if (std::isnan(z)) continue;
      const double turns = k.x_per_um * static_cast<double>(column) * field.grid().pitch_x.um() +
                           k.y_per_um * static_cast<double>(row) * field.grid().pitch_y.um();
      sum += z * std::polar(1.0, -2.0 * pi * turns);
      count += 1.0;
    }
  return 2.0 * sum / count;
}

// sin u sin v = ½ cos(u − v) − ½ cos(u + v).
LineNumbers sinusoid_start(const HeightField& field, const Wave& difference, const Wave& sum) {
  const std::complex<double> minus = amplitude(field, difference), plus = -amplitude(field, sum);
  const Wave u{0.5 * (sum.x_per_um + difference.x_per_um), 0.5 * (sum.y_per_um + difference.y_per_um)};
  const Wave v{0.5 * (sum.x_per_um - difference.x_per_um), 0.5 * (sum.y_per_um - difference.y_per_um)};
  LineNumbers n;
  n.waves_u_per_um = magnitude(u);
  n.direction = std::atan2(u.y_per_um, u.x_per_um);
  // v runs a quarter turn ahead of u, or the other way.
  const double sense = u.x_per_um * v.y_per_um - u.y_per_um * v.x_per_um > 0.0 ? 1.0 : -1.0;
  n.waves_v_per_um = sense * magnitude(v);
  n.phase_u = (std::arg(plus) + std::arg(minus)) / (4.0 * pi);
  n.phase_v = (std::arg(plus) - std::arg(minus)) / (4.0 * pi);
  n.height_um = 2.0 * (std::abs(plus) + std::abs(minus));
  return n;
}

// The mean profile across the crests shows where they are.
LineNumbers ridges_start(const HeightField& field, const Wave& wave) {
  constexpr std::size_t bins = 64;
  std::vector<double> sum(bins), count(bins);
  for (std::size_t row = 0; row < field.rows(); ++row)
    for (std::size_t column = 0; column < field.columns(); ++column) {
      const double z = field.at(column, row);
      if (std::isnan(z)) continue;
      const double u = wave.x_per_um * static_cast<double>(column) * field.grid().pitch_x.um() +
                       wave.y_per_um * static_cast<double>(row) * field.grid().pitch_y.um();
      const auto bin = std::min(static_cast<std::size_t>((u - std::floor(u)) * bins), bins - 1);
      sum[bin] += z;
      count[bin] += 1.0;
    }
  std::size_t low = 0, high = 0;
  for (std::size_t k = 0; k < bins; ++k) {
    sum[k] /= std::max(1.0, count[k]);
    if (sum[k] < sum[low]) low = k;
    if (sum[k] > sum[high]) high = k;
  }
  LineNumbers n;
  n.waves_u_per_um = magnitude(wave);
  n.direction = std::atan2(wave.y_per_um, wave.x_per_um);
  n.height_um = sum[high] - sum[low];
  n.phase_u = -(static_cast<double>(low) + 0.5) / bins;
  n.skew = std::clamp(static_cast<double>((high + bins - low) % bins) / bins, 0.05, 0.95);
  n.offset_um = sum[low];
  return n;
}

}  // namespace

std::optional<LineNumbers> line_start(LineKind kind, const HeightField& whole) {
  const PowerSpectrum spectrum = power_spectrum(whole);
  const Wave first = peak(spectrum, nullptr);
  if (magnitude(first) == 0.0) return {};
  if (kind == LineKind::Ridges) return ridges_start(whole, first);
  const Wave second = peak(spectrum, &first);
  // Crossed waves of a sinusoid are equally long.
  if (!(std::abs(magnitude(second) / magnitude(first) - 1.0) < 0.2)) return {};
  LineNumbers n = sinusoid_start(whole, first, second);
  n.offset_um = -0.5 * n.height_um;
  return n;
}

}  // namespace mezzotint
