#pragma once

#include <optional>
#include <string>

#include <nlohmann/json.hpp>

#include "experiments/configuration/experiment_file.h"
#include "experiments/gamut/gamut_findings.h"
#include "inverse/target/target.h"

namespace mezzotint {

/// Whether a printer reaches a target with the experiment's kind of pattern, before anything is searched.
struct TargetGamut {
  GamutFormula formula;
  AlphaPair wanted;
  std::string kind;                     ///< of the pattern, as judge names it; "free_form", or a composition's kind
  std::optional<GamutVerdict> verdict;  ///< none for a kind without a gamut

  [[nodiscard]] bool is_outside() const { return verdict && verdict->place == GamutPlace::Outside; }
};

/// By the target's slopes: for a lobe those that it implies. All numbers of the kind are taken as free, whatever the
/// experiment holds fixed.
[[nodiscard]] TargetGamut gamut_of_target(const Experiment& experiment, const Target& target);

/// The formula in one line, then the verdict; for a target that cannot be printed the reason, the nearest one and the
/// kinds that would reach it. Lines end where a new one begins.
[[nodiscard]] std::string in_words(const TargetGamut& gamut);
/// The verdict alone, without the formula.
[[nodiscard]] std::string verdict_in_words(const TargetGamut& gamut);

[[nodiscard]] nlohmann::ordered_json to_json(const TargetGamut& gamut);

}  // namespace mezzotint
