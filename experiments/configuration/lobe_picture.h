#pragma once

#include <cstddef>
#include <filesystem>
#include <vector>

namespace mezzotint {

/// A lobe painted as a picture: light over a direction map, in no unit.
///
/// Frame    the picture's square is the square about the unit disc of directions in orthographic projection; its top
///          row lies at y = +1, as one looks at it. Here row 0 is y = −1, like a direction map.
/// Shape    side × side pixels, row by row.
struct LobePicture {
  std::size_t side = 0;
  std::vector<float> light;  ///< linear, not negative
  std::filesystem::path source;
};

/// PNG of 8 or 16 bits, gray or colour (luminance by ITU-R BT.709), decoded from sRGB unless it is `linear`; OpenEXR of
/// 32-bit floats, one channel or R, G, B, linear in any case.
/// @throws FileError for other pictures, those that are not square or have an alpha channel, for negative, infinite or
///         missing light, for pictures that are dark, and for light outside of the disc, which is no direction at all.
[[nodiscard]] LobePicture read_lobe_picture(const std::filesystem::path& path, bool linear);

/// The light at a direction's (x, y): that of the pixel there; 0 outside of the picture.
[[nodiscard]] double light_at(const LobePicture& picture, double x, double y);

}  // namespace mezzotint
