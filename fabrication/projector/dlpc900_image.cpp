#include "fabrication/projector/dlpc900_image.h"

#include "fabrication/projector/dlpc900_frame.h"
#include "fabrication/projector/run_length.h"
#include "forward/base/error.h"

namespace mezzotint::dlpc900 {
namespace {

std::vector<std::uint8_t> make_header(const PackedImage& image, Compression compression) {
  std::vector<std::uint8_t> bytes = {'S', 'p', 'l', 'd'};
  bytes.reserve(image_header_bytes);
  append_number(bytes, static_cast<std::uint32_t>(image.columns), 2);
  append_number(bytes, static_cast<std::uint32_t>(image.rows), 2);
  append_number(bytes, 0, 4);  // bytes that follow the header; known at the end
  append_number(bytes, 0xffffffff, 4);
  append_number(bytes, 0xffffffff, 4);
  append_number(bytes, 0, 4);  // background: black
  // 24 bits a pixel; the guide says 0 here, TI's own program sends 1, and devices take both.
  bytes.push_back(1);
  bytes.push_back(static_cast<std::uint8_t>(compression));
  append_number(bytes, 0x01000001, 4);  // order of bytes, and what TI's program sends
  bytes.resize(image_header_bytes, 0);
  return bytes;
}

void append_raw(std::vector<std::uint8_t>& bytes, const PackedImage& image) {
  const std::size_t stride = 3 * image.columns;
  const std::size_t filled = (stride + 15) / 16 * 16;
  for (std::size_t row = 0; row < image.rows; ++row) {
    const auto first = image.bytes.begin() + static_cast<std::ptrdiff_t>(row * stride);
    bytes.insert(bytes.end(), first, first + static_cast<std::ptrdiff_t>(stride));
    bytes.insert(bytes.end(), filled - stride, 0);
  }
}

}  // namespace

PackedImage pack_planes(std::size_t columns, std::size_t rows, const std::array<std::optional<PlaneView>, 3>& planes) {
  for (const auto& plane : planes) {
    require(!plane ||
                (plane->first_column + columns <= plane->row_stride && plane->gray.size() >= plane->row_stride * rows),
            "a plane is smaller than the image that it goes into");
  }
  PackedImage image{columns, rows, std::vector<std::uint8_t>(3 * columns * rows, 0)};
  for (std::size_t index = 0; index < planes.size(); ++index) {
    if (!planes[index]) continue;
    const auto& plane = *planes[index];
    std::uint8_t* out = image.bytes.data() + (2 - index);
    for (std::size_t row = 0; row < rows; ++row) {
      const std::uint8_t* in = plane.gray.data() + row * plane.row_stride + plane.first_column;
      for (std::size_t column = 0; column < columns; ++column, out += 3) *out = in[column];
    }
  }
  return image;
}

std::vector<std::uint8_t> encode_image(const PackedImage& image, Compression compression) {
  require(image.columns >= 1 && image.columns <= 0xffff && image.rows >= 1 && image.rows <= 0xffff,
          "an image of the projector has 1 to 65535 columns and rows");
  require(image.bytes.size() == 3 * image.columns * image.rows, "an image has three bytes a pixel");
  std::vector<std::uint8_t> bytes = make_header(image, compression);
  if (compression == Compression::None) {
    append_raw(bytes, image);
  } else {
    append_run_lengths(bytes, image, compression == Compression::EnhancedRunLength);
  }
  const auto count = static_cast<std::uint32_t>(bytes.size() - image_header_bytes);
  for (std::size_t i = 0; i < 4; ++i) bytes[8 + i] = static_cast<std::uint8_t>(count >> (8 * i));
  return bytes;
}

std::vector<std::uint8_t> encode_image_smallest(const PackedImage& image) {
  std::vector<std::uint8_t> best = encode_image(image, Compression::EnhancedRunLength);
  for (const auto compression : {Compression::RunLength, Compression::None}) {
    auto other = encode_image(image, compression);
    if (other.size() < best.size()) best = std::move(other);
  }
  return best;
}

}  // namespace mezzotint::dlpc900
