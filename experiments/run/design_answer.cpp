#include "experiments/run/design_answer.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "experiments/run/gray_file.h"
#include "experiments/run/run_results.h"
#include "experiments/version.h"
#include "forward/optics/bsdf.h"
#include "forward/pattern/pattern_parameters.h"
#include "measurement/formats/surface_file.h"

namespace mezzotint {

namespace {

using Json = nlohmann::ordered_json;

const double to_alpha = std::sqrt(2.0);

// Nothing is said of the light below the surface.
Bsdf lobe_file(const LobeTarget& goal, std::size_t light, MapEstimate reflection) {
  const DirectionMap none(goal.grid.grid().size());
  Bsdf bsdf{.incidence = goal.incidences[light], .grid = goal.grid.grid(), .reflection = std::move(reflection)};
  bsdf.transmission = {none, none, none, none, {}, {}};
  bsdf.provenance = {{"program", std::string("mezzotint ") + program_version},
                     {"bins", "soft: quadratic B-splines three bins wide"},
                     {"transmission", "not recorded"}};
  return bsdf;
}

Bsdf predicted_file(const LobeTarget& goal, std::size_t light, const Verification& traced) {
  const MeanLobe& lobe = traced.traced.lobes.at(light);
  Bsdf bsdf = lobe_file(goal, light, {lobe.mean, lobe.standard_error, lobe.half_a, lobe.half_b, {}, {}});
  bsdf.energy = traced.energy.at(light);
  bsdf.provenance["model"] = "paths";
  bsdf.provenance["draws"] = fmt::format("mean over {} printed draws, halves of every other one", traced.seeds.size());
  return bsdf;
}

Bsdf target_file(const LobeTarget& goal, std::size_t light, const Verification& traced) {
  const DirectionMap& map = goal.maps.at(light);
  Bsdf bsdf = lobe_file(goal, light, {map, DirectionMap(map.size()), map, map, {}, {}});
  bsdf.energy.reflected = {traced.wanted_light.at(light), 0.0};
  bsdf.provenance["model"] = "target";
  return bsdf;
}

Json axes_to_json(const SlopeAxesEstimate& e) {
  return {{"alpha_x", Quantity{to_alpha * e.axes.rms_major, "1", to_alpha * e.rms_major_error}},
          {"alpha_y", Quantity{to_alpha * e.axes.rms_minor, "1", to_alpha * e.rms_minor_error}},
          {"rotation", Quantity{e.axes.rotation.degrees(), "°", e.rotation_error.degrees()}}};
}

void add_distances(Json& json, const LobeJudgement& judgement) {
  for (const JudgedDistance& d : judgement.distances) {
    Json one = Quantity{d.root.value, "1", d.root.standard_error};
    one["floor"] = std::isfinite(d.root_floor) ? Json(d.root_floor) : Json(nullptr);
    json[std::string(root_name_of(d.distance))] = std::move(one);
  }
}

}  // namespace

std::vector<std::string> write_lobes(const StageContext& context, const LobeTarget& goal, const Verification& traced) {
  std::vector<std::string> names;
  for (std::size_t light = 0; light < goal.incidences.size(); ++light) {
    names.push_back(fmt::format("predicted_{}.exr", light));
    write_exr(predicted_file(goal, light, traced), context.folder / names.back());
    names.push_back(fmt::format("target_{}.exr", light));
    write_exr(target_file(goal, light, traced), context.folder / names.back());
  }
  return names;
}

Json write_layer(const StageContext& context, const GrayImage& gray, const HeightField& relief) {
  const int levels = context.experiment.printer.gray_levels;
  const GrayFigures figures = write_gray_png(gray, levels, context.folder / "gray.png");
  write_gwy(relief, "relief", {{"model", "process model, one draw of the ground"}}, context.folder / "relief.gwy");
  return {{"file", "gray.png"},        {"columns", gray.columns},
          {"rows", gray.rows},         {"bits", figures.bits},
          {"first_line", "largest y"}, {"pixel_pitch", Quantity{context.experiment.printer.pixel_pitch.um(), "µm", {}}},
          {"printer_levels", levels},  {"levels_used", figures.levels_used},
          {"relief", "relief.gwy"}};
}

Json to_json(const PrinterProfile& printer, const std::vector<BlurredPrint>& prints) {
  Json json = {{"kernel", kernel_name(printer.spread.kernel)},
               {"width", Quantity{printer.spread.width.um(), "µm", {}}},
               {"calibrated", printer.spread.calibrated},
               {"prints", Json::array()}};
  for (const BlurredPrint& print : prints) {
    Json one = {{"factor", print.factor}, {"width", Quantity{print.width.um(), "µm", {}}}};
    one["slope_covariance"] = {print.covariance.xx, print.covariance.yy, print.covariance.xy};
    one.update(axes_to_json(print.slopes));
    one["lowered"] = print.lowered;
    json["prints"].push_back(std::move(one));
  }
  return json;
}

Json figures_to_json(const Verification& traced) {
  Json json;
  add_distances(json["traced"], traced.traced);
  add_distances(json["by_slope_of_the_traced"], traced.by_slope);
  json["traced"]["reflected"] = Json::array();
  for (const Estimate& light : traced.traced.reflected)
    json["traced"]["reflected"].push_back(Quantity{light.value, "1", light.standard_error});
  return json;
}

Json figures_to_json(const Design& design) {
  Json json = {{"search_draws", axes_to_json(design.on_search_draws)},
               {"fresh_draws", axes_to_json(design.on_fresh_draws)}};
  if (design.on_search_lobes) add_distances(json["search_draws"], *design.on_search_lobes);
  if (design.on_fresh_lobes) add_distances(json["fresh_draws"], *design.on_fresh_lobes);
  if (design.traced) json.update(figures_to_json(*design.traced));
  return json;
}

AxisSwap axis_swap(const Design& design) {
  const auto axis = std::ranges::find_if(design.variables, is_axis);
  AxisSwap swap{.is_free = axis != design.variables.end()};
  if (!swap.is_free) return swap;
  const auto index = static_cast<std::size_t>(axis - design.variables.begin());
  const Angle found = Angle::from_degrees(design.search.values[index]);
  double turned = HUGE_VAL, others = HUGE_VAL;
  for (const DesignStep& step : design.search.history) {
    if (step.stage != "scan" || !std::isfinite(step.step.objective)) continue;
    const Angle away = axis_difference(Angle::from_degrees(step.step.values[index]), found);
    double& best = away > Angle::from_degrees(60.0) ? turned : others;
    best = std::min(best, step.step.objective);
  }
  swap.was_tried = std::isfinite(turned) && std::isfinite(others);
  if (swap.was_tried) swap.worse_by = std::sqrt(turned / std::max(others, 1e-300));
  return swap;
}

double shortest_length_px(const Pattern& pattern, const PrinterProfile& printer) {
  double shortest_um = HUGE_VAL;
  for (const auto& parameter : all_parameters(pattern)) {
    const std::string_view name = parameter.name;
    if (name.ends_with("scale_um") || name.find("wavelength") != std::string_view::npos)
      shortest_um = std::min(shortest_um, get_parameter(pattern, parameter.name));
  }
  return shortest_um / printer.pixel_pitch.um();
}

}  // namespace mezzotint
