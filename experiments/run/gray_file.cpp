#include "experiments/run/gray_file.h"

#include <cmath>
#include <cstdint>
#include <memory>
#include <set>
#include <vector>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include "forward/base/error.h"
#include "forward/base/file_output.h"

namespace mezzotint {

namespace {

// Bottom up in memory, top down in the picture.
template <class Pixel>
std::string png_of(const GrayImage& gray, double white, OIIO::TypeDesc type) {
  std::vector<Pixel> pixels;
  pixels.reserve(gray.values.size());
  for (std::size_t row = gray.rows; row-- > 0;) {
    for (std::size_t column = 0; column < gray.columns; ++column)
      pixels.push_back(static_cast<Pixel>(std::lround(white * static_cast<double>(gray.at(column, row)))));
  }
  std::vector<unsigned char> bytes;
  OIIO::Filesystem::IOVecOutput sink(bytes);
  OIIO::Filesystem::IOProxy* proxy = &sink;
  OIIO::ImageSpec spec(static_cast<int>(gray.columns), static_cast<int>(gray.rows), 1, type);
  spec.attribute("oiio:ioproxy", OIIO::TypeDesc::PTR, &proxy);
  spec.attribute("ImageDescription", "Gray layer, white is full light; the first line has the largest y.");
  const auto file = OIIO::ImageOutput::create("png");
  if (!file || !file->open("gray.png", spec) || !file->write_image(type, pixels.data()) || !file->close())
    throw DeviceError("cannot make a PNG picture: " + (file ? file->geterror() : OIIO::geterror()));
  return {bytes.begin(), bytes.end()};
}

}  // namespace

std::size_t gray_levels_used(const GrayImage& gray) {
  return std::set<float>(gray.values.begin(), gray.values.end()).size();
}

GrayFigures write_gray_png(const GrayImage& gray, int levels, const std::filesystem::path& path) {
  require_valid(gray);
  GrayFigures figures{gray_levels_used(gray), levels > 256 ? 16 : 8};
  write_file(path, figures.bits == 8 ? png_of<std::uint8_t>(gray, 255.0, OIIO::TypeDesc::UINT8)
                                     : png_of<std::uint16_t>(gray, 65535.0, OIIO::TypeDesc::UINT16));
  return figures;
}

}  // namespace mezzotint
