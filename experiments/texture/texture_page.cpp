#include "experiments/texture/texture_page.h"

#include <algorithm>
#include <cctype>

#include <fmt/format.h>

#include "experiments/report/components.h"
#include "experiments/texture/texture_charts.h"
#include "measurement/correction/fill.h"

namespace mezzotint {

namespace {

std::string length_in_words(Length length) {
  return length.um() >= 1000.0 ? fmt::format("{:.4g} mm", length.mm()) : fmt::format("{:.4g} µm", length.um());
}

std::string share_in_words(double share) { return share > 0.0 ? fmt::format("{:.2g} %", 100.0 * share) : "none"; }

std::string filters_in_words(const TextureRequest& request) {
  std::string text = request.levelled ? "levelled by the least-squares plane" : "not levelled";
  if (request.s_filter.um() > 0.0) text += ", S-filter " + length_in_words(request.s_filter);
  if (request.l_filter.um() > 0.0) text += ", L-filter " + length_in_words(request.l_filter);
  if (!(request.s_filter.um() > 0.0) && !(request.l_filter.um() > 0.0)) text += ", not filtered";
  return text;
}

std::string subtitle_of(const TextureFindings& found, const TextureSource& source) {
  const Grid& grid = found.field.grid();
  return fmt::format("{} × {} samples, {} × {}, {:.4g} × {:.4g} µm a sample; {}{}.", grid.columns, grid.rows,
                     length_in_words(Length::from_um(grid.pitch_x.um() * static_cast<double>(grid.columns))),
                     length_in_words(Length::from_um(grid.pitch_y.um() * static_cast<double>(grid.rows))),
                     grid.pitch_x.um(), grid.pitch_y.um(), source.format, found.field.periodic() ? ", periodic" : "");
}

Verdict verdict_of(const TextureFindings& found, const TextureRequest& request) {
  return {Outcome::Information, fmt::format("The surface is {}; samples that are missing: {}.",
                                            filters_in_words(request), share_in_words(found.missing_share()))};
}

std::vector<KeyFigure> figures_of(const TextureFindings& found) {
  std::vector<KeyFigure> figures;
  for (const TextureParameter& parameter : areal_parameters(found)) {
    const std::string& s = parameter.symbol;
    if (s != "Sa" && s != "Sq" && s != "Sdq" && s != "Sal" && s != "Str") continue;
    figures.push_back({.name = s, .quantity = parameter.quantity, .note = parameter.name});
  }
  return figures;
}

Section surface_section(const TextureFindings& found, const TextureRequest& request) {
  const std::vector<NamedRelief> reliefs = {{"heights", found.field}};
  return {.title = "The surface",
          .text = "As it was evaluated: " + filters_in_words(request) + ".",
          .components = {relief_maps({.title = "Heights", .span = Span::Half}, reliefs),
                         relief_viewer({.title = "In three dimensions", .span = Span::Half}, reliefs)}};
}

Section heights_section(const TextureFindings& found) {
  return {.title = "Height distribution", .text = "", .components = {height_histogram(found), bearing_chart(found)}};
}

// Of a surface that is neither flat nor tiny: one with an autocorrelation.
Section wavelengths_section(const TextureFindings& found) {
  const bool whole = found.field.missing_count() == 0;
  const PowerSpectrum spectrum = power_spectrum(whole ? found.field : fill_missing(found.field));
  std::string remark = found.field.periodic() ? "The field is periodic: no window." : "Hann window.";
  if (!whole)
    remark += fmt::format(" Missing samples ({}) were filled by Laplace's equation for this.",
                          share_in_words(found.missing_share()));
  Section section{.title = "Wavelengths and directions", .text = ""};
  section.components = {radial_chart(spectrum, remark), angular_chart(spectrum, remark), spectrum_map(spectrum)};
  section.components.push_back(autocorrelation_map(*found.autocorrelation));
  return section;
}

Section slopes_section(const TextureFindings& found) {
  NamedMap map{.name = "normals", .grid = found.normals.grid, .mean = found.normals.distribution};
  Section section{.title = "Slopes",
                  .text = fmt::format("The slopes of the facets that light meets, and so the microfacet normal "
                                      "distribution D(m). They hold wavelengths from {} to {}: what the instrument did "
                                      "not see has slopes too.",
                                      length_in_words(found.shortest), length_in_words(found.longest))};
  section.components.push_back(
      direction_maps({.title = "Normal distribution",
                      .caption = "Upward normals of the facets, seen from above. ∫ D(m) cosθ dm = 1.",
                      .span = Span::Third},
                     {map}, {.label = "D", .unit = "1/sr", .logarithmic = true}));
  for (nlohmann::json& chart : slope_charts(found)) section.components.push_back(std::move(chart));
  return section;
}

nlohmann::json parameter_table(const std::string& title, const std::vector<TextureParameter>& parameters,
                               Span span = Span::Half) {
  std::vector<TableRow> rows;
  for (const TextureParameter& parameter : parameters) {
    const bool has_symbol = !parameter.symbol.starts_with("slope_");
    rows.push_back({{has_symbol ? parameter.symbol : "", parameter.name, parameter.quantity}});
  }
  return table({.title = title, .span = span}, {"", "name", "value"}, rows);
}

Section profile_section(const TextureFindings& found, const TextureRequest& request) {
  const ProfileFilter& filter = request.profile_filter;
  const auto cutoff = [](Length length) { return length.um() > 0.0 ? length_in_words(length) : std::string("none"); };
  const TextureRequest::Line& line = *request.line;
  return {.title = "Profile",
          .text = fmt::format("From ({:.4g}, {:.4g}) to ({:.4g}, {:.4g}) µm; λs: {}, λc: {}; {} sampling lengths; "
                              "missing: {}.",
                              line.from.x_um, line.from.y_um, line.to.x_um, line.to.y_um, cutoff(filter.lambda_s),
                              cutoff(filter.lambda_c), found.profile->parameters.sampling_lengths,
                              share_in_words(found.profile->parameters.missing_share)),
          .components = {profile_chart(*found.profile),
                         parameter_table("Profile parameters", profile_parameters(found), Span::Third)}};
}

Section parameters_section(const TextureFindings& found) {
  const std::vector<TextureParameter> all = areal_parameters(found);
  const auto core = std::find_if(all.begin(), all.end(), [](const TextureParameter& p) { return p.symbol == "Sk"; });
  return {.title = "Parameters",
          .text =
              "ISO 25178-2, each with its standard error from leaving out one of sixteen blocks at a time. Extreme "
              "values (Sp, Sv, Sz) have none. Sdr, Smr1 and Smr2 are ratios, not per cent; volumes are per area.",
          .components = {parameter_table("Height, hybrid, spatial", {all.begin(), core}),
                         parameter_table("Functional, slopes", {core, all.end()})}};
}

void add_messages(Report& page, const TextureFindings& found, const TextureSource& source) {
  if (!source.assumption.empty())
    page.messages.push_back({MessageLevel::Warning, "Assumed: " + source.assumption + "."});
  for (std::string note : found.notes) {
    note[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(note[0])));
    page.messages.push_back({MessageLevel::Note, note + "."});
  }
}

}  // namespace

Report texture_page(const TextureFindings& found, const TextureRequest& request, const TextureSource& source) {
  Report page{.title = "Surface texture of " + source.name,
              .subtitle = subtitle_of(found, source),
              .verdict = verdict_of(found, request),
              .key_figures = figures_of(found)};
  add_messages(page, found, source);
  page.sections = {surface_section(found, request), heights_section(found)};
  if (found.autocorrelation) page.sections.push_back(wavelengths_section(found));
  page.sections.push_back(slopes_section(found));
  if (found.profile) page.sections.push_back(profile_section(found, request));
  page.sections.push_back(parameters_section(found));
  page.provenance = source.provenance;
  page.provenance["evaluation"] = filters_in_words(request);
  page.provenance["format"] = source.format;
  return page;
}

}  // namespace mezzotint
