#include "experiments/run/run_results.h"

#include <cmath>

#include <fmt/format.h>

#include "experiments/run/patch.h"
#include "experiments/run/simulate.h"
#include "experiments/version.h"
#include "forward/optics/bsdf_warnings.h"
#include "measurement/correction/correction.h"
#include "measurement/formats/surface_file.h"

namespace mezzotint {

namespace {

using Json = nlohmann::ordered_json;

Bsdf read_map(const RunFolder& folder, const char* name, std::size_t incidence) {
  return read_exr(folder / fmt::format("bsdf_{}_{}.exr", name, incidence));
}

// An anisotropy leaves the direction open: its lobe is compared at the direction that was printed.
SlopeAxes wanted_slopes(const Target& target, const SlopeAxes& printed) {
  SlopeAxes wanted = target.slopes;
  if (target.kind == "anisotropy") wanted.rotation = printed.rotation;
  return wanted;
}

IncidenceResult load_incidence(const Experiment& experiment, const RunFolder& folder, const RunResults& results,
                               std::size_t index) {
  IncidenceResult r;
  r.incidence = experiment.simulation.incidences[index];
  r.predicted = read_map(folder, "predicted", index);
  r.printed = read_map(folder, "printed", index);
  r.measured = read_map(folder, "measured", index);
  if (results.target_relief) r.traced_target = read_map(folder, "target", index);
  const DirectionGrid& grid = r.printed.grid;
  const auto lobe = [&](const SlopeAxes& slopes) {
    return reflection_map(lobe_of(slopes), experiment.simulation.material, r.incidence, grid);
  };
  r.target_lobe = lobe(wanted_slopes(results.target, results.printed_slopes));
  r.own_lobe = lobe(results.printed_slopes);
  r.printed_to_target = r.traced_target ? relative_l2(grid, r.printed.reflection, r.traced_target->reflection)
                                        : relative_l2(grid, r.printed.reflection, r.target_lobe);
  if (r.traced_target) r.target_to_its_lobe = relative_l2(grid, r.traced_target->reflection, r.target_lobe);
  r.printed_to_own_lobe = relative_l2(grid, r.printed.reflection, r.own_lobe);
  r.own_lobe_to_target_lobe = relative_l2(grid, r.own_lobe, r.target_lobe);
  r.measured_to_predicted = relative_l2(grid, r.measured.reflection, r.predicted.reflection);
  return r;
}

void note_if_noisy(const Experiment& experiment, const char* name, const IncidenceResult& r, const Bsdf& bsdf,
                   std::vector<std::string>& noisy) {
  const double error = relative_error(bsdf.grid, bsdf.reflection);
  if (error <= experiment.simulation.tolerance) return;
  noisy.push_back(fmt::format(
      "the BSDF of the {} surface at θ = {:.3g}°, φ = {:.3g}° has a relative standard error of "
      "{:.3g}; {:.3g} was asked for: raise [simulation] samples",
      name, r.incidence.theta.degrees(), r.incidence.phi.degrees(), error, experiment.simulation.tolerance));
}

// What a BSDF warns of, with its surface and direction of the light.
void note_warnings(const char* name, const IncidenceResult& r, const Bsdf& bsdf, std::vector<std::string>& warnings) {
  for (const std::string& sentence : warnings_of(bsdf.provenance)) {
    if (sentence.starts_with("the tolerance of ")) continue;  // note_if_noisy says it, and what setting mends it
    warnings.push_back(fmt::format("the BSDF of the {} surface at θ = {:.3g}°, φ = {:.3g}°: {}", name,
                                   r.incidence.theta.degrees(), r.incidence.phi.degrees(), sentence));
  }
}

Json figure(double value, const char* unit, double standard_error) { return Quantity{value, unit, standard_error}; }

Json slopes_summary(const SlopeAxesEstimate& estimate) {
  const double to_alpha = std::sqrt(2.0);
  return {{"alpha_x", figure(to_alpha * estimate.axes.rms_major, "1", to_alpha * estimate.rms_major_error)},
          {"alpha_y", figure(to_alpha * estimate.axes.rms_minor, "1", to_alpha * estimate.rms_minor_error)},
          {"rotation", figure(estimate.axes.rotation.degrees(), "°", estimate.rotation_error.degrees())}};
}

// A figure that is what it is: a target, or what one print came to.
Json exact(double value, const char* unit) { return Quantity{value, unit, {}}; }

Json exact_slopes(const SlopeAxes& axes) {
  const double to_alpha = std::sqrt(2.0);
  return {{"alpha_x", exact(to_alpha * axes.rms_major, "1")},
          {"alpha_y", exact(to_alpha * axes.rms_minor, "1")},
          {"rotation", exact(axes.rotation.degrees(), "°")}};
}

// The variances' relative errors are twice those of the slopes; the slopes carry the standard errors.
Json error_summary(const TargetError& error, const SlopeAxesEstimate* estimate) {
  Json summary = {{"relative_variance_major", exact(error.variance_major, "1")},
                  {"relative_variance_minor", exact(error.variance_minor, "1")},
                  {"rotation", exact(error.rotation.degrees(), "°")}};
  if (estimate != nullptr) {
    const SlopeAxesEstimate& e = *estimate;
    const auto twice = [](double sigma, double value) { return 2.0 * sigma / value; };
    summary["relative_variance_major"]["standard_error"] =
        (1.0 + error.variance_major) * twice(e.rms_major_error, e.axes.rms_major);
    summary["relative_variance_minor"]["standard_error"] =
        (1.0 + error.variance_minor) * twice(e.rms_minor_error, e.axes.rms_minor);
    summary["rotation"]["standard_error"] = e.rotation_error.degrees();
  }
  return summary;
}

Json lobe_error_summary(const Design& design) {
  return design.fresh_lobe_error ? Json(quantity_of(*design.fresh_lobe_error)) : Json(nullptr);
}

Json difference_summary(const MapDifference& difference) {
  return {{"relative_l2", quantity_of(difference.corrected)},
          {"relative_l2_with_noise", difference.plain},
          {"monte_carlo_floor", difference.floor}};
}

Json incidence_summary(const IncidenceResult& r) {
  return {{"incidence_deg", {r.incidence.theta.degrees(), r.incidence.phi.degrees()}},
          {"albedo_printed", quantity_of(r.printed.energy.reflected)},
          {"albedo_measured", quantity_of(r.measured.energy.reflected)},
          {"printed_to_target", difference_summary(r.printed_to_target)},
          {"target_to_beckmann_of_its_own_slopes",
           r.target_to_its_lobe ? difference_summary(*r.target_to_its_lobe) : Json(nullptr)},
          {"printed_to_beckmann_of_its_own_slopes", difference_summary(r.printed_to_own_lobe)},
          {"beckmann_of_its_own_slopes_to_target_lobe", {{"relative_l2", exact(r.own_lobe_to_target_lobe, "1")}}},
          {"measured_to_predicted", difference_summary(r.measured_to_predicted)}};
}

}  // namespace

Quantity quantity_of(const Estimate& estimate) { return {estimate.value, "1", estimate.standard_error}; }

bool is_ambiguous(const RunResults& results) {
  const Json& registration = results.comparison.at("registration");
  return registration.at("runner_up").get<double>() > registration.at("correlation").get<double>() - ambiguity_margin;
}

RunResults load_results(const Experiment& experiment, const RunFolder& folder) {
  const auto relief = [&](const char* file) { return read_gwy(folder / file).field; };
  RunResults results{.target = target_from_json(read_json(folder / "target.json")),
                     .design = design_from_json(read_json(folder / "design.json")),
                     .comparison = read_json(folder / "comparison.json"),
                     .design_relief = relief("design.gwy"),
                     .printed_relief = level(inner_patch_of_picture(relief("printed.gwy"), experiment)),
                     .measured_relief = relief("registered.gwy"),
                     .residual_relief = relief("residual.gwy")};
  if (experiment.target.kind == "scan") results.target_relief = relief("target.gwy");
  const SlopeCovariance printed = slope_covariance(results.printed_relief);
  results.printed_slopes = principal_axes(printed);
  results.printed_error = target_error(printed, results.target);
  results.coherent_share = split_ground(experiment.printer, experiment.simulation.wavelength).coherent_share;
  for (std::size_t i = 0; i < experiment.simulation.incidences.size(); ++i) {
    results.incidences.push_back(load_incidence(experiment, folder, results, i));
    const IncidenceResult& r = results.incidences.back();
    const auto note = [&](const char* name, const Bsdf& bsdf) {
      note_if_noisy(experiment, name, r, bsdf, results.noisy_maps);
      note_warnings(name, r, bsdf, results.map_warnings);
    };
    note("predicted", r.predicted);
    note("printed", r.printed);
    note("measured", r.measured);
    if (r.traced_target) note("target", *r.traced_target);
  }
  return results;
}

nlohmann::ordered_json summarize(const Experiment& experiment, const RunResults& results) {
  Json target = exact_slopes(results.target.slopes);
  target["kind"] = results.target.kind;
  target["tolerance"] = to_json(results.target).at("tolerance");
  Json print = exact_slopes(results.printed_slopes);
  print["error"] = error_summary(results.printed_error, nullptr);
  Json summary = {{"experiment", experiment.name},
                  {"program", std::string("mezzotint ") + program_version},
                  {"met", is_judged(results.target) ? Json(results.design.met) : Json(nullptr)},
                  {"simulation_tolerance_met", results.noisy_maps.empty()},
                  {"verdict", verdict_sentence(results.target, results.design)},
                  {"target", target},
                  {"fresh_draws", slopes_summary(results.design.on_fresh_draws)},
                  {"fresh_draws_error", error_summary(results.design.fresh_error, &results.design.on_fresh_draws)},
                  {"fresh_draws_cube_root_error", lobe_error_summary(results.design)},
                  {"this_print", print},
                  {"ground_coherent_share", results.coherent_share},
                  {"comparison", results.comparison},
                  {"warnings", results.design.warnings}};
  for (const auto& noisy : results.noisy_maps) summary["warnings"].push_back(noisy);
  for (const auto& warning : results.map_warnings) summary["warnings"].push_back(warning);
  if (is_ambiguous(results)) summary["warnings"].push_back(ambiguity_in_words);
  for (const auto& incidence : results.incidences) summary["bsdf"].push_back(incidence_summary(incidence));
  return summary;
}

}  // namespace mezzotint
