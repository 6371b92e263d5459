#pragma once

#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

namespace mezzotint::emulator {

/// What the emulated controller makes of an uploaded image. Written from the protocol sheet alone: nothing in
/// this folder includes anything of the driver.
struct DecodedImage {
  std::size_t width = 0;
  std::size_t height = 0;
  std::vector<std::uint8_t> rgb;  ///< as stored: bit positions 16–23, 8–15, 0–7

  /// Gray values of the eight bit positions from `bit` on (0, 8 or 16).
  [[nodiscard]] std::vector<std::uint8_t> plane(unsigned bit) const;
};

/// An upload that a controller could not show.
class BadImage : public std::runtime_error {
public:
  using std::runtime_error::runtime_error;
};

/// Strict: runs that leave their line, lines that are not filled, bytes after the end are all wrong.
[[nodiscard]] DecodedImage decode_image(const std::vector<std::uint8_t>& upload);

/// The pixels of an enhanced run-length stream whose last line may be incomplete (the guide's example).
[[nodiscard]] std::vector<std::uint8_t> decode_enhanced_example(const std::vector<std::uint8_t>& stream,
                                                                std::size_t width);

}  // namespace mezzotint::emulator
