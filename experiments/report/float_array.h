#pragma once

#include <span>
#include <string>

#include <nlohmann/json.hpp>

namespace mezzotint {

/// Base64 of RFC 4648, with padding.
[[nodiscard]] std::string to_base64(std::span<const unsigned char> bytes);

/// {"float32": base64 of little-endian 32-bit floats}. NaN stays NaN: it means "not seen" there.
[[nodiscard]] nlohmann::json float_array(std::span<const float> values);
[[nodiscard]] nlohmann::json float_array(std::span<const double> values);

}  // namespace mezzotint
