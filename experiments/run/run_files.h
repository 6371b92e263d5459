#pragma once

#include <filesystem>

#include <nlohmann/json.hpp>

#include "inverse/design/design.h"
#include "measurement/comparison/registration.h"
#include "measurement/texture/roughness.h"

namespace mezzotint {

/// What stages hand on as JSON. Doubles are written so that reading gives the same bits.
[[nodiscard]] nlohmann::ordered_json to_json(const Target& target);
[[nodiscard]] nlohmann::ordered_json to_json(const Design& design);
[[nodiscard]] nlohmann::ordered_json to_json(const Registration& registration);
[[nodiscard]] nlohmann::ordered_json to_json(const AreaRoughness& roughness);

[[nodiscard]] Target target_from_json(const nlohmann::ordered_json& json);
[[nodiscard]] Design design_from_json(const nlohmann::ordered_json& json);

/// What a search came to, in one sentence, with its tolerance.
[[nodiscard]] std::string verdict_sentence(const Target& target, const Design& design);

/// @throws FileError for a file that is not JSON.
[[nodiscard]] nlohmann::ordered_json read_json(const std::filesystem::path& path);
void write_json(const nlohmann::ordered_json& json, const std::filesystem::path& path);

}  // namespace mezzotint
