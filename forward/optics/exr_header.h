#pragma once

#include <cstddef>
#include <filesystem>
#include <span>

/// Inside of forward/optics.

namespace mezzotint {

/// Looks at the header of an OpenEXR file before the library does: OpenEXR takes memory for whatever an
/// attribute or the picture's window claims to be, before it finds that the file is shorter.
/// @throws FileError for anything but one flat picture in lines of 32-bit float channels, without loss,
///         at most 4096 × 4096, with every attribute inside of the file.
void require_sound_exr_header(std::span<const std::byte> file, const std::filesystem::path& path);

}  // namespace mezzotint
