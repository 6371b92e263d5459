#include "inverse/closed_form_start.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "forward/pattern/sparse_noise.h"
#include "forward/process/printed_relief.h"

namespace mezzotint {

namespace {

// The slopes of sparse convolution noise sit at wavelengths of about 1.3 cells.
constexpr double noise_wavelength_per_scale = 1.3;

double square(double value) { return value * value; }

// What the pattern itself must show; the ground brings the rest.
double without_ground(double rms_slope, const PrinterProfile& printer, Length wavelength) {
  const double ground = ground_rms_slope(printer, split_ground(printer, wavelength).geometric);
  return std::sqrt(std::max(square(rms_slope) - square(ground), square(0.2 * rms_slope)));
}

// Solves slope_at_unit_length / length · transfer(length) = wanted for the length, by fixed-point steps.
Length matching_length(double slope_times_um, double wanted, double wavelength_per_length,
                       const PrinterProfile& printer) {
  const Length least = 4.0 / wavelength_per_length * printer.pixel_pitch;
  Length length = Length::from_um(slope_times_um / wanted);
  for (int step = 0; step < 20; ++step) {
    const double transfer = pixel_transfer(printer, std::max(length, least) * wavelength_per_length);
    length = Length::from_um(slope_times_um * transfer / wanted);
  }
  return std::max(length, least);
}

Pattern start(Noise noise, double major, double minor, Angle rotation, const PrinterProfile& printer) {
  const double slope_times_um = noise.height.um() * std::sqrt(0.5 * noise_plane_gradient_square_at_z0);
  noise.scale = matching_length(slope_times_um, major, noise_wavelength_per_scale, printer);
  const Length across = matching_length(slope_times_um, minor, noise_wavelength_per_scale, printer);
  noise.stretch = std::clamp(across / noise.scale, 1.0, 64.0);
  noise.direction = rotation;
  return noise;
}

Pattern start(Sinusoid sinusoid, double major, double minor, Angle rotation, const PrinterProfile& printer) {
  const double slope_times_um = 0.5 * std::numbers::pi * sinusoid.height.um();
  sinusoid.wavelength_u = matching_length(slope_times_um, major, 1.0, printer);
  sinusoid.wavelength_v = matching_length(slope_times_um, minor, 1.0, printer);
  sinusoid.direction = rotation;
  return sinusoid;
}

Pattern start(Ridges ridges, double major, double, Angle rotation, const PrinterProfile& printer) {
  const double slope_times_um = ridges.height.um() / std::sqrt(ridges.skew * (1.0 - ridges.skew));
  ridges.wavelength = matching_length(slope_times_um, major, 1.0, printer);
  ridges.direction = rotation;
  return ridges;
}

}  // namespace

Pattern closed_form_start(Pattern pattern, const Target& target, const PrinterProfile& printer, Length wavelength) {
  const double major = without_ground(target.slopes.rms_major, printer, wavelength);
  const double minor = without_ground(target.slopes.rms_minor, printer, wavelength);
  return std::visit([&](auto& kind) { return start(kind, major, minor, target.slopes.rotation, printer); }, pattern);
}

}  // namespace mezzotint
