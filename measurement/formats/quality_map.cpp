#include "measurement/formats/quality_map.h"

#include <fmt/format.h>

#include "forward/base/error.h"
#include "measurement/formats/byte_reader.h"
#include "measurement/formats/height_assembly.h"

namespace mezzotint {

namespace {

using Bytes = std::span<const std::byte>;

constexpr std::size_t smallest_header_bytes = 40;

struct BmpHeader {
  std::uint64_t columns = 0, rows = 0;
  bool first_row_on_top = false;
  std::size_t bits = 0;
  std::uint32_t header_bytes = 0, pixels_at = 0, colours = 0;
};

BmpHeader take_header(ByteReader& reader) {
  BmpHeader header;
  reader.take(2 + 4 + 4, "the header");
  header.pixels_at = reader.take_number<std::uint32_t>("the header");
  header.header_bytes = reader.take_number<std::uint32_t>("the header");
  if (header.header_bytes < smallest_header_bytes) {
    reader.fail(fmt::format("a header of {} bytes; BMP files of Windows have {} at least", header.header_bytes,
                            smallest_header_bytes));
  }
  const std::int64_t columns = reader.take_number<std::int32_t>("the width");
  const std::int64_t rows = reader.take_number<std::int32_t>("the height");
  if (columns <= 0 || rows == 0) reader.fail(fmt::format("{} × {} pixels", columns, rows));
  header.columns = static_cast<std::uint64_t>(columns);
  header.rows = static_cast<std::uint64_t>(rows < 0 ? -rows : rows);
  header.first_row_on_top = rows < 0;
  reader.take(2, "the planes");
  header.bits = reader.take_number<std::uint16_t>("the bits");
  const auto compression = reader.take_number<std::uint32_t>("the compression");
  if (compression != 0 || (header.bits != 8 && header.bits != 24)) {
    reader.fail(fmt::format("{} bits a pixel, compression {}; 8 or 24 bits without compression are read", header.bits,
                            compression));
  }
  reader.take(12, "the header");
  header.colours = reader.take_number<std::uint32_t>("the number of colours");
  reader.take(header.header_bytes - 36, "the header");
  return header;
}

// Blue, green and red of one colour.
std::uint8_t gray_of(const ByteReader& reader, const std::byte* colour) {
  if (colour[0] != colour[1] || colour[0] != colour[2]) reader.fail("is in colour; a quality map is gray");
  return std::to_integer<std::uint8_t>(colour[0]);
}

std::vector<std::uint8_t> take_palette(ByteReader& reader, const BmpHeader& header) {
  constexpr std::uint32_t most_colours = 256;
  if (header.bits != 8) return {};
  const std::uint32_t count = header.colours == 0 ? most_colours : header.colours;
  if (count > most_colours) reader.fail(fmt::format("{} colours; 8 bits name {}", count, most_colours));
  const Bytes colours = reader.take(4 * count, "the palette");
  std::vector<std::uint8_t> palette(count);
  for (std::size_t i = 0; i < count; ++i) palette[i] = gray_of(reader, colours.data() + 4 * i);
  return palette;
}

std::uint8_t pixel(const ByteReader& reader, const BmpHeader& header, const std::vector<std::uint8_t>& palette,
                   const std::byte* row, std::size_t column) {
  if (header.bits == 24) return gray_of(reader, row + 3 * column);
  const auto index = std::to_integer<std::size_t>(row[column]);
  if (index >= palette.size()) reader.fail(fmt::format("a colour {} beyond the palette of {}", index, palette.size()));
  return palette[index];
}

}  // namespace

QualityMap parse_quality_map(const std::filesystem::path& path, Bytes bytes) {
  if (!begins_with(bytes, "BM"))
    throw FileError(path, "byte 0", "a quality map is a BMP picture and begins with \"BM\"");
  ByteReader reader(path, bytes);
  const BmpHeader header = take_header(reader);
  const Grid grid = checked_grid(path, "header", {header.columns, header.rows, 1e-6, 1e-6});
  const std::vector<std::uint8_t> palette = take_palette(reader, header);
  if (header.pixels_at < reader.offset() || header.pixels_at > bytes.size()) {
    reader.fail(
        fmt::format("the pixels begin at byte {}; they must lie behind the header and in the file", header.pixels_at));
  }
  reader.take(header.pixels_at - reader.offset(), "the pixels");
  const std::uint64_t stride = (grid.columns * header.bits + 31) / 32 * 4;
  const Bytes pixels = reader.take(stride * grid.rows, "the pixels");
  QualityMap map{grid.columns, grid.rows, std::vector<std::uint8_t>(grid.size())};
  for (std::size_t row = 0; row < grid.rows; ++row) {
    const std::size_t source = header.first_row_on_top ? row : grid.rows - 1 - row;
    for (std::size_t column = 0; column < grid.columns; ++column) {
      map.gray[row * grid.columns + column] = pixel(reader, header, palette, pixels.data() + source * stride, column);
    }
  }
  return map;
}

}  // namespace mezzotint
