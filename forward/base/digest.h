#pragma once

#include <cstddef>
#include <span>
#include <string>

namespace mezzotint {

/// MD5 of some bytes as 32 lower-case hexadecimal digits: what X3P files carry. It tells damage, not forgery.
[[nodiscard]] std::string md5_hex(std::span<const std::byte> bytes);

/// SHA-256 of some bytes as 64 lower-case hexadecimal digits.
/// Source   FIPS 180-4, by nettle.
[[nodiscard]] std::string sha256_hex(std::span<const std::byte> bytes);

}  // namespace mezzotint
