#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "fabrication/job/member_place.h"

namespace mezzotint {

/// An 8-bit picture as PNG: 1 channel (gray) or 3 (RGB), row 0 on top. No date, no text: the same pixels give
/// the same bytes.
[[nodiscard]] std::string encode_png(std::span<const std::uint8_t> pixels, std::size_t columns, std::size_t rows,
                                     int channels);

/// The pixels of an 8-bit gray PNG of exactly this size, row 0 on top. The header is checked before any memory
/// is taken.
/// @throws FileError naming the member where it is another size or depth, in colour, or damaged.
[[nodiscard]] std::vector<std::uint8_t> decode_gray_png(std::span<const std::byte> png, std::size_t columns,
                                                        std::size_t rows, const MemberPlace& place);

}  // namespace mezzotint
