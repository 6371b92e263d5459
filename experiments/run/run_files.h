#pragma once

#include <filesystem>

#include <nlohmann/json.hpp>

#include "measurement/comparison/registration.h"
#include "measurement/texture/roughness.h"

namespace mezzotint {

/// What stages hand on as JSON. Doubles are written so that reading gives the same bits.
[[nodiscard]] nlohmann::ordered_json to_json(const Registration& registration);
[[nodiscard]] nlohmann::ordered_json to_json(const AreaRoughness& roughness);

/// @throws FileError for a file that is not JSON.
[[nodiscard]] nlohmann::ordered_json read_json(const std::filesystem::path& path);
void write_json(const nlohmann::ordered_json& json, const std::filesystem::path& path);

}  // namespace mezzotint
