#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <vector>

#include <OpenImageIO/imageio.h>

#include "forward/base/bounded_memory.h"

/// For the readers of OpenEXR files: forward/optics, forward/bsdf_table, experiments/configuration.

namespace mezzotint {

/// An OpenEXR file whose header was found sound: its bytes, and the library's view of them. In the order in which they
/// depend on each other.
struct ExrInput {
  std::vector<std::byte> bytes;
  std::unique_ptr<BoundedMemory> memory;
  std::unique_ptr<OIIO::ImageInput> file;
  OIIO::ImageSpec spec;
};

/// @throws FileError for a file that is larger than any direction map, is no EXR, or whose header is damaged
///         (require_sound_exr_header); DeviceError where the library has no OpenEXR.
[[nodiscard]] ExrInput open_exr(const std::filesystem::path& path);

}  // namespace mezzotint
