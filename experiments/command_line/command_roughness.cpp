#include <cmath>
#include <optional>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "experiments/command_line/command.h"
#include "experiments/command_line/option_checks.h"
#include "experiments/command_line/surface_arguments.h"
#include "forward/base/quantity.h"
#include "measurement/correction/gaussian_filter.h"
#include "measurement/correction/plane.h"
#include "measurement/texture/functional_parameters.h"
#include "measurement/texture/normal_distribution.h"
#include "measurement/texture/profile.h"
#include "measurement/texture/roughness.h"
#include "measurement/texture/spatial_parameters.h"
#include "measurement/texture/texture_notes.h"

namespace mezzotint {

namespace {

using Json = nlohmann::ordered_json;

struct Arguments : SurfaceArguments {
  std::string level = "plane";
  double s_filter = 0.0, l_filter = 0.0, lambda_s = 0.0, lambda_c = 0.0;
  std::vector<double> profile;
};

/// Parameters in the order in which they are printed, with what else must be known.
struct Findings {
  std::vector<std::pair<std::string, Quantity>> parameters;
  std::vector<std::string> notes;

  void add_note(std::string note) {
    if (!note.empty()) notes.push_back(std::move(note));
  }
};

HeightField prepared(const Arguments& arguments, const HeightField& measured, Findings& found) {
  HeightField field = arguments.level == "plane" ? level(measured) : measured;
  const Length shortest = Length::from_um(arguments.s_filter), longest = Length::from_um(arguments.l_filter);
  if (shortest.um() > 0.0) {
    found.add_note(filter_warning(field, shortest));
    field = s_filter(field, shortest);
  }
  if (longest.um() > 0.0) {
    found.add_note(filter_warning(field, longest));
    field = l_filter(field, longest);
  }
  return field;
}

void add_areal(const HeightField& measured, const HeightField& field, Findings& found) {
  const AreaRoughness r = area_roughness(field);
  found.parameters = {{"Sa", r.Sa},   {"Sq", r.Sq},   {"Sz", r.Sz},  {"Ssk", r.Ssk},
                      {"Sku", r.Sku}, {"Sdq", r.Sdq}, {"Sdr", r.Sdr}};
  const FunctionalParameters f = functional_parameters(field);
  for (const auto& [name, q] : {std::pair{"Sk", f.Sk},
                                {"Spk", f.Spk},
                                {"Svk", f.Svk},
                                {"Smr1", f.Smr1},
                                {"Smr2", f.Smr2},
                                {"Vmp", f.Vmp},
                                {"Vmc", f.Vmc},
                                {"Vvc", f.Vvc},
                                {"Vvv", f.Vvv},
                                {"Sxp", f.Sxp}})
    found.parameters.emplace_back(name, q);
  std::optional<SpatialParameters> spatial;
  if (r.Sq.value > 0.0 && field.columns() >= 16 && field.rows() >= 16) {
    const SpatialParameters& s = spatial.emplace(spatial_parameters(field));
    for (const auto& [name, q] : {std::pair{"Sal", s.Sal}, {"Str", s.Str}, {"Std", s.Std}})
      found.parameters.emplace_back(name, q);
    found.add_note(s.note);
    if (field.missing_count() > 0) found.notes.push_back("Std needs every sample; fill the missing ones first");
  }
  for (std::string& note : texture_notes(field, r, spatial ? &*spatial : nullptr)) found.add_note(std::move(note));
  found.add_note(height_step_note(measured, r));
}

// Which wavelengths the slopes hold.
void add_bandwidth(const Arguments& arguments, const HeightField& field, Findings& found) {
  const NormalDistribution d = normal_distribution(field, {16, 16});
  const double shortest = std::max(d.shortest_um, arguments.s_filter);
  const double longest = arguments.l_filter > 0.0 ? std::min(d.longest_um, arguments.l_filter) : d.longest_um;
  found.notes.push_back(fmt::format(
      "Sdq and Sdr hold wavelengths from {:.4g} to {:.4g} um; finer structure, which the instrument did not see, has "
      "slopes too",
      shortest, longest));
  found.parameters.emplace_back("slope_kurtosis_major", Quantity{d.kurtosis_major, "1", {}});
  found.parameters.emplace_back("slope_kurtosis_minor", Quantity{d.kurtosis_minor, "1", {}});
}

void add_profile(const Arguments& arguments, const HeightField& field, Findings& found) {
  const auto& p = arguments.profile;
  const ProfileFilter filter{Length::from_um(arguments.lambda_s), Length::from_um(arguments.lambda_c)};
  const ProfileParameters r = profile_parameters(profile_along(field, {p[0], p[1]}, {p[2], p[3]}), filter);
  const std::string letter(1, r.letter);
  for (const auto& [name, q] : {std::pair{"a", r.a},
                                {"q", r.q},
                                {"z", r.z},
                                {"t", r.t},
                                {"p", r.p},
                                {"v", r.v},
                                {"sk", r.sk},
                                {"ku", r.ku},
                                {"dq", r.dq},
                                {"Sm", r.sm}})
    found.parameters.emplace_back(letter + name, q);
  const bool few = r.letter == 'R' && r.sampling_lengths < 5;
  found.add_note(fmt::format(
      "profile over {} sampling lengths, {:.2g} % of it missing{}", r.sampling_lengths, 100.0 * r.missing_share,
      few ? "; ISO 21920-3 takes five: Rz and the standard errors of fewer are not comparable" : ""));
}

std::string in_words(const Findings& found) {
  std::string text;
  for (const auto& [name, q] : found.parameters) {
    const bool known = q.standard_error && std::isfinite(*q.standard_error);
    const std::string error = known ? fmt::format(" ± {:.2g}", *q.standard_error) : "";
    const std::string value = std::isfinite(q.value) ? fmt::format("{:.6g}", q.value) : "undefined";
    text += fmt::format("{:<20} {:>12}{} {}\n", name, value, error, q.unit == "1" ? "" : q.unit);
  }
  for (const std::string& note : found.notes) text += note + "\n";
  return text;
}

}  // namespace

Command add_roughness(CLI::App& program) {
  auto* app = program.add_subcommand(
      "roughness", "Areal parameters of ISO 25178-2 and profile parameters, each with its standard error");
  auto arguments = std::make_shared<Arguments>();
  add_surface_input(*app, "SCAN", *arguments);
  app->add_option("--level", arguments->level, "plane (default) or none")->check(CLI::IsMember({"plane", "none"}));
  const auto wavelength = [app](const char* name, double& value, const char* help) {
    return app->add_option(name, value, help)->check(in_range(1e-3, 1e6));
  };
  wavelength("--s-filter", arguments->s_filter, "Remove wavelengths shorter than this, in um (ISO 16610-61)");
  wavelength("--l-filter", arguments->l_filter, "Remove wavelengths longer than this, in um");
  auto* profile = app->add_option("--profile", arguments->profile, "X0,Y0,X1,Y1 in um: parameters along this line too")
                      ->delimiter(',')
                      ->expected(4);
  wavelength("--lambda-s", arguments->lambda_s, "Of the profile: remove shorter wavelengths, in um")->needs(profile);
  wavelength("--lambda-c", arguments->lambda_c, "Of the profile: roughness is shorter than this, in um")
      ->needs(profile);
  return {app, [arguments](const CommandContext& context) {
            const SurfaceFile surface = arguments->read();
            Findings found;
            const HeightField field = prepared(*arguments, surface.field, found);
            add_areal(surface.field, field, found);
            add_bandwidth(*arguments, field, found);
            if (!arguments->profile.empty()) add_profile(*arguments, field, found);
            Json json;
            for (const auto& [name, q] : found.parameters) json[name] = q;
            const std::size_t missing = field.missing_count();
            json["samples"] = field.grid().size() - missing;
            json["missing"] = missing;
            json["level"] = arguments->level;
            json["s_filter"] = Quantity{arguments->s_filter, "µm", {}};
            json["l_filter"] = Quantity{arguments->l_filter, "µm", {}};
            json["notes"] = found.notes;
            json["assumption"] = surface.assumption;
            const std::string assumed = surface.assumption.empty() ? "" : "\nassumed: " + surface.assumption;
            context.print(json, in_words(found) +
                                    fmt::format("{} samples, {} of them missing", field.grid().size(), missing) +
                                    assumed);
            return ExitStatus::Done;
          }};
}

}  // namespace mezzotint
