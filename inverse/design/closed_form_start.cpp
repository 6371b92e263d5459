#include "inverse/design/closed_form_start.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "forward/pattern/line_integral_convolution.h"
#include "forward/pattern/octave_sum.h"
#include "forward/pattern/sparse_noise.h"
#include "forward/process/printed_relief.h"
#include "inverse/design/printed_moments.h"

namespace mezzotint {

namespace {

double square(double value) { return value * value; }

// What the pattern itself must show; the ground brings the rest.
double without_ground(double rms_slope, const PrinterProfile& printer, Length wavelength) {
  const double ground = ground_rms_slope(printer, split_ground(printer, wavelength).geometric);
  return std::sqrt(std::max(square(rms_slope) - square(ground), square(0.2 * rms_slope)));
}

// A part of a pattern's slopes, in proportion to a length that is sought.
struct SlopeTerm {
  double slope_times_um;         ///< RMS slope times the length
  double wavelength_per_length;  ///< where the slopes sit
};

// Solves √Σ (slope_times_um / length · transfer)² = wanted for the length, by fixed-point steps. The first term is the
// coarsest.
Length matching_length(const std::vector<SlopeTerm>& terms, double wanted, const PrinterProfile& printer) {
  const Length least = 4.0 / terms.front().wavelength_per_length * printer.pixel_pitch;
  Length length;
  for (int step = 0; step <= 20; ++step) {
    double sum = 0.0;
    for (const SlopeTerm& term : terms) {
      const double transfer =
          step == 0 ? 1.0 : pixel_transfer(printer, std::max(length, least) * term.wavelength_per_length);
      sum += square(term.slope_times_um * transfer);
    }
    length = Length::from_um(std::sqrt(sum) / wanted);
  }
  return std::max(length, least);
}

// Noise and its sums of octaves.
template <typename Kind>
requires requires(const Kind& kind) { octave_sum(kind); }
Pattern start(Kind kind, double major, double minor, Angle rotation, const PrinterProfile& printer) {
  std::vector<SlopeTerm> terms;
  for (const Octave& octave : octave_sum(kind).octaves) {
    terms.push_back(
        {kind.height.um() * octave.weight * octave.frequency * std::sqrt(0.5 * noise_plane_gradient_square_at_z0),
         noise_wavelength_per_scale / octave.frequency});
  }
  kind.scale = matching_length(terms, major, printer);
  kind.stretch = std::clamp(matching_length(terms, minor, printer) / kind.scale, 1.0, 64.0);
  kind.direction = rotation;
  return kind;
}

// The lines are as long as the two slopes ask for: their ratio grows with length/scale.
Pattern start(LineIntegralConvolution lines, double major, double minor, Angle rotation,
              const PrinterProfile& printer) {
  double low = 0.05, high = 200.0;
  for (int step = 0; step < 30; ++step) {
    const double middle = std::sqrt(low * high);
    const LineSlopes slopes = smeared_noise(middle);
    (slopes.across * square(minor) < slopes.along * square(major) ? low : high) = middle;
  }
  const double across = std::sqrt(smeared_noise(low).across);
  lines.scale = matching_length({{lines.height.um() * across, noise_wavelength_per_scale}}, major, printer);
  lines.length = low * lines.scale;
  lines.direction = rotation;
  return lines;
}

Pattern start(Sinusoid sinusoid, double major, double minor, Angle rotation, const PrinterProfile& printer) {
  const double slope_times_um = 0.5 * std::numbers::pi * sinusoid.height.um();
  sinusoid.wavelength_u = matching_length({{slope_times_um, 1.0}}, major, printer);
  sinusoid.wavelength_v = matching_length({{slope_times_um, 1.0}}, minor, printer);
  sinusoid.direction = rotation;
  return sinusoid;
}

Pattern start(Ridges ridges, double major, double, Angle rotation, const PrinterProfile& printer) {
  const double slope_times_um = ridges.height.um() / std::sqrt(ridges.skew * (1.0 - ridges.skew));
  ridges.wavelength = matching_length({{slope_times_um, 1.0}}, major, printer);
  ridges.direction = rotation;
  return ridges;
}

// A composition begins as it is.
template <typename Kind>
requires requires(const Kind& kind) { kind.parts; }
Pattern start(const Kind& kind, double, double, Angle, const PrinterProfile&) { return kind; }

}  // namespace

Pattern closed_form_start(Pattern pattern, const Target& target, const PrinterProfile& printer, Length wavelength) {
  const double major = without_ground(target.slopes.rms_major, printer, wavelength);
  const double minor = without_ground(target.slopes.rms_minor, printer, wavelength);
  return std::visit([&](auto& kind) { return start(kind, major, minor, target.slopes.rotation, printer); }, pattern);
}

}  // namespace mezzotint
