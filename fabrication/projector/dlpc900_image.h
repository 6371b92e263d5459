#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace mezzotint::dlpc900 {

/// A picture of one controller: three bytes a pixel, in the order in which they travel.
///
/// Shape    rows × columns × 3, row 0 on top.
struct PackedImage {
  std::size_t columns = 0;
  std::size_t rows = 0;
  std::vector<std::uint8_t> bytes;
};

/// A rectangle of a gray picture: `columns` of its pixels from `first_column` on, all of its rows.
struct PlaneView {
  std::span<const std::uint8_t> gray;
  std::size_t row_stride = 0;  ///< pixels from row to row of `gray`
  std::size_t first_column = 0;
};

/// Up to three gray planes in one image: plane 0 has bit positions 0–7 and lies in the *third* byte of a pixel,
/// plane 1 (8–15) in the second, plane 2 (16–23) in the first. Planes that are left out are dark.
[[nodiscard]] PackedImage pack_planes(std::size_t columns, std::size_t rows,
                                      const std::array<std::optional<PlaneView>, 3>& planes);

enum class Compression : std::uint8_t { None = 0, RunLength = 1, EnhancedRunLength = 2 };

/// The image as the device takes it: a header of 48 bytes, then the pixels.
///
/// None                rows filled up to a multiple of 16 bytes
/// RunLength           runs and raw stretches of up to 255 pixels; every line is ended
/// EnhancedRunLength   the same up to 32767 pixels, and copies of stretches of the line above
///
/// @throws InvalidInput for an image without pixels, or wider or higher than 65535.
/// Source   TI DLPU018F, sections 2.4.4.4 and tables 2-107 to 2-110.
[[nodiscard]] std::vector<std::uint8_t> encode_image(const PackedImage& image, Compression compression);

/// The shortest of the three. Noise does not shrink: the answer is then `Compression::None`, whose size is the bound.
[[nodiscard]] std::vector<std::uint8_t> encode_image_smallest(const PackedImage& image);

inline constexpr std::size_t image_header_bytes = 48;

}  // namespace mezzotint::dlpc900
