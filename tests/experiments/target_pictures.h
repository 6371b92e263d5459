#pragma once

#include <cstdint>
#include <filesystem>
#include <stdexcept>
#include <vector>

#include <OpenImageIO/imageio.h>

namespace mezzotint::test {

/// A square PNG of 8 bits, its first row on top.
inline void write_png(const std::filesystem::path& path, int side, int channels,
                      const std::vector<std::uint8_t>& pixels) {
  const auto output = OIIO::ImageOutput::create("png");
  const OIIO::ImageSpec spec(side, side, channels, OIIO::TypeDesc::UINT8);
  if (!output || !output->open(path.string(), spec) || !output->write_image(OIIO::TypeDesc::UINT8, pixels.data()) ||
      !output->close())
    throw std::runtime_error("no picture was written");
}

}  // namespace mezzotint::test
