#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <vector>

namespace mezzotint {

/// The largest file that is read into memory at once: 4 GiB holds a 32k × 32k scan of floats.
inline constexpr std::uintmax_t largest_input_bytes = std::uintmax_t{4} << 30;

/// A whole file, as bytes.
/// @throws FileError where it is missing, no regular file, unreadable, empty or larger than
///         `largest_input_bytes`; the size is checked before memory is taken.
[[nodiscard]] std::vector<std::byte> read_file(const std::filesystem::path& path);

}  // namespace mezzotint
