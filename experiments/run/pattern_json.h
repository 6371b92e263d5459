#pragma once

#include <nlohmann/json.hpp>

#include "forward/pattern/pattern.h"

namespace mezzotint {

/// A pattern with all that it is made of, so that reading it gives the same bits.
[[nodiscard]] nlohmann::ordered_json pattern_to_json(const Pattern& pattern);
[[nodiscard]] Pattern pattern_from_json(const nlohmann::ordered_json& json);

}  // namespace mezzotint
