#include "experiments/gamut/gamut_findings.h"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "forward/base/quantity.h"
#include "forward/pattern/pattern_parameters.h"

namespace mezzotint {

namespace {

using Json = nlohmann::ordered_json;

Json json_of(const AlphaPair& alpha) { return {{"alpha_x", alpha.x}, {"alpha_y", alpha.y}}; }

Json json_of(const Pattern& pattern) {
  Json json = {{"kind", kind_name(pattern)}};
  for (const PatternParameter& parameter : pattern_parameters(pattern))
    json[std::string(parameter.name)] = get_parameter(pattern, parameter.name);
  if (const auto* parts = parts_of(pattern)) {
    json["parts"] = Json::array();
    for (const PatternPart& part : *parts) json["parts"].push_back(json_of(part.pattern));
  }
  return json;
}

Json json_of(const std::vector<BorderPoint>& points, const GamutKind& kind) {
  Json list = Json::array();
  for (const BorderPoint& point : points) {
    Json json = json_of(point.alpha);
    json["relative_tolerance"] = point.tolerance;
    for (std::size_t i = 0; i < point.values.size(); ++i) {
      const GamutParameter& free = kind.free[i];
      const bool of_sum = parts_of(kind.pattern) != nullptr;
      json["parameters"][of_sum ? fmt::format("part_{}.{}", free.part, free.name) : free.name] = point.values[i];
    }
    list.push_back(json);
  }
  return list;
}

// Larger is better: reached with room, reached, near.
double merit(const GamutVerdict& verdict) {
  if (verdict.place == GamutPlace::Inside) return verdict.prints == 0 ? 3.0 : 2.0;
  return (verdict.place == GamutPlace::Edge ? 1.0 : -1.0) - 1e-3 * verdict.distance;
}

}  // namespace

const GamutVerdict& AskedTarget::best() const {
  return *std::ranges::max_element(verdicts, {}, [](const GamutVerdict& verdict) { return merit(verdict); });
}

std::string in_words(const AlphaPair& alpha) { return fmt::format("{:.4g}, {:.4g}", alpha.x, alpha.y); }

std::string parameters_in_words(const Pattern& pattern) {
  std::string text(kind_name(pattern));
  for (const PatternParameter& parameter : pattern_parameters(pattern))
    text += fmt::format(", {} = {:.4g}", parameter.name, get_parameter(pattern, parameter.name));
  if (const auto* parts = parts_of(pattern))
    for (const PatternPart& part : *parts) text += "; " + parameters_in_words(part.pattern);
  return text;
}

std::string in_words(const AskedTarget& target) {
  const GamutVerdict& best = target.best();
  if (target.is_reached()) {
    std::vector<std::string> kinds;
    for (const GamutVerdict& verdict : target.verdicts)
      if (verdict.place != GamutPlace::Outside)
        kinds.push_back(verdict.kind + (verdict.place == GamutPlace::Edge ? " (on its edge)" : ""));
    return fmt::format("α {}: can be printed, with {}", in_words(target.alpha), fmt::join(kinds, ", "));
  }
  return fmt::format("α {}: cannot be printed: {}\n  nearest: α {} with {}", in_words(target.alpha), best.why,
                     in_words(best.nearest), parameters_in_words(best.pattern));
}

Json to_json(const GamutVerdict& verdict) {
  Json json = {{"kind", verdict.kind},
               {"place", to_string(verdict.place)},
               {"why", verdict.why},
               {"by_formula", verdict.by_formula},
               {"nearest",
                {{"alpha_x", Quantity{verdict.nearest.x, "1", verdict.nearest_error * verdict.nearest.x}},
                 {"alpha_y", Quantity{verdict.nearest.y, "1", verdict.nearest_error * verdict.nearest.y}}}},
               {"covariance_distance", verdict.distance},
               {"prints", verdict.prints}};
  json["pattern"] = json_of(verdict.pattern);
  return json;
}

Json to_json(const GamutFormula& formula) {
  return {{"floor_alpha", Quantity{formula.floor_alpha, "1", {}}},
          {"coherent_share", Quantity{formula.coherent_share, "1", {}}},
          {"largest_alpha_on_both_axes", Quantity{formula.largest_alpha, "1", {}}},
          {"at_wavelength", Quantity{formula.at_wavelength.um(), "µm", {}}},
          {"largest_alpha_on_one_axis", Quantity{formula.largest_alpha_one_axis, "1", {}}},
          {"at_wavelength_on_one_axis", Quantity{formula.at_wavelength_one_axis.um(), "µm", {}}},
          {"in_words", in_words(formula)}};
}

Json to_json(const AskedTarget& target) {
  Json json = json_of(target.alpha);
  json["reached"] = target.is_reached();
  json["best_kind"] = target.best().kind;
  json["verdicts"] = Json::array();
  for (const GamutVerdict& verdict : target.verdicts) json["verdicts"].push_back(to_json(verdict));
  return json;
}

Json to_json(const GamutFindings& findings) {
  const GamutMap& map = findings.map;
  const PixelSpread& blur = findings.printer.spread;
  Json json = {{"format", "mezzotint-gamut"},
               {"version", 1},
               {"printer", findings.printer.name},
               {"blur",
                {{"kernel", kernel_name(blur.kernel)},
                 {"width", Quantity{blur.width.um(), "µm", {}}},
                 {"calibrated", blur.calibrated}}},
               {"ground_is_calibrated", findings.printer.ground_is_calibrated},
               {"wavelength", Quantity{map.options.wavelength.um() * 1e3, "nm", {}}},
               {"least_pixels", map.options.bounds.least_pixels},
               {"longest", Quantity{map.options.bounds.longest.um(), "µm", {}}},
               {"formula", to_json(map.formula)},
               {"targets", Json::array()},
               {"regions", Json::array()}};
  for (const AskedTarget& target : findings.targets) json["targets"].push_back(to_json(target));
  for (const GamutRegion& region : map.regions) {
    const GamutKind kind = gamut_kind(region.kind, findings.printer, map.options.bounds);
    Json one = {{"kind", region.kind},
                {"blur_factor", region.blur_factor},
                {"largest_relative_tolerance", region.largest_tolerance()}};
    one["most_stretched"] = json_of(region.stretched, kind);
    one["steepest"] = json_of(region.steepest, kind);
    json["regions"].push_back(one);
  }
  return json;
}

std::string to_csv(const GamutMap& map) {
  std::string text = "kind,blur_factor,border,alpha_x,alpha_y,relative_tolerance\n";
  for (const GamutRegion& region : map.regions) {
    const auto add = [&](const char* border, const std::vector<BorderPoint>& points) {
      for (const BorderPoint& point : points)
        text += fmt::format("{},{:g},{},{:.6g},{:.6g},{:.3g}\n", region.kind, region.blur_factor, border, point.alpha.x,
                            point.alpha.y, point.tolerance);
    };
    add("most_stretched", region.stretched);
    add("steepest", region.steepest);
  }
  return text;
}

}  // namespace mezzotint
