#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "forward/base/error.h"
#include "forward/process/printed_relief.h"
#include "inverse/gamut/gamut.h"

namespace mezzotint {

namespace {

struct Steepest {
  double alpha = 0.0;
  Length wavelength;
};

// √2 · slope_factor · height/λ · transfer^power, the largest over a fine row of wavelengths.
Steepest steepest(const PrinterProfile& printer, const GamutBounds& bounds, double slope_factor, double power) {
  constexpr int steps = 400;
  const double least_um = bounds.least_pixels * printer.pixel_pitch.um();
  const double span = bounds.longest.um() / least_um;
  Steepest best;
  for (int i = 0; i <= steps; ++i) {
    const Length wavelength = Length::from_um(least_um * std::pow(span, static_cast<double>(i) / steps));
    const double alpha = std::numbers::sqrt2 * slope_factor * (reachable_height(printer) / wavelength) *
                         std::pow(pixel_transfer(printer, wavelength), power);
    if (alpha > best.alpha) best = {alpha, wavelength};
  }
  return best;
}

}  // namespace

GamutFormula gamut_formula(const PrinterProfile& printer, Length wavelength, const GamutBounds& bounds) {
  require(bounds.least_pixels >= 2.0 && bounds.longest.um() > bounds.least_pixels * printer.pixel_pitch.um(),
          "the longest length must exceed the shortest wavelength, which is 2 pixels or more");
  const GroundSplit ground = split_ground(printer, wavelength);
  const Steepest both = steepest(printer, bounds, std::numbers::pi / 2.0, 2.0);
  const Steepest one = steepest(printer, bounds, std::numbers::pi / std::numbers::sqrt2, 1.0);
  return {std::numbers::sqrt2 * ground_rms_slope(printer, ground.geometric),
          ground.coherent_share,
          both.alpha,
          both.wavelength,
          one.alpha,
          one.wavelength};
}

std::string in_words(const GamutFormula& formula) {
  return fmt::format(
      "α ≥ {0:.3g} (ground); α_x/α_y ≤ α_x/{0:.3g}; about α ≤ {1:.2g} on both axes (wavelength {2:.3g} µm), α_x ≤ "
      "{3:.2g} along one ({4:.3g} µm)",
      formula.floor_alpha, formula.largest_alpha, formula.at_wavelength.um(), formula.largest_alpha_one_axis,
      formula.at_wavelength_one_axis.um());
}

std::string to_string(GamutPlace place) {
  switch (place) {
    case GamutPlace::Inside:
      return "inside";
    case GamutPlace::Edge:
      return "on the edge";
    case GamutPlace::Outside:
      return "outside";
  }
  return "";
}

AlphaPair alphas_of(const SlopeAxes& slopes) {
  return {std::numbers::sqrt2 * slopes.rms_major, std::numbers::sqrt2 * slopes.rms_minor};
}

}  // namespace mezzotint
