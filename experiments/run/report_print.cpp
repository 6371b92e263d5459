#include <cmath>

#include <fmt/format.h>

#include "experiments/report/charts.h"
#include "experiments/report/components.h"
#include "experiments/run/report_page.h"

namespace mezzotint {

namespace {

Quantity quantity_from(const nlohmann::ordered_json& json) {
  const auto number = [](const nlohmann::ordered_json& value) {
    return value.is_number() ? value.get<double>() : std::nan("");
  };
  Quantity quantity{number(json.at("value")), json.at("unit"), {}};
  if (json.contains("standard_error")) quantity.standard_error = number(json["standard_error"]);
  return quantity;
}

nlohmann::json registration_table(const nlohmann::ordered_json& registration) {
  std::vector<TableRow> rows;
  for (const char* name : {"shift_x", "shift_y", "rotation"})
    rows.push_back({{name, quantity_from(registration.at(name))}});
  for (const char* name : {"correlation", "runner_up", "overlap"}) {
    rows.push_back({{name, fmt::format("{:.4f}", registration.at(name).get<double>())}});
  }
  return table(
      {.title = "Where the measurement lies on the design",
       .caption =
           "`runner_up` is the correlation of the next best placement: near `correlation`, the placement is ambiguous.",
       .span = Span::Half},
      {"", "value"}, rows);
}

nlohmann::json roughness_table(const nlohmann::ordered_json& comparison) {
  std::vector<TableRow> rows;
  for (const char* name : {"Sa", "Sq", "Sz", "Ssk", "Sku", "Sdq", "Sdr"}) {
    TableRow row{{name}};
    for (const char* surface : {"design", "printed", "measured"}) {
      row.cells.emplace_back(quantity_from(comparison.at("roughness").at(surface).at(name)));
    }
    rows.push_back(row);
  }
  return table({.title = "Roughness side by side",
                .caption = "ISO 25178-2 on the common area, levelled; standard errors by block jackknife (Sz is an "
                           "extreme value and has none).",
                .span = Span::Half},
               {"", "design", "printed", "measured"}, rows);
}

nlohmann::json bsdf_table(const RunResults& results) {
  std::vector<TableRow> rows;
  for (const auto& r : results.incidences) {
    rows.push_back(
        {{fmt::format("θ = {:.0f}°, φ = {:.0f}°", r.incidence.theta.degrees(), r.incidence.phi.degrees()),
          quantity_of(r.measured_to_predicted.corrected), Quantity{r.measured_to_predicted.floor, "1", {}}}});
  }
  return table({.title = "BRDF: measured against predicted",
                .caption = "`relative_l2` of the two traced maps, corrected for noise, and the floor that Monte Carlo "
                           "noise alone would give. The prediction has another draw of the printer's ground noise.",
                .span = Span::Half},
               {"light from", "relative_l2", "noise floor"}, rows);
}

nlohmann::json bsdf_maps(const IncidenceResult& r) {
  const NamedMap predicted = named_map("predicted", r.predicted.grid, r.predicted.reflection, r.incidence);
  const NamedMap measured = named_map("measured again", r.measured.grid, r.measured.reflection, r.incidence);
  return direction_maps({.title = "BRDF of the prediction and of the measured print"},
                        {predicted, measured, difference_map("measured − predicted", measured, predicted)});
}

}  // namespace

Section print_section(const Experiment& experiment, const RunResults& results) {
  Section section{
      .title = "The print",
      .text = fmt::format(
          "One patch of {0} × {0} pixels ({1:.2f} mm), printed by the virtual printer from the archive `job.uvj`: "
          "{2} base layers and one layer of gray.",
          experiment.patch.pixels, static_cast<double>(experiment.patch.pixels) * experiment.printer.pixel_pitch.mm(),
          experiment.print.base_layers)};
  const std::vector<NamedRelief> patch = {{"design", results.design_relief},
                                          {"printed", results.printed_relief},
                                          {"measured again", results.measured_relief}};
  std::vector<NamedRelief> all = patch;
  if (results.target_relief) all.push_back({"target (scan)", *results.target_relief});
  section.components.push_back(relief_viewer({.title = "The relief"}, all));
  section.components.push_back(relief_maps({.title = "Heights"}, patch));
  return section;
}

Section measurement_section(const RunResults& results) {
  const Quantity rms = quantity_from(results.comparison.at("residual").at("Sq"));
  Section section{
      .title = "The measurement",
      .text = fmt::format(
          "The print was measured by a simulated profilometer that places it askew, adds noise and misses samples; "
          "then "
          "it was registered to the design. What is left differs from the design by {:.3f} µm RMS: the printer's "
          "ground, the instrument, and what the process model does not know.",
          rms.value)};
  section.components = {registration_table(results.comparison.at("registration")), roughness_table(results.comparison),
                        relief_maps({.title = "Residual: measured − design", .span = Span::Half},
                                    {{"residual", results.residual_relief}}),
                        bsdf_table(results), bsdf_maps(results.incidences.front())};
  return section;
}

Section assumptions_section(const Experiment& experiment, const RunResults& results) {
  const PrinterProfile& printer = experiment.printer;
  const bool gaussian = printer.spread.kernel == PixelSpread::Kernel::Gaussian;
  std::vector<Message> list;
  list.push_back(
      {printer.spread.calibrated ? MessageLevel::Note : MessageLevel::Warning,
       fmt::format("Blur of the projector: {}, {} = {:.2f} µm ({:.2f} pixel), {}. It decides what can "
                   "be reached more than "
                   "anything else.",
                   gaussian ? "Gaussian" : "Lorentzian", gaussian ? "σ" : "half width", printer.spread.width.um(),
                   printer.spread.width / printer.pixel_pitch, printer.spread.calibrated ? "calibrated" : "assumed")});
  list.push_back({printer.ground_is_calibrated ? MessageLevel::Note : MessageLevel::Warning,
                  fmt::format("Ground noise of the printer: amplitude {:.2f} µm, {}.", printer.ground_amplitude.um(),
                              printer.ground_is_calibrated ? "calibrated" : "assumed")});
  list.push_back(
      {MessageLevel::Note, fmt::format("Octaves of the ground that are too low to be geometry at {:.0f} nm are left "
                                       "out of the relief; they leave {:.1f} % of "
                                       "the light unscattered and spread the rest.",
                                       1e3 * experiment.simulation.wavelength.um(), 100.0 * results.coherent_share)});
  list.push_back(
      {MessageLevel::Note, "Geometric optics, unpolarised: Fresnel is that of natural light at every bounce."});
  return {.title = "What this rests on", .text = "", .components = {messages(list)}};
}

}  // namespace mezzotint
