#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

namespace mezzotint {

/// The quality of every sample as the instrument saw it: gray levels 0 … 255, the top row first.
struct QualityMap {
  std::uint64_t columns = 0, rows = 0;
  std::vector<std::uint8_t> gray;
};

/// An uncompressed BMP of 8 or 24 bits whose colours are all gray. Read here, in a hundred lines, since a picture
/// library's reader of this format is of no other use to us and a common source of its defects.
/// @throws FileError where it is another kind of picture, cut short, or in colour
[[nodiscard]] QualityMap parse_quality_map(const std::filesystem::path& path, std::span<const std::byte> bytes);

}  // namespace mezzotint
