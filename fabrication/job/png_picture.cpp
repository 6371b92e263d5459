#include "fabrication/job/png_picture.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "forward/base/bounded_memory.h"

namespace mezzotint {

namespace {

// Fixed, since the default of a library may change from version to version.
constexpr int compression_level = 6;

struct PngHeader {
  std::uint32_t columns, rows;
  int bit_depth, colour_type;
};

std::uint32_t big_endian(std::span<const std::byte> bytes, std::size_t at) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < 4; ++i) value = value << 8U | std::to_integer<std::uint32_t>(bytes[at + i]);
  return value;
}

// PNG specification, 5.2 and 11.2.2: eight bytes of signature, then the chunk IHDR of 13 bytes.
PngHeader read_header(std::span<const std::byte> png, const MemberPlace& place) {
  constexpr std::array<unsigned char, 8> signature = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1A, '\n'};
  constexpr std::uint32_t ihdr = 0x49484452;
  const auto same = [](unsigned char a, std::byte b) { return a == std::to_integer<unsigned char>(b); };
  const bool is_png = png.size() >= 33 && std::equal(signature.begin(), signature.end(), png.begin(), same) &&
                      big_endian(png, 8) == 13 && big_endian(png, 12) == ihdr;
  if (!is_png) place.refuse("is no PNG picture");
  return {big_endian(png, 16), big_endian(png, 20), std::to_integer<int>(png[24]), std::to_integer<int>(png[25])};
}

// Every chunk lies within the bytes, up to the last one (length, name, data, checksum). Asked here, since
// OpenImageIO 2.4 leaks when libpng runs into the end of a picture.
void check_chunks(std::span<const std::byte> png, const MemberPlace& place) {
  constexpr std::uint32_t iend = 0x49454E44;
  std::size_t at = 8;
  while (png.size() - at >= 12) {
    const std::uint32_t length = big_endian(png, at);
    if (length > png.size() - at - 12) break;
    if (big_endian(png, at + 4) == iend) return;
    at += 12 + std::size_t{length};
  }
  place.refuse("is a PNG picture that was cut off");
}

void check_header(const PngHeader& header, std::size_t columns, std::size_t rows, const MemberPlace& place) {
  if (header.columns != columns || header.rows != rows) {
    place.refuse(
        fmt::format("has {} x {} pixels; config.json says {} x {}", header.columns, header.rows, columns, rows));
  }
  if (header.colour_type != 0) place.refuse("is not gray; layers are 8-bit gray pictures");
  if (header.bit_depth != 8) place.refuse(fmt::format("has {} bits a pixel; layers have 8", header.bit_depth));
}

}  // namespace

std::string encode_png(std::span<const std::uint8_t> pixels, std::size_t columns, std::size_t rows, int channels) {
  OIIO::ImageSpec spec(static_cast<int>(columns), static_cast<int>(rows), channels, OIIO::TypeDesc::UINT8);
  std::vector<unsigned char> bytes;
  OIIO::Filesystem::IOVecOutput sink(bytes);
  OIIO::Filesystem::IOProxy* const proxy = &sink;
  spec.attribute("oiio:ioproxy", OIIO::TypeDesc::PTR, &proxy);
  spec.attribute("png:compressionLevel", compression_level);
  const std::unique_ptr<OIIO::ImageOutput> output = OIIO::ImageOutput::create("layer.png");
  const bool good = output && output->open("layer.png", spec) &&
                    output->write_image(OIIO::TypeDesc::UINT8, pixels.data()) && output->close();
  if (!good) throw DeviceError("cannot make a PNG picture: " + (output ? output->geterror() : OIIO::geterror()));
  return {bytes.begin(), bytes.end()};
}

std::vector<std::uint8_t> decode_gray_png(std::span<const std::byte> png, std::size_t columns, std::size_t rows,
                                          const MemberPlace& place) {
  check_header(read_header(png, place), columns, rows, place);
  check_chunks(png, place);
  BoundedMemory source(png.data(), png.size());
  OIIO::Filesystem::IOProxy* const proxy = &source;
  OIIO::ImageSpec config;
  config.attribute("oiio:ioproxy", OIIO::TypeDesc::PTR, &proxy);
  const std::unique_ptr<OIIO::ImageInput> input = OIIO::ImageInput::open("layer.png", &config, proxy);
  if (!input) place.refuse("is a damaged PNG picture: " + OIIO::geterror());
  // A chunk of transparency would turn gray into two channels.
  if (input->spec().nchannels != 1) place.refuse("is not plain gray; layers are 8-bit gray pictures");
  std::vector<std::uint8_t> pixels(columns * rows);
  const bool good = input->read_image(0, 0, 0, 1, OIIO::TypeDesc::UINT8, pixels.data());
  if (!good || input->has_error()) place.refuse("is a damaged PNG picture: " + input->geterror());
  return pixels;
}

}  // namespace mezzotint
