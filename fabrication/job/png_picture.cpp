#include "fabrication/job/png_picture.h"

#include <fmt/format.h>
#include <png.h>

#include <algorithm>
#include <array>

#include "forward/base/error.h"

namespace mezzotint {

namespace {

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

// Every chunk lies within the bytes, up to the last one (length, name, data, checksum): libpng takes a picture that
// lacks its end.
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

namespace {

/// libpng's picture in memory, freed whatever happens.
struct Picture {
  png_image image = {};
  Picture() { image.version = PNG_IMAGE_VERSION; }
  ~Picture() { png_image_free(&image); }
  Picture(const Picture&) = delete;
  Picture& operator=(const Picture&) = delete;
};

}  // namespace

std::string encode_png(std::span<const std::uint8_t> pixels, std::size_t columns, std::size_t rows, int channels) {
  Picture picture;
  picture.image.width = static_cast<png_uint_32>(columns);
  picture.image.height = static_cast<png_uint_32>(rows);
  picture.image.format = channels == 1 ? PNG_FORMAT_GRAY : PNG_FORMAT_RGB;
  picture.image.flags = PNG_IMAGE_FLAG_FAST;  // previews; twice the bytes at a fifth of the time
  std::string bytes(PNG_IMAGE_PNG_SIZE_MAX(picture.image), '\0');
  png_alloc_size_t size = bytes.size();
  if (png_image_write_to_memory(&picture.image, bytes.data(), &size, 0, pixels.data(), 0, nullptr) == 0)
    throw DeviceError(std::string("cannot make a PNG picture: ") + picture.image.message);
  bytes.resize(size);
  return bytes;
}

std::vector<std::uint8_t> decode_gray_png(std::span<const std::byte> png, std::size_t columns, std::size_t rows,
                                          const MemberPlace& place) {
  check_header(read_header(png, place), columns, rows, place);
  check_chunks(png, place);
  Picture picture;
  const auto refuse = [&] { place.refuse(std::string("is a damaged PNG picture: ") + picture.image.message); };
  if (png_image_begin_read_from_memory(&picture.image, png.data(), png.size()) == 0) refuse();
  // A chunk of transparency would turn gray into two channels.
  if ((picture.image.format & PNG_FORMAT_FLAG_ALPHA) != 0)
    place.refuse("is not plain gray; layers are 8-bit gray pictures");
  picture.image.format = PNG_FORMAT_GRAY;
  std::vector<std::uint8_t> pixels(columns * rows);
  if (png_image_finish_read(&picture.image, nullptr, pixels.data(), 0, nullptr) == 0) refuse();
  return pixels;
}

}  // namespace mezzotint
