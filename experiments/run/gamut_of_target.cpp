#include "experiments/run/gamut_of_target.h"

#include <algorithm>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace mezzotint {

namespace {

// A sum of ridges, a sinusoid and perhaps noise has a name of its own in the gamut.
std::string kind_in_the_gamut(const PatternSpecification& specification) {
  if (specification.free_form) return "free_form";
  const auto* sum = std::get_if<PatternSum>(&specification.pattern);
  if (sum == nullptr) return std::string(kind_name(specification.pattern));
  std::vector<std::string> kinds;
  for (const PatternPart& part : sum->parts) kinds.emplace_back(kind_name(part.pattern));
  for (const std::string& name : gamut_kind_names()) {
    const auto has = [&](const std::string& kind) { return name.find(kind) != std::string::npos; };
    const auto parts = static_cast<std::size_t>(std::ranges::count(name, '+')) + 1;
    if (parts > 1 && parts == kinds.size() && std::ranges::all_of(kinds, has) &&
        std::set(kinds.begin(), kinds.end()).size() == parts)
      return name;
  }
  return "sum";
}

}  // namespace

TargetGamut gamut_of_target(const Experiment& experiment, const Target& target) {
  GamutOptions options;
  options.wavelength = experiment.simulation.wavelength;
  TargetGamut gamut{gamut_formula(experiment.printer, options.wavelength, options.bounds), alphas_of(target.slopes),
                    kind_in_the_gamut(experiment.pattern), std::nullopt};
  if (std::ranges::find(gamut_kind_names(), gamut.kind) != gamut_kind_names().end())
    gamut.verdict = judge(target, experiment.printer, gamut.kind, options);
  return gamut;
}

std::string verdict_in_words(const TargetGamut& gamut) {
  if (!gamut.verdict) {
    return fmt::format("α {}: no verdict exists for patterns of kind \"{}\"; the gamut knows {}",
                       in_words(gamut.wanted), gamut.kind, fmt::join(gamut_kind_names(), ", "));
  }
  const GamutVerdict& verdict = *gamut.verdict;
  if (!gamut.is_outside()) {
    return fmt::format("α {}: can be printed with {}{}", in_words(gamut.wanted), gamut.kind,
                       verdict.place == GamutPlace::Edge ? ", just so: " + verdict.why : "");
  }
  const std::string others = verdict.other_kinds.empty()
                                 ? "no kind reaches it"
                                 : fmt::format("{} would", fmt::join(verdict.other_kinds, ", "));
  return fmt::format("α {}: cannot be printed with {}: {}; {}. The search goes to the nearest, α {}",
                     in_words(gamut.wanted), gamut.kind, verdict.why, others, in_words(verdict.nearest));
}

std::string in_words(const TargetGamut& gamut) {
  return "gamut: " + in_words(gamut.formula) + "\n" + verdict_in_words(gamut);
}

nlohmann::ordered_json to_json(const TargetGamut& gamut) {
  nlohmann::ordered_json json = {{"formula", to_json(gamut.formula)}, {"kind", gamut.kind}};
  json["target"] = {{"alpha_x", gamut.wanted.x}, {"alpha_y", gamut.wanted.y}};
  json["in_words"] = verdict_in_words(gamut);
  if (!gamut.verdict) {
    json["place"] = nullptr;
    return json;
  }
  json["place"] = to_string(gamut.verdict->place);
  json["verdict"] = to_json(*gamut.verdict);
  json["other_kinds"] = gamut.verdict->other_kinds;
  return json;
}

}  // namespace mezzotint
