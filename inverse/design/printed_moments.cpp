#include "inverse/design/printed_moments.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "forward/pattern/line_integral_convolution.h"
#include "forward/pattern/octave_sum.h"
#include "forward/pattern/sparse_noise.h"
#include "forward/process/printed_relief.h"

namespace mezzotint {

namespace {

double square(double value) { return value * value; }

// Mean square slopes along a pattern's own axes, brought to the plane's.
SlopeCovariance along_axes(double u_square, double v_square, Angle direction) {
  const double c = std::cos(direction.radians()), s = std::sin(direction.radians());
  return {u_square * c * c + v_square * s * s, u_square * s * s + v_square * c * c, (u_square - v_square) * c * s};
}

SlopeCovariance sum(const SlopeCovariance& a, const SlopeCovariance& b) {
  return {a.xx + b.xx, a.yy + b.yy, a.xy + b.xy};
}

using Moments = std::optional<SlopeCovariance>;

template <typename Kind>
requires requires(const Kind& kind) { octave_sum(kind); }
Moments moments(const Kind& kind, const PrinterProfile& printer) {
  SlopeCovariance total;
  for (const Octave& octave : octave_sum(kind).octaves) {
    const double slope = kind.height.um() * octave.weight * octave.frequency / kind.scale.um() *
                         std::sqrt(0.5 * noise_plane_gradient_square_at_z0);
    const Length wave = kind.scale * (noise_wavelength_per_scale / octave.frequency);
    const double across = slope * pixel_transfer(printer, wave),
                 along = slope / kind.stretch * pixel_transfer(printer, wave * kind.stretch);
    total = sum(total, along_axes(square(across), square(along), kind.direction));
  }
  return total;
}

Moments moments(const LineIntegralConvolution& lines, const PrinterProfile& printer) {
  if (!lines.singularities.empty()) return {};
  const LineSlopes slopes = smeared_noise(lines.length / lines.scale);
  const double per_um = square(lines.height / lines.scale);
  const double through = square(pixel_transfer(printer, lines.scale * noise_wavelength_per_scale));
  return along_axes(per_um * slopes.across * through, per_um * slopes.along * through, lines.direction);
}

// Four waves, (±1/λ_u, ±1/λ_v): each is let through by both of its components.
Moments moments(const Sinusoid& sinusoid, const PrinterProfile& printer) {
  const double through =
      pixel_transfer(printer, sinusoid.wavelength_u) * pixel_transfer(printer, sinusoid.wavelength_v);
  const double slope = 0.5 * std::numbers::pi * sinusoid.height.um() * through;
  return along_axes(square(slope / sinusoid.wavelength_u.um()), square(slope / sinusoid.wavelength_v.um()),
                    sinusoid.direction);
}

// By its waves: the k-th has the amplitude h·|sin(π k s)|/(π² k² s(1 − s)), s the skew.
Moments moments(const Ridges& ridges, const PrinterProfile& printer) {
  constexpr int waves = 24;
  const double skew = ridges.skew, pi = std::numbers::pi;
  double mean_square = 0.0;
  for (int k = 1; k <= waves; ++k) {
    const double amplitude = ridges.height.um() * std::sin(pi * k * skew) / (square(pi * k) * skew * (1.0 - skew));
    const double slope = amplitude * 2.0 * pi * k / ridges.wavelength.um();
    mean_square += 0.5 * square(slope * pixel_transfer(printer, ridges.wavelength / k));
  }
  return along_axes(mean_square, 0.0, ridges.direction);
}

Moments of(const Pattern& pattern, const PrinterProfile& printer);

Moments moments(const PatternSum& pattern, const PrinterProfile& printer) {
  SlopeCovariance total;
  for (const PatternPart& part : pattern.parts) {
    const Moments own = of(part.pattern, printer);
    if (!own) return {};
    total = sum(total, *own);
  }
  return total;
}

Moments moments(const TurnedPattern& pattern, const PrinterProfile& printer) {
  const Moments own = of(pattern.parts.at(0).pattern, printer);
  if (!own) return {};
  SlopeAxes axes = principal_axes(*own);
  axes.rotation = axes.rotation + pattern.rotation;
  return covariance_of(axes);
}

Moments moments(const PatternProduct&, const PrinterProfile&) { return {}; }
Moments moments(const MaskedPattern&, const PrinterProfile&) { return {}; }
Moments moments(const PatternRegions&, const PrinterProfile&) { return {}; }

Moments of(const Pattern& pattern, const PrinterProfile& printer) {
  return std::visit([&](const auto& kind) { return moments(kind, printer); }, pattern);
}

}  // namespace

std::optional<SlopeCovariance> printed_moments(const Pattern& pattern, const PrinterProfile& printer,
                                               Length wavelength) {
  Moments printed = of(pattern, printer);
  if (!printed) return {};
  const double ground = ground_rms_slope(printer, split_ground(printer, wavelength).geometric);
  printed->xx += ground * ground;
  printed->yy += ground * ground;
  return printed;
}

}  // namespace mezzotint
