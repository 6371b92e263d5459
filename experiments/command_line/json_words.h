#pragma once

#include <string>

#include <nlohmann/json.hpp>

namespace mezzotint {

/// A result for people: a line for each key, quantities with their unit and standard error, objects indented.
[[nodiscard]] std::string in_words(const nlohmann::ordered_json& json);

}  // namespace mezzotint
