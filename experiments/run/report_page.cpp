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
  const Outcome judged = results.design.met ? Outcome::Met : Outcome::Missed;
  return {is_judged(results.target) ? judged : Outcome::Information, verdict_sentence(results.target, results.design)};
}

// Slopes are judged where they are the goal, and shown where a lobe is.
class SlopeFigures {
public:
  explicit SlopeFigures(const RunResults& results) : results_(results), judged_(!results.design.fresh_lobe_error) {}

  [[nodiscard]] KeyFigure alpha(const char* name, double value, double error, double wanted,
                                double variance_error) const {
    KeyFigure figure{.name = name, .quantity = {to_alpha * value, "1", to_alpha * error}};
    figure.outcome = outcome(std::abs(variance_error) <= results_.target.tolerance);
    figure.note = fmt::format("target {:.4g}", to_alpha * wanted);
    return figure;
  }
  [[nodiscard]] KeyFigure axis() const {
    const SlopeAxesEstimate& found = results_.design.on_fresh_draws;
    KeyFigure figure{.name = "axis of α_x"};
    figure.quantity = {found.axes.rotation.degrees(), "°", found.rotation_error.degrees()};
    figure.outcome = outcome(results_.design.fresh_error.rotation <= results_.target.rotation_tolerance);
    figure.note = fmt::format("target {:.4g}°", results_.target.slopes.rotation.degrees());
    return figure;
  }

private:
  [[nodiscard]] Outcome outcome(bool is_met) const {
    if (!judged_) return Outcome::Information;
    return is_met ? Outcome::Met : Outcome::Missed;
  }
  const RunResults& results_;
  bool judged_;
};

KeyFigure lobe_figure(const RunResults& results) {
  const Design& design = results.design;
  KeyFigure figure{.name = "cube-root error of the lobe"};
  figure.quantity = quantity_of(*design.fresh_lobe_error);
  if (is_judged(results.target)) {
    figure.at_most = results.target.tolerance;
    figure.outcome = design.met ? Outcome::Met : Outcome::Missed;
  }
  return figure;
}

KeyFigure l2_figure(const IncidenceResult& first) {
  KeyFigure figure{.name = "relative_l2 to the target"};
  figure.quantity = quantity_of(first.printed_to_target.corrected);
  figure.note = fmt::format("the pattern's own shape alone: {:.3f}", first.printed_to_own_lobe.corrected.value);
  return figure;
}

std::vector<KeyFigure> key_figures(const RunResults& results) {
  const SlopeAxesEstimate& found = results.design.on_fresh_draws;
  const SlopeAxes& wanted = results.target.slopes;
  const TargetError& error = results.design.fresh_error;
  const SlopeFigures slopes(results);
  std::vector<KeyFigure> figures;
  if (results.design.fresh_lobe_error) figures.push_back(lobe_figure(results));
  figures.push_back(
      slopes.alpha("printed α_x", found.axes.rms_major, found.rms_major_error, wanted.rms_major, error.variance_major));
  figures.push_back(
      slopes.alpha("printed α_y", found.axes.rms_minor, found.rms_minor_error, wanted.rms_minor, error.variance_minor));
  if (results.target.rotation_matters) figures.push_back(slopes.axis());
  figures.push_back(l2_figure(results.incidences.front()));
  return figures;
}

Provenance provenance(const Experiment& experiment, const RunResults& results) {
  Provenance entries = {{"program", std::string("mezzotint ") + program_version},
                        {"experiment", experiment.file.filename().string()},
                        {"printer", experiment.printer.name},
                        {"seed", std::to_string(experiment.search.minimize.seed)},
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
  if (is_ambiguous(results)) page.messages.push_back({MessageLevel::Warning, ambiguity_in_words});
  for (const auto& noisy : results.noisy_maps) page.messages.push_back({MessageLevel::Warning, noisy});
  for (const auto& warning : results.map_warnings) page.messages.push_back({MessageLevel::Warning, warning});
  page.sections = {lobe_section(experiment, results), design_section(experiment, results),
                   print_section(experiment, results), measurement_section(results),
                   assumptions_section(experiment, results)};
  page.provenance = provenance(experiment, results);
  return page;
}

}  // namespace mezzotint
