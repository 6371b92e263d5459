#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "experiments/run/stages.h"
#include "inverse/target/target.h"

namespace mezzotint {

/// The search stage of a free form: design.json, gray.png, relief.gwy, lobes; free_form.state on the way, from which an
/// interrupted search goes on.
/// @throws InvalidInput for an anisotropy, which names no lobe; else as find_free_form.
std::vector<std::string> search_free_form(const StageContext& context, const Target& target);

/// "Target met: traced on 4 grounds …", from design.json of a free form.
[[nodiscard]] std::string free_form_verdict(const nlohmann::ordered_json& json);

}  // namespace mezzotint
