#include "experiments/run/report_page.h"

#include <cmath>

#include <fmt/format.h>

#include "experiments/version.h"

namespace mezzotint {

namespace {

const double to_alpha = std::sqrt(2.0);

std::string target_in_words(const Target& target) {
  const double alpha_x = to_alpha * target.slopes.rms_major, alpha_y = to_alpha * target.slopes.rms_minor;
  if (target.kind == "anisotropy") {
    return fmt::format("anisotropy {:.3g} : 1 at a mean α of {:.3g}", alpha_x / alpha_y, std::sqrt(alpha_x * alpha_y));
  }
  const std::string lobe =
      fmt::format("α {:.3g} × {:.3g} at {:.3g}°", alpha_x, alpha_y, target.slopes.rotation.degrees());
  return target.kind == "scan" ? "the slopes of a measured surface, " + lobe : "a Beckmann lobe, " + lobe;
}

Verdict verdict(const RunResults& results) {
  const TargetError& error = results.design.fresh_error;
  const std::string figures = fmt::format(
      "on {} draws that the search never saw, the printed slopes' variances are off by {:+.1f} % and {:+.1f} % "
      "({:.0f} % allowed){}",
      results.design.fresh_covariances.size(), 100.0 * error.variance_major, 100.0 * error.variance_minor,
      100.0 * results.target.tolerance,
      results.target.rotation_matters ? fmt::format(" and their axis by {:.2f}°", error.rotation.degrees()) : "");
  return {results.design.met ? Outcome::Met : Outcome::Missed,
          (results.design.met ? "Target met: " : "Target missed: ") + figures + "."};
}

// α's tolerance is half that of the variance, to first order.
KeyFigure alpha_figure(const char* name, double value, double error, double target, double variance_error,
                       double tolerance) {
  return {.name = name,
          .quantity = {to_alpha * value, "1", to_alpha * error},
          .outcome = std::abs(variance_error) <= tolerance ? Outcome::Met : Outcome::Missed,
          .note = fmt::format("target {:.4g}", to_alpha * target)};
}

std::vector<KeyFigure> key_figures(const RunResults& results) {
  const SlopeAxesEstimate& found = results.design.on_fresh_draws;
  const Target& target = results.target;
  const TargetError& error = results.design.fresh_error;
  std::vector<KeyFigure> figures = {alpha_figure("printed α_x", found.axes.rms_major, found.rms_major_error,
                                                 target.slopes.rms_major, error.variance_major, target.tolerance),
                                    alpha_figure("printed α_y", found.axes.rms_minor, found.rms_minor_error,
                                                 target.slopes.rms_minor, error.variance_minor, target.tolerance)};
  if (target.rotation_matters) {
    figures.push_back({.name = "axis of α_x",
                       .quantity = {found.axes.rotation.degrees(), "°", found.rotation_error.degrees()},
                       .outcome = error.rotation <= target.rotation_tolerance ? Outcome::Met : Outcome::Missed,
                       .note = fmt::format("target {:.4g}°", target.slopes.rotation.degrees())});
  }
  const IncidenceResult& first = results.incidences.front();
  figures.push_back(
      {.name = "relative_l2 to the target",
       .quantity = quantity_of(first.printed_to_target.corrected),
       .note = fmt::format("the pattern's own shape alone: {:.3f}", first.printed_to_own_lobe.corrected.value)});
  return figures;
}

Provenance provenance(const Experiment& experiment, const RunResults& results) {
  Provenance entries = {{"program", std::string("mezzotint ") + program_version},
                        {"experiment", experiment.file.filename().string()},
                        {"printer", experiment.printer.name},
                        {"seed", std::to_string(experiment.search.seed)},
                        {"settings", experiment.canonical_text}};
  for (const auto& [name, value] : results.incidences.front().printed.provenance) entries["bsdf " + name] = value;
  return entries;
}

}  // namespace

Report make_page(const Experiment& experiment, const RunResults& results) {
  Report page{.title = experiment.title,
              .subtitle = fmt::format("Target: {}. Printed as {} on {}, measured again, compared.",
                                      target_in_words(results.target), kind_name(results.design.pattern),
                                      experiment.printer.name),
              .verdict = verdict(results),
              .key_figures = key_figures(results)};
  for (const auto& warning : results.design.warnings) page.messages.push_back({MessageLevel::Warning, warning});
  page.sections = {lobe_section(experiment, results), design_section(experiment, results),
                   print_section(experiment, results), measurement_section(results),
                   assumptions_section(experiment, results)};
  page.provenance = provenance(experiment, results);
  return page;
}

}  // namespace mezzotint
