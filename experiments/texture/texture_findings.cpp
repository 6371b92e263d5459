#include "experiments/texture/texture_findings.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "measurement/correction/gaussian_filter.h"
#include "measurement/correction/plane.h"
#include "measurement/texture/texture_notes.h"

namespace mezzotint {

namespace {

using Json = nlohmann::ordered_json;

constexpr DirectionGrid normal_bins{64, 64};

void add_note(std::vector<std::string>& notes, std::string note) {
  if (!note.empty()) notes.push_back(std::move(note));
}

HeightField prepared(const HeightField& measured, const TextureRequest& request, std::vector<std::string>& notes) {
  HeightField field = request.levelled ? level(measured) : measured;
  if (request.s_filter.um() > 0.0) {
    add_note(notes, filter_warning(field, request.s_filter));
    field = s_filter(field, request.s_filter);
  }
  if (request.l_filter.um() > 0.0) {
    add_note(notes, filter_warning(field, request.l_filter));
    field = l_filter(field, request.l_filter);
  }
  return field;
}

ProfileFindings profile_findings(const HeightField& field, const TextureRequest& request) {
  const ProfileFilter& filter = request.profile_filter;
  ProfileFindings found{profile_along(field, request.line->from, request.line->to), {}, {}};
  found.parameters = profile_parameters(found.profile, filter);
  if (filter.lambda_c.um() > 0.0)
    found.mean = mean_line(filter.lambda_s.um() > 0.0 ? mean_line(found.profile, filter.lambda_s) : found.profile,
                           filter.lambda_c);
  return found;
}

std::string profile_note(const ProfileParameters& profile) {
  const bool few = profile.letter == 'R' && profile.sampling_lengths < 5;
  return fmt::format("profile over {} sampling lengths, {:.2g} % of it missing{}", profile.sampling_lengths,
                     100.0 * profile.missing_share,
                     few ? "; ISO 21920-3 takes five: Rz and the standard errors of fewer are not comparable" : "");
}

void add_notes(const HeightField& measured, const TextureFindings& found, std::vector<std::string>& notes) {
  if (found.spatial) add_note(notes, found.spatial->note);
  if (found.spatial && std::isfinite(found.spatial->Sal.value) && !std::isfinite(*found.spatial->Sal.standard_error))
    notes.emplace_back(
        "Sal and Str have no standard error: Sal is longer than a sixteenth of the field's side, so blocks of it say "
        "little; measure a larger field");
  if (found.spatial && found.field.missing_count() > 0)
    notes.emplace_back("Std needs every sample; fill the missing ones first");
  for (std::string& note : texture_notes(found.field, found.roughness, found.spatial ? &*found.spatial : nullptr))
    notes.push_back(std::move(note));
  add_note(notes, height_step_note(measured, found.roughness));
  notes.push_back(fmt::format(
      "Sdq and Sdr hold wavelengths from {:.4g} to {:.4g} µm; finer structure, which the instrument did not "
      "see, has slopes too",
      found.shortest.um(), found.longest.um()));
  if (found.profile) notes.push_back(profile_note(found.profile->parameters));
}

Json optional_length(Length length) {
  return length.um() > 0.0 ? Json(Quantity{length.um(), "µm", {}}) : Json(nullptr);
}

Json settings_json(const TextureRequest& request) {
  Json settings = {{"level", request.levelled ? "plane" : "none"},
                   {"filter", "Gaussian (ISO 16610-61; profiles: ISO 16610-21), ends by regression of the first order"},
                   {"s_filter", optional_length(request.s_filter)},
                   {"l_filter", optional_length(request.l_filter)}};
  if (!request.line) return settings;
  const auto point = [](const FieldPoint& p) {
    return Json{{"x", Quantity{p.x_um, "µm", {}}}, {"y", Quantity{p.y_um, "µm", {}}}};
  };
  settings["profile"] = {{"from", point(request.line->from)}, {"to", point(request.line->to)}};
  settings["lambda_s"] = optional_length(request.profile_filter.lambda_s);
  settings["lambda_c"] = optional_length(request.profile_filter.lambda_c);
  return settings;
}

}  // namespace

double TextureFindings::missing_share() const {
  return static_cast<double>(field.missing_count()) / static_cast<double>(field.grid().size());
}

TextureFindings texture_of(const HeightField& measured, const TextureRequest& request, const Progress& progress) {
  std::vector<std::string> notes;
  report(progress, "roughness", 0.0, "levelling and filters");
  HeightField field = prepared(measured, request, notes);
  report(progress, "roughness", 0.2, "heights and slopes");
  AreaRoughness roughness = area_roughness(field);
  FunctionalParameters functional = functional_parameters(field);
  NormalDistribution normals = normal_distribution(field, normal_bins);
  TextureFindings found{.field = std::move(field),
                        .roughness = std::move(roughness),
                        .functional = std::move(functional),
                        .autocorrelation = {},
                        .spatial = {},
                        .normals = std::move(normals),
                        .profile = {},
                        .shortest = {},
                        .longest = {},
                        .notes = std::move(notes)};
  if (found.roughness.Sq.value > 0.0 && found.field.columns() >= 16 && found.field.rows() >= 16) {
    report(progress, "roughness", 0.4, "autocorrelation and spectrum");
    found.autocorrelation = autocorrelation(found.field);
    found.spatial = spatial_parameters(found.field, *found.autocorrelation);
  }
  if (request.line) found.profile = profile_findings(found.field, request);
  found.shortest = Length::from_um(std::max(found.normals.shortest_um, request.s_filter.um()));
  const double longest = found.normals.longest_um, cut = request.l_filter.um();
  found.longest = Length::from_um(cut > 0.0 ? std::min(longest, cut) : longest);
  report(progress, "roughness", 0.9, "notes");
  add_notes(measured, found, found.notes);
  report(progress, "roughness", 1.0);
  return found;
}

std::vector<TextureParameter> areal_parameters(const TextureFindings& found) {
  const AreaRoughness& r = found.roughness;
  const FunctionalParameters& f = found.functional;
  std::vector<TextureParameter> list = {{"Sa", "arithmetical mean height", r.Sa},
                                        {"Sq", "root mean square height", r.Sq},
                                        {"Sp", "maximum peak height", r.Sp},
                                        {"Sv", "maximum pit depth", r.Sv},
                                        {"Sz", "maximum height", r.Sz},
                                        {"Ssk", "skewness", r.Ssk},
                                        {"Sku", "kurtosis", r.Sku},
                                        {"Sdq", "root mean square gradient", r.Sdq, true},
                                        {"Sdr", "developed interfacial area ratio", r.Sdr, true}};
  if (found.spatial) {
    list.push_back({"Sal", "autocorrelation length", found.spatial->Sal});
    list.push_back({"Str", "texture aspect ratio", found.spatial->Str});
    list.push_back({"Std", "texture direction", found.spatial->Std});
  }
  const std::vector<TextureParameter> functional = {{"Sk", "core height", f.Sk},
                                                    {"Spk", "reduced peak height", f.Spk},
                                                    {"Svk", "reduced pit depth", f.Svk},
                                                    {"Smr1", "material ratio of the peaks", f.Smr1},
                                                    {"Smr2", "material ratio above the pits", f.Smr2},
                                                    {"Vmp", "peak material volume", f.Vmp},
                                                    {"Vmc", "core material volume", f.Vmc},
                                                    {"Vvc", "core void volume", f.Vvc},
                                                    {"Vvv", "pit void volume", f.Vvv},
                                                    {"Sxp", "peak extreme height", f.Sxp}};
  list.insert(list.end(), functional.begin(), functional.end());
  list.push_back({"slope_kurtosis_major", "kurtosis of the steepest slopes", found.normals.kurtosis_major, true});
  list.push_back({"slope_kurtosis_minor", "kurtosis of the gentlest slopes", found.normals.kurtosis_minor, true});
  return list;
}

std::vector<TextureParameter> profile_parameters(const TextureFindings& found) {
  if (!found.profile) return {};
  const ProfileParameters& p = found.profile->parameters;
  std::vector<TextureParameter> list = {{"a", "arithmetical mean height", p.a},
                                        {"q", "root mean square height", p.q},
                                        {"z", "maximum height per section", p.z},
                                        {"t", "total height", p.t},
                                        {"p", "mean peak height", p.p},
                                        {"v", "mean pit depth", p.v},
                                        {"sk", "skewness", p.sk},
                                        {"ku", "kurtosis", p.ku},
                                        {"dq", "root mean square gradient", p.dq},
                                        {"Sm", "mean profile element spacing", p.sm}};
  for (TextureParameter& parameter : list) parameter.symbol.insert(parameter.symbol.begin(), p.letter);
  return list;
}

Json texture_json(const TextureFindings& found, const TextureRequest& request) {
  Json json;
  std::vector<TextureParameter> all = areal_parameters(found);
  const std::vector<TextureParameter> profile = profile_parameters(found);
  all.insert(all.end(), profile.begin(), profile.end());
  for (const TextureParameter& parameter : all) {
    Json entry = parameter.quantity;
    entry["name"] = parameter.name;
    if (parameter.hangs_on_bandwidth) {
      entry["shortest_wavelength"] = Quantity{found.shortest.um(), "µm", {}};
      entry["longest_wavelength"] = Quantity{found.longest.um(), "µm", {}};
    }
    json[parameter.symbol] = entry;
  }
  json["samples"] = found.roughness.samples;
  json["missing"] = found.roughness.missing;
  json["missing_share"] = Quantity{found.missing_share(), "1", {}};
  if (found.profile) {
    json["sampling_lengths"] = found.profile->parameters.sampling_lengths;
    json["profile_missing_share"] = Quantity{found.profile->parameters.missing_share, "1", {}};
  }
  json["settings"] = settings_json(request);
  json["notes"] = found.notes;
  return json;
}

}  // namespace mezzotint
