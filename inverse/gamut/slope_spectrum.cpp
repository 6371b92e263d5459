#include "inverse/gamut/slope_spectrum.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "forward/base/error.h"
#include "forward/pattern/line_integral_convolution.h"
#include "forward/pattern/noise_spectrum.h"
#include "forward/pattern/octave_sum.h"
#include "forward/pattern/sparse_noise.h"

namespace mezzotint {

namespace {

constexpr double pi = std::numbers::pi;

double square(double value) { return value * value; }

double sinc_square(double x) {
  const double phase = pi * x;
  return std::abs(phase) < 1e-6 ? 1.0 : square(std::sin(phase) / phase);
}

// What becomes of the squared slopes of a wave with frequencies f_u, f_v (a µm).
struct Filter {
  double pitch_um, width_um;
  bool prints, gaussian;

  // Of one axis alone, on slopes along it and on slopes across it.
  [[nodiscard]] double along(double f) const { return sinc_square(pitch_um * f) * blur(f); }
  [[nodiscard]] double across(double f) const { return prints ? along(f) : 1.0; }
  [[nodiscard]] bool is_separable() const { return gaussian || !prints || width_um == 0.0; }
  // What does not split into axes.
  [[nodiscard]] double radial(double f_u, double f_v) const {
    return is_separable() ? 1.0 : std::exp(-4.0 * pi * width_um * std::hypot(f_u, f_v));
  }

private:
  [[nodiscard]] double blur(double f) const {
    return prints && gaussian ? std::exp(-square(2.0 * pi * width_um * f)) : 1.0;
  }
};

// Waves of noise of unit lattice, in one quadrant; dense at long waves, where smeared noise has its power.
struct NoiseWaves {
  static constexpr std::size_t count = 36;
  static constexpr double highest = 4.5;  // cycles a cell; beyond lies 1e-4 of the slopes
  std::array<double, count> frequency{};
  std::array<std::array<double, count>, count> power{};  // [v][u]; sums to the variance on the lattice plane

