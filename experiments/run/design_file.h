#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include "inverse/design/design.h"

namespace mezzotint {

/// What is wanted and what was found, as JSON. Doubles are written so that reading gives the same bits.
[[nodiscard]] nlohmann::ordered_json to_json(const Target& target);
[[nodiscard]] nlohmann::ordered_json to_json(const Design& design);

/// The figures; the lobes themselves are pictures of their own.
[[nodiscard]] nlohmann::ordered_json to_json(const Verification& verification);

[[nodiscard]] Verification verification_from_json(const nlohmann::ordered_json& json);
[[nodiscard]] Target target_from_json(const nlohmann::ordered_json& json);
[[nodiscard]] Design design_from_json(const nlohmann::ordered_json& json);

/// What a search came to, in one sentence, with its tolerance.
[[nodiscard]] std::string verdict_sentence(const Target& target, const Design& design);

}  // namespace mezzotint
