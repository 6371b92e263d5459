#include "experiments/run/design_page.h"

#include <cmath>

#include <fmt/format.h>

#include "experiments/run/search_free_form.h"
#include "experiments/version.h"
#include "forward/pattern/pattern_parameters.h"
#include "measurement/formats/surface_file.h"

namespace mezzotint {

namespace {

const double to_alpha = std::sqrt(2.0);

std::vector<Bsdf> read_lobes(const RunFolder& folder, const char* name) {
  std::vector<Bsdf> lobes;
  for (std::size_t i = 0; std::filesystem::exists(folder / fmt::format("{}_{}.exr", name, i)); ++i)
    lobes.push_back(read_exr(folder / fmt::format("{}_{}.exr", name, i)));
  return lobes;
}

Outcome outcome_of(const DesignResults& results) {
  if (!is_judged(results.target)) return Outcome::Information;
  return results.json.at("met").get<bool>() ? Outcome::Met : Outcome::Missed;
}

KeyFigure slope_figure(const char* name, double value, double error, double wanted) {
  KeyFigure figure{.name = name, .quantity = {to_alpha * value, "1", to_alpha * error}};
  figure.note = fmt::format("target {:.4g}", to_alpha * wanted);
  return figure;
}

std::vector<KeyFigure> key_figures(const DesignResults& results) {
  std::vector<KeyFigure> figures;
  const auto& json = results.json;
  if (json.contains("fresh_lobe_error")) {
    KeyFigure lobe{.name = "cube-root error of the lobe"};
    lobe.quantity = {json["fresh_lobe_error"][0], "1", json["fresh_lobe_error"][1].get<double>()};
    if (is_judged(results.target)) lobe.at_most = results.target.tolerance;
    lobe.outcome = outcome_of(results);
    figures.push_back(lobe);
  }
  if (results.design) {
    const SlopeAxesEstimate& found = results.design->on_fresh_draws;
    const SlopeAxes& wanted = results.target.slopes;
    figures.push_back(slope_figure("printed α_x", found.axes.rms_major, found.rms_major_error, wanted.rms_major));
    figures.push_back(slope_figure("printed α_y", found.axes.rms_minor, found.rms_minor_error, wanted.rms_minor));
    KeyFigure ratio{.name = "held-out ÷ trained", .quantity = {results.design->held_out_ratio, "1", {}}};
    ratio.note = results.design->held_out_ratio > 1.3 ? "above 1.3: it fitted its own draws" : "at most 1.3 wanted";
    figures.push_back(ratio);
  }
  KeyFigure gray{.name = "gray levels used"};
  gray.quantity = {json.at("gray").at("levels_used").get<double>(), "1", {}};
  figures.push_back(gray);
  return figures;
}

}  // namespace

DesignResults load_design(const Experiment& experiment, const RunFolder& folder) {
  (void)experiment;
  DesignResults results{.target = target_from_json(read_json(folder / "target.json")),
                        .json = read_json(folder / "design.json"),
                        .relief = read_gwy(folder / "relief.gwy").field};
  if (results.json.contains("free_form")) {
    results.traced = verification_from_json(results.json["traced"]);
    results.verdict = free_form_verdict(results.json);
  } else {
    results.design = design_from_json(results.json);
    results.traced = results.design->traced;
    results.verdict = verdict_sentence(results.target, *results.design);
  }
  results.predicted = read_lobes(folder, "predicted");
  results.wanted = read_lobes(folder, "target");
  return results;
}

Report design_page(const Experiment& experiment, const DesignResults& results) {
  const std::string kind = results.design ? std::string(kind_name(results.design->pattern)) : "a free form";
  Report page{
      .title = experiment.title,
      .subtitle = fmt::format("A design for {}: {}, α {:.3g} × {:.3g}.", experiment.printer.name, kind,
                              to_alpha * results.target.slopes.rms_major, to_alpha * results.target.slopes.rms_minor),
      .verdict = {outcome_of(results), results.verdict},
      .key_figures = key_figures(results)};
  for (const auto& warning : results.json.at("warnings"))
    page.messages.push_back({MessageLevel::Warning, warning.get<std::string>()});
  page.sections = {reach_section(results), residual_section(results)};
  if (results.design) page.sections.push_back(certainty_section(results));
  page.sections.push_back(course_section(results));
  page.sections.push_back(layer_section(results));
  page.sections.push_back(blur_section(results));
  page.provenance = {{"program", std::string("mezzotint ") + program_version},
                     {"experiment", experiment.file.filename().string()},
                     {"printer", experiment.printer.name},
                     {"seed", std::to_string(experiment.search.minimize.seed)},
                     {"settings", experiment.canonical_text}};
  return page;
}

}  // namespace mezzotint