  NoiseWaves() {
    std::array<double, count> width{};
    for (std::size_t i = 0; i < count; ++i) {
      const double t = (static_cast<double>(i) + 0.5) / count;
      frequency[i] = highest * t * t;
      width[i] = 2.0 * highest * t / count;
    }
    double sum = 0.0;
    for (std::size_t v = 0; v < count; ++v)
      for (std::size_t u = 0; u < count; ++u)
        sum += power[v][u] = noise_spectral_density(frequency[u], frequency[v]) * width[u] * width[v];
    for (auto& row : power)
      for (double& value : row) value *= noise_variance_at_z0 / sum;
  }
};

const NoiseWaves& noise_waves() {
  static const NoiseWaves waves;
  return waves;
}

/// Noise of unit height on cells of its own.
struct NoiseCells {
  double scale_u_um, scale_v_um;
  double smear = 0.0;  // along v, in cells; the deviation stays that of the noise
};

/// Mean square slopes: filtered, and as they are, by the same sum.
struct FilteredSquares {
  AxisSquares filtered, plain;
};

FilteredSquares noise_slopes(const NoiseCells& cells, const Filter& filter) {
  constexpr std::size_t n = NoiseWaves::count;
  const NoiseWaves& waves = noise_waves();
  std::array<double, n> along_u{}, along_v{}, across_u{}, across_v{}, kept{}, slope_u{}, slope_v{};
  for (std::size_t i = 0; i < n; ++i) {
    const double f_u = waves.frequency[i] / cells.scale_u_um, f_v = waves.frequency[i] / cells.scale_v_um;
    along_u[i] = filter.along(f_u);
    along_v[i] = filter.along(f_v);
    across_u[i] = filter.across(f_u);
    across_v[i] = filter.across(f_v);
    slope_u[i] = square(2.0 * pi * f_u);
    slope_v[i] = square(2.0 * pi * f_v);
    kept[i] = sinc_square(waves.frequency[i] * cells.smear);
  }
  FilteredSquares sum;
  double variance = 0.0;
  const bool separable = filter.is_separable();
  for (std::size_t v = 0; v < n; ++v) {
    for (std::size_t u = 0; u < n; ++u) {
      const double power = waves.power[v][u] * kept[v];
      const double radial =
          separable ? 1.0 : filter.radial(waves.frequency[u] / cells.scale_u_um, waves.frequency[v] / cells.scale_v_um);
      variance += power;
      sum.plain.u += power * slope_u[u];
      sum.plain.v += power * slope_v[v];
      sum.filtered.u += power * radial * slope_u[u] * along_u[u] * across_v[v];
      sum.filtered.v += power * radial * slope_v[v] * along_v[v] * across_u[u];
    }
  }
  const double factor = noise_variance_at_z0 / variance;
  for (AxisSquares* squares : {&sum.filtered, &sum.plain}) {
    squares->u *= factor;
    squares->v *= factor;
  }
  return sum;
}

template <typename Kind>
requires requires(const Kind& kind) { octave_sum(kind); }
AxisSquares slopes(const Kind& kind, const Filter& filter) {
  const OctaveSum octaves = octave_sum(kind);
  require(!octaves.absolute, "turbulence has no slope spectrum in closed form: its valleys are sharp");
  AxisSquares sum;
  for (const Octave& octave : octaves.octaves) {
    const double scale_um = kind.scale.um() / octave.frequency, power = square(kind.height.um() * octave.weight);
    const AxisSquares own = noise_slopes({scale_um, scale_um * kind.stretch}, filter).filtered;
    sum.u += power * own.u;
    sum.v += power * own.v;
  }
  return sum;
}

// Slopes of smeared noise between unit lengths of 0.01 and 100, by a table: its quadrature takes longer than a search
// can wait.
LineSlopes tabled_lines(double length) {
  constexpr double least = 0.01, most = 100.0;
  constexpr std::size_t steps = 120;
  static const std::vector<LineSlopes> table = [] {
    std::vector<LineSlopes> list;
    for (std::size_t i = 0; i <= steps; ++i)
      list.push_back(smeared_noise(least * std::pow(most / least, static_cast<double>(i) / steps)));
    return list;
  }();
  const double place = steps * std::log(std::clamp(length, least, most) / least) / std::log(most / least);
  const auto below = std::min(static_cast<std::size_t>(place), steps - 1);
  const double share = place - static_cast<double>(below);
  const LineSlopes &a = table[below], &b = table[below + 1];
  return {a.across + share * (b.across - a.across), a.along + share * (b.along - a.along)};
}

// The waves say what a filter keeps of the slopes; how steep long lines are they sum too coarsely to say.
AxisSquares slopes(const LineIntegralConvolution& lines, const Filter& filter) {
  require(lines.singularities.empty(), "slopes about singularities depend on the place");
  const double scale_um = lines.scale.um(), smear = lines.length / lines.scale;
  const FilteredSquares squares = noise_slopes({scale_um, scale_um, smear}, filter);
  const LineSlopes own = tabled_lines(smear);
  const double power = square(lines.height.um() / scale_um);
  return {power * own.across * squares.filtered.u / squares.plain.u,
          power * own.along * squares.filtered.v / squares.plain.v};
}

// Two plane waves of amplitude height/4, at (f_u, ±f_v).
AxisSquares slopes(const Sinusoid& sinusoid, const Filter& filter) {
  const double f_u = 1.0 / sinusoid.wavelength_u.um(), f_v = 1.0 / sinusoid.wavelength_v.um();
  const double power = square(sinusoid.height.um()) / 16.0 * filter.radial(f_u, f_v);
  return {power * square(2.0 * pi * f_u) * filter.along(f_u) * filter.across(f_v),
          power * square(2.0 * pi * f_v) * filter.along(f_v) * filter.across(f_u)};
}

// The slopes are a rectangular wave: the n-th harmonic has the power 2 (jump · sin(πns)/(πn))².
AxisSquares slopes(const Ridges& ridges, const Filter& filter) {
  constexpr int harmonics = 40;
  const double jump = ridges.height / ridges.wavelength / (ridges.skew * (1.0 - ridges.skew));
  double sum = 0.0;
  for (int n = 1; n <= harmonics; ++n) {
    const double f = n / ridges.wavelength.um();
    sum += 2.0 * square(jump * std::sin(pi * n * ridges.skew) / (pi * n)) * filter.along(f) * filter.radial(f, 0.0);
  }
  return {sum, 0.0};
}

AxisSquares slopes_of(const Pattern& pattern, const Filter& filter);

AxisSquares slopes(const PatternSum& pattern, const Filter& filter) {
  AxisSquares sum;
  for (const PatternPart& part : pattern.parts) {
    const AxisSquares own = slopes_of(part.pattern, filter);
    sum.u += own.u;
    sum.v += own.v;
  }
  return sum;
}

template <typename Kind>
concept WithSpectrum = requires(const Kind& kind, const Filter& filter) {
  slopes(kind, filter);
};

AxisSquares slopes_of(const Pattern& pattern, const Filter& filter) {
  return std::visit(
      [&](const auto& kind) -> AxisSquares {
        if constexpr (WithSpectrum<std::decay_t<decltype(kind)>>) return slopes(kind, filter);
        throw InvalidInput("a pattern of kind \"" + std::string(kind_name(pattern)) +
                           "\" has no slope spectrum in closed form");
      },
      pattern);
}

}  // namespace

AxisSquares linear_print_slopes(const Pattern& pattern, const PrinterProfile& printer) {
  return slopes_of(pattern, {printer.pixel_pitch.um(), printer.spread.width.um(), true,
                             printer.spread.kernel == PixelSpread::Kernel::Gaussian});
}

AxisSquares pixel_difference_slopes(const Pattern& pattern, const PrinterProfile& printer) {
  return slopes_of(pattern, {printer.pixel_pitch.um(), 0.0, false, true});
}

}  // namespace mezzotint
