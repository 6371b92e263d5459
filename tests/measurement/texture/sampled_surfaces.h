#pragma once

#include <cmath>
#include <numbers>
#include <string>

#include "measurement/texture/functional_parameters.h"
#include "measurement/texture/normal_distribution.h"
#include "measurement/texture/roughness.h"
#include "measurement/texture/spatial_parameters.h"
#include "tests/measurement/relief.h"
#include "tests/measurement/texture/closed_forms.h"

/// Formulae, sampled, and all areal parameters of the samples.

namespace mezzotint::test {

inline constexpr double pi = std::numbers::pi;
inline constexpr double side_um = 64.0;

inline Parameters parameters_of(const HeightField& field) {
  const AreaRoughness r = area_roughness(field);
  const FunctionalParameters f = functional_parameters(field);
  Parameters p = {{"Sa", r.Sa.value},   {"Sq", r.Sq.value},   {"Sz", r.Sz.value},     {"Ssk", r.Ssk.value},
                  {"Sku", r.Sku.value}, {"Sdq", r.Sdq.value}, {"Sdr", r.Sdr.value},   {"Sk", f.Sk.value},
                  {"Spk", f.Spk.value}, {"Svk", f.Svk.value}, {"Smr1", f.Smr1.value}, {"Smr2", f.Smr2.value},
                  {"Vmp", f.Vmp.value}, {"Vmc", f.Vmc.value}, {"Vvc", f.Vvc.value},   {"Vvv", f.Vvv.value},
                  {"Sxp", f.Sxp.value}};
  if (!(r.Sq.value > 0.0)) return p;
  const SpatialParameters s = spatial_parameters(field);
  const NormalDistribution d = normal_distribution(field, {16, 16});
  p["Sal"] = s.Sal.value;
  p["Str"] = s.Str.value;
  p["Std"] = s.Std.value;
  p["slope kurtosis"] = d.kurtosis_major.value;
  return p;
}

/// n samples a wave of side_um along x (u in [0, 1)), the same in sixteen rows of 1 µm.
template <class Height>
std::function<Parameters(std::size_t)> along_x(const Height& height_um, double shift = 0.0) {
  return [=](std::size_t n) {
    const Grid grid{n, 16, Length::from_um(side_um / static_cast<double>(n)), Length::from_um(1.0)};
    return parameters_of(field_of(
        grid, [&](double c, double) { return height_um((c + shift) / static_cast<double>(n)); },
        Continuation::Periodic));
  };
}

/// The same askew: three waves along x, four along y, on n × (n + 1) samples of a tile. No two samples then have the
/// same phase, and all n (n + 1) phases are evenly spaced: heights are known as well as n² samples allow.
inline constexpr double askew_waves = 5.0;
template <class Height>
std::function<Parameters(std::size_t)> askew(const Height& height_um) {
  return [=](std::size_t n) {
    const auto columns = static_cast<double>(n), rows = columns + 1.0;
    const Grid grid{n, n + 1, Length::from_um(side_um / columns), Length::from_um(side_um / rows)};
    // A quarter of a step aside, so that the flanks of a wave do not share their heights.
    const double aside = 0.25 / (columns * rows);
    return parameters_of(field_of(
        grid,
        [&](double c, double r) {
          const double phase = 3.0 * c / columns + 4.0 * r / rows + aside;
          return height_um(phase - std::floor(phase));
        },
        Continuation::Periodic));
  };
}

/// n × n samples of a tile, u and v in [−½, ½), aside of its middle by a part of a sample.
template <class Height>
std::function<Parameters(std::size_t)> over_tile(const Height& height_um, double aside_u = 0.0, double aside_v = 0.0) {
  return [=](std::size_t n) {
    const auto count = static_cast<double>(n);
    const Length pitch = Length::from_um(side_um / count);
    return parameters_of(field_of(
        Grid{n, n, pitch, pitch},
        [&](double c, double r) { return height_um((c + aside_u) / count - 0.5, (r + aside_v) / count - 0.5); },
        Continuation::Periodic));
  };
}

inline const Known no_skewness = exact("Ssk", 0.0, 1.0);
inline const char* const whole_degrees = "directions come in steps of 1°";
inline const char* const steps = "the stretch is sought in steps of 1e-4 of material ratio";
inline const char* const rim = "the rim of a circle falls between samples, each time elsewhere";
inline const char* const tail = "the middles of n² equal shares leave out the tail beyond the outermost";

inline Known exact_of(const char* name, double value) { return exact(name, value); }
inline auto figures_of_each(double figures, const char* why) {
  return [=](const char* name, double value) { return to_figures(name, value, figures, why); };
}

}  // namespace mezzotint::test
