#include "experiments/report/bsdf_page.h"

#include <algorithm>

#include <fmt/format.h>

#include "experiments/report/bsdf_components.h"

namespace mezzotint {

namespace {

std::string entry_of(const Bsdf& bsdf, const std::string& key) {
  const auto found = bsdf.provenance.find(key);
  return found == bsdf.provenance.end() ? "" : found->second;
}

bool took_paths(const Bsdf& bsdf) { return !entry_of(bsdf, "convergence").empty(); }

Verdict verdict_of(const Bsdf& bsdf, const BsdfPageOptions& options) {
  if (!took_paths(bsdf)) {
    const std::string predicted = entry_of(bsdf, "predicted_error");
    return {Outcome::Information,
            fmt::format("The model {} took no paths, so the map has no noise{}.", entry_of(bsdf, "model"),
                        predicted.empty() ? "; what it leaves out is not in its standard errors"
                                          : "; its predicted error is " + predicted)};
  }
  const std::string error =
      fmt::format("The relative standard error of the reflection is {:.2g} %", 100.0 * options.relative_error);
  if (options.tolerance <= 0.0) return {Outcome::Information, error + "; no tolerance was asked for."};
  const bool met = options.relative_error <= options.tolerance;
  return {met ? Outcome::Met : Outcome::Missed,
          fmt::format("{}, {} the tolerance of {:.3g} %.", error, met ? "within" : "above", 100.0 * options.tolerance)};
}

std::vector<KeyFigure> figures_of(const Bsdf& bsdf, const BsdfPageOptions& options) {
  const auto share = [](const char* name, const Estimate& estimate, const char* note) {
    return KeyFigure{.name = name, .quantity = {estimate.value, "1", estimate.standard_error}, .note = note};
  };
  std::vector<KeyFigure> figures = {share("albedo", bsdf.energy.reflected, "reflected share of the light"),
                                    share("transmitted", bsdf.energy.transmitted, "gone down for good")};
  KeyFigure error{.name = "relative standard error", .quantity = {options.relative_error, "1", {}}};
  if (took_paths(bsdf) && options.tolerance > 0.0) {
    error.at_most = options.tolerance;
    error.outcome = verdict_of(bsdf, options).outcome;
  }
  error.note = took_paths(bsdf) ? entry_of(bsdf, "samples") + " paths" : "no paths were needed";
  figures.push_back(error);
  return figures;
}

bool holds_light(const MapEstimate& map) {
  return std::any_of(map.mean.begin(), map.mean.end(), [](double value) { return value > 0.0; });
}

Section maps_section(const Bsdf& bsdf) {
  Section section{.title = "The maps",
                  .text =
                      "Orthographic projection: a direction (x, y, z) stands at (x, y). Point at a map for its value "
                      "and standard error."};
  const bool transmits = holds_light(bsdf.transmission);
  const Span span = transmits ? Span::Half : Span::TwoThirds;
  MapScale scale{.logarithmic = true};
  section.components.push_back(
      direction_maps({.title = "Reflection", .caption = "BRDF; upper hemisphere, seen from above.", .span = span},
                     {named_map("reflection", bsdf.grid, bsdf.reflection, bsdf.incidence)}, scale));
  if (transmits) {
    scale.label = "BTDF";
    NamedMap map = named_map("transmission", bsdf.grid, bsdf.transmission, bsdf.incidence);
    map.incidence.reset();  // the light is in the other hemisphere
    section.components.push_back(direction_maps(
        {.title = "Transmission",
         .caption = "BTDF in flux weights, without n²; lower hemisphere, seen from above, directions in the medium.",
         .span = span},
        {map}, scale));
  }
  return section;
}

Section orders_section(const Bsdf& bsdf) {
  std::vector<NamedMap> maps;
  for (std::size_t k = 0; k < bsdf.reflection_orders.size(); ++k) {
    const bool last = k + 1 == bsdf.reflection_orders.size();
    maps.push_back(named_map(fmt::format("{}{} interaction{}", k + 1, last ? " and more" : "", k == 0 ? "" : "s"),
                             bsdf.grid, bsdf.reflection_orders[k], bsdf.incidence));
  }
  return {.title = "By order of interaction",
          .text = "",
          .components = {direction_maps({.title = "Reflection by order"}, maps, {.logarithmic = true})}};
}

Section making_section(const Bsdf& bsdf, const BsdfPageOptions& options) {
  Section section{.title = "How it was made", .text = entry_of(bsdf, "choice")};
  const auto curve = convergence_chart(
      {.title = "Standard error while it was traced",
       .caption = "Of the reflection: √(Σ a·se² / Σ a·f²), a the projected solid angle of a bin. One point a pass.",
       .span = Span::Half},
      {convergence_of("reflection", bsdf)}, options.tolerance);
  if (curve) section.components.push_back(*curve);
  section.components.push_back(energy_table(
      {.title = "Energy audit", .caption = "Shares of the light that came in.", .span = Span::Half}, bsdf));
  return section;
}

}  // namespace

Report bsdf_page(const Bsdf& bsdf, const BsdfPageOptions& options) {
  Report page{
      .title = "BSDF of " + options.source,
      .subtitle = fmt::format("Light from θ = {:.4g}°, φ = {:.4g}°; {}; model {}; {} × {} bins.",
                              bsdf.incidence.theta.degrees(), bsdf.incidence.phi.degrees(), entry_of(bsdf, "material"),
                              entry_of(bsdf, "model"), bsdf.grid.width, bsdf.grid.height),
      .verdict = verdict_of(bsdf, options),
      .key_figures = figures_of(bsdf, options)};
  const std::string warnings = entry_of(bsdf, "warnings");
  if (!warnings.empty()) page.messages.push_back({MessageLevel::Warning, warnings});
  if (entry_of(bsdf, "estimator") == "slides")
    page.messages.push_back(
        {MessageLevel::Warning, "The slides' estimator does not conserve energy; for comparison only."});
  page.sections.push_back(maps_section(bsdf));
  if (!bsdf.reflection_orders.empty()) page.sections.push_back(orders_section(bsdf));
  page.sections.push_back(making_section(bsdf, options));
  page.provenance = bsdf.provenance;
  return page;
}

}  // namespace mezzotint
