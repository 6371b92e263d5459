#include <fmt/format.h>

#include "forward/base/error.h"
#include "measurement/formats/byte_reader.h"
#include "measurement/formats/height_assembly.h"
#include "measurement/formats/picture_header.h"

namespace mezzotint {

namespace {

constexpr std::string_view magic("\x76\x2f\x31\x01", 4);
constexpr std::uint32_t float_type = 2;

struct Window {
  std::uint64_t columns = 0, rows = 0;
};

Window take_window(ByteReader value) {
  std::int64_t bounds[4];
  for (std::int64_t& bound : bounds) bound = value.take_number<std::int32_t>("the window");
  if (bounds[2] < bounds[0] || bounds[3] < bounds[1]) value.fail("a window without pixels");
  return {static_cast<std::uint64_t>(bounds[2] - bounds[0] + 1), static_cast<std::uint64_t>(bounds[3] - bounds[1] + 1)};
}

void require_one_float_channel(ByteReader value) {
  const std::string_view name = value.take_text("a channel");
  if (name.empty()) value.fail("no channel");
  if (value.take_number<std::uint32_t>("a channel") != float_type) {
    value.fail("the channel is not of 32-bit floats, which a relief is");
  }
  value.take(4, "a channel");
  const auto step_x = value.take_number<std::int32_t>("a channel"),
             step_y = value.take_number<std::int32_t>("a channel");
  if (step_x != 1 || step_y != 1) value.fail("the channel leaves out samples");
  if (!value.take_text("the list of channels").empty()) value.fail("more than one channel; a relief has one");
}

void require_lossless(ByteReader value) {
  constexpr std::uint8_t last_lossless = 4;  // none, RLE, ZIPS, ZIP, PIZ
  if (value.take_number<std::uint8_t>("the compression") > last_lossless) {
    value.fail("is packed with loss; write it with zip, piz or rle");
  }
}

void require_flat(ByteReader& reader) {
  constexpr std::uint32_t version = 2, long_names = 0x400;
  if ((reader.take_number<std::uint32_t>("the version") & ~long_names) != version) {
    reader.fail("has tiles, parts or depth; one flat picture in lines is read");
  }
}

}  // namespace

bool looks_like_exr(std::span<const std::byte> bytes) { return begins_with(bytes, magic); }

// Source   "OpenEXR File Layout".
void require_relief_exr(const std::filesystem::path& path, std::span<const std::byte> bytes) {
  constexpr std::uint64_t most_lines_a_block = 32, bytes_an_offset = 8;
  ByteReader reader(path, bytes);
  reader.take(magic.size(), "the first word");
  require_flat(reader);
  Window window;
  bool has_channels = false, has_compression = false;
  while (true) {
    const std::string_view name = reader.take_text("the name of an attribute");
    if (name.empty()) break;
    reader.take_text("the type of an attribute");
    const auto size = reader.take_number<std::uint32_t>("the size of an attribute");
    const ByteReader value = reader.take_part(size, "an attribute");
    if (name == "dataWindow") window = take_window(value);
    if (name == "channels") require_one_float_channel(value);
    if (name == "compression") require_lossless(value);
    has_channels = has_channels || name == "channels";
    has_compression = has_compression || name == "compression";
  }
  if (window.rows == 0 || !has_channels || !has_compression) {
    reader.fail("the header lacks the window, the channels or the compression");
  }
  // The library makes a table of the blocks of lines, as long as the window says.
  if (window.rows / most_lines_a_block > reader.remaining() / bytes_an_offset) {
    reader.fail(fmt::format("{} lines are promised; only {} bytes are left", window.rows, reader.remaining()));
  }
  const std::uint64_t samples = checked_grid(path, "header", {window.columns, window.rows, 1e-6, 1e-6}).size();
  require_plausible_size(path, samples * sizeof(float), bytes.size());
}

}  // namespace mezzotint
