#include "forward/ladder/ladder.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "forward/ladder/gaussian_slopes.h"
#include "forward/optics/bsdf_warnings.h"
#include "forward/optics/microfacet.h"
#include "forward/surface/relief_warnings.h"
#include "forward/surface/slope_covariance.h"

namespace mezzotint {

namespace {

// The pilot has a path for every 64 facets, so that it costs a part of the splat, within these bounds.
constexpr std::uint64_t least_pilot = std::uint64_t{1} << 10, most_pilot = std::uint64_t{1} << 14;
// One side of a 95 % interval, as the pilot's own error is known from 8 batches (Student's t, 7 degrees of freedom).
constexpr double bound = 1.9;
constexpr double harmless_lost_light = 0.05;

PathTracingOptions tracing_options(const LadderOptions& options) {
  PathTracingOptions tracing;
  tracing.incidence = options.incidence;
  tracing.grid = options.grid;
  tracing.material = options.material;
  tracing.samples = options.most_samples;
  tracing.seed = options.seed;
  return tracing;
}

// What Smith's term takes away for good, where the surface scatters it again. A lobe of an α below 0.2 hardly loses
// any, and is too narrow for these bins.
std::vector<std::string> lost_light_warnings(const BeckmannLobe& lobe, const DirectionAngles& incidence) {
  if (std::min(lobe.alpha_x, lobe.alpha_y) < 0.2) return {};
  const DirectionGrid coarse{16, 16};
  const DirectionMap map = reflection_map(lobe, Mirror{}, incidence, coarse);
  const auto areas = projected_solid_angles(coarse);
  const double lost = 1.0 - std::inner_product(map.begin(), map.end(), areas.begin(), 0.0);
  if (lost <= harmless_lost_light) return {};
  return {
      fmt::format("masking and shadowing take {:.2g} % of the light away for good, which the surface scatters again: "
                  "the lobe is that of single reflections; --model paths follows the others",
                  100.0 * lost)};
}

// Light that comes in at a slope of cotθ, and leaves no facet at a lower one, meets nothing twice, if no facet is
// steeper.
bool nothing_can_be_met_twice(const PathTracer::ReliefFacts& facts, const DirectionAngles& incidence) {
  const double theta = incidence.theta.radians(), tilt = std::atan(facts.steepest);
  const double lowest_way_out = 0.5 * std::numbers::pi - (theta + 2.0 * tilt);
  const double way_in = 0.5 * std::numbers::pi - theta;
  return way_in > tilt && lowest_way_out > tilt;
}

std::uint64_t pilot_paths(const HeightField& field) {
  return std::clamp<std::uint64_t>(2 * field.grid().size() / 64, least_pilot, most_pilot);
}

Forecast forecast_slopes(const LadderOptions& options, std::uint64_t paths, const MapEstimate& pilot,
                         const Bsdf& slopes) {
  if (!(slopes.energy.reflected.value > 0.0)) {
    return {Rung::Slopes, 1.0, "no facet sends light straight out: all of it meets the surface again"};
  }
  const MapDifference difference = relative_l2(options.grid, pilot, slopes.reflection.mean);
  const double error = difference.corrected.value + bound * difference.corrected.standard_error;
  return {
      Rung::Slopes, error,
      fmt::format("a pilot of {} paths finds {:.2g} % (at most {:.2g} %) of the lobe changed by shadows and further "
                  "interactions",
                  paths, 100.0 * difference.corrected.value, 100.0 * error)};
}

void explain(const Choice& choice, Bsdf& bsdf) {
  std::vector<std::string> words;
  for (const Forecast& forecast : choice.forecasts) {
    words.push_back(fmt::format("{}: predicted error {:.2g} % ({})", name_of(forecast.rung), 100.0 * forecast.error,
                                forecast.reason));
  }
  bsdf.provenance["model"] = std::string(name_of(choice.rung));
  bsdf.provenance["choice"] = fmt::format("{} was chosen. {}", name_of(choice.rung), fmt::join(words, "; "));
  bsdf.provenance["predicted_error"] = fmt::format("{:.4g}", choice.forecasts.back().error);
  add_warnings(bsdf, choice.warnings);
}

}  // namespace

std::string_view name_of(Rung rung) {
  switch (rung) {
    case Rung::Moments:
      return "moments";
    case Rung::Slopes:
      return "slopes";
    case Rung::Paths:
      return "paths";
  }
  return "";
}

std::vector<std::string> geometric_optics_warnings(const PathTracer::ReliefFacts& facts, const LadderOptions& options) {
  std::vector<std::string> warnings;
  if (facts.rms_gradient <= 0.0) return warnings;
  const double wavelength_um = options.wavelength.um(), cosine = std::cos(options.incidence.theta.radians());
  // The wavelength of a ripple with this height and slope: 2π Sq/Sdq.
  const double feature_um = 2.0 * std::numbers::pi * facts.rms_height_um / facts.rms_gradient;
  const double phase = 4.0 * std::numbers::pi * facts.rms_height_um * cosine / wavelength_um;
  if (feature_um < 10.0 * wavelength_um) {
    warnings.push_back(
        fmt::format("features of {:.3g} µm are fewer than ten wavelengths of {:.3g} µm across: light is "
                    "diffracted, and rays are no model of that",
                    feature_um, wavelength_um));
  }
  if (phase < 2.0 * std::numbers::pi) {
    warnings.push_back(
        fmt::format("4π·Sq·cosθ/λ = {:.2g}: the relief is so low that part of the light (a share of {:.2g}) "
                    "stays in the mirror direction as if the surface were flat, where rays would spread it",
                    phase, std::exp(-phase * phase)));
  }
  return warnings;
}

Bsdf bsdf_from_moments(const HeightField& field, const LadderOptions& options) {
  const SlopeAxes axes = principal_axes(slope_covariance(field));
  // Beckmann's α = √2·σ; a lobe thinner than 1e-4 is a mirror's for every map.
  const auto alpha = [](double sigma) { return std::clamp(std::numbers::sqrt2 * sigma, 1e-4, 4.0); };
  const BeckmannLobe lobe{alpha(axes.rms_major), alpha(axes.rms_minor), axes.rotation};
  Bsdf bsdf{.incidence = options.incidence, .grid = options.grid};
  const DirectionMap map = reflection_map(lobe, options.material, options.incidence, options.grid);
  const DirectionMap none(options.grid.size(), 0.0);
  bsdf.reflection = {map, none, map, map};
  bsdf.transmission = {none, none, none, none};
  const auto areas = projected_solid_angles(options.grid);
  bsdf.energy.reflected.value = std::inner_product(map.begin(), map.end(), areas.begin(), 0.0);
  bsdf.energy.cut_off.value = 1.0 - bsdf.energy.reflected.value;
  bsdf.provenance = {{"model", "moments"},
                     {"material", to_string(options.material)},
                     {"lobe", fmt::format("Beckmann {:.6g} × {:.6g} at {:.4g}°, height-correlated Smith, single "
                                          "reflection; what it does not reflect is listed as cut off",
                                          lobe.alpha_x, lobe.alpha_y, lobe.rotation.degrees())}};
  add_warnings(bsdf, relief_warnings(field));
  add_warnings(bsdf, gaussian_slopes_warnings(field));
  add_warnings(bsdf, lost_light_warnings(lobe, options.incidence));
  add_warnings(bsdf, map_warnings(bsdf));
  return bsdf;
}

Bsdf simulate_auto(const HeightField& field, PathTracer& tracer, const LadderOptions& options, const Progress& progress,
                   Choice* out) {
  Choice choice;
  const PathTracer::ReliefFacts facts = tracer.facts();
  choice.warnings = geometric_optics_warnings(facts, options);
  PathTracingOptions tracing = tracing_options(options);
  const double steepness = facts.rms_gradient * std::tan(options.incidence.theta.radians());
  const auto finish = [&](Bsdf&& bsdf) {
    choice.rung = choice.forecasts.back().rung;
    explain(choice, bsdf);
    if (out != nullptr) *out = choice;
    return std::move(bsdf);
  };
  if (field.periodic() && steepness < control_variate_limit) {
    Bsdf slopes = tracer.splat(tracing);
    if (nothing_can_be_met_twice(facts, options.incidence)) {
      choice.forecasts.push_back({Rung::Slopes, 0.0,
                                  fmt::format("no facet is steeper than {:.3g}: no light can be shadowed or meet the "
                                              "surface twice",
                                              facts.steepest)});
      return finish(std::move(slopes));
    }
    PathTracingOptions pilot = tracing;
    pilot.samples = pilot_paths(field);
    const Bsdf first = tracer.trace(pilot);
    const Forecast forecast = forecast_slopes(options, pilot.samples, first.reflection, slopes);
    choice.forecasts.push_back(forecast);
    if (forecast.error <= options.tolerance) return finish(std::move(slopes));
  }
  tracing.tolerance = options.tolerance;
  Bsdf paths = tracer.trace(tracing, progress);
  const double error = relative_error(options.grid, paths.reflection);
  const char* reason = field.periodic() ? "its own standard error"
                                        : "its own standard error; a patch that is no period of "
                                          "a pattern is always traced";
  choice.forecasts.push_back({Rung::Paths, error, reason});
  return finish(std::move(paths));
}

}  // namespace mezzotint
