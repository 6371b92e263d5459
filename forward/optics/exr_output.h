#pragma once

#include <filesystem>
#include <span>

#include <OpenImageIO/imageio.h>

/// Inside of forward: how our EXR files are written.

namespace mezzotint {

/// A picture of floats, as many a pixel as the specification has channels. It is made in memory and then written:
/// straight to a full disk, OpenEXR swallows the error when it closes the file, and half a picture passes for a whole
/// one.
/// @throws DeviceError where it cannot be written; nothing is left then.
void write_exr_picture(const OIIO::ImageSpec& spec, std::span<const float> pixels, const std::filesystem::path& path);

}  // namespace mezzotint
