#include "forward/optics/exr_header.h"

#include <cstdint>
#include <string>

#include <fmt/format.h>

#include "forward/base/error.h"

namespace mezzotint {

namespace {

using Bytes = std::span<const std::byte>;

// Little-endian, as the format is, on any machine.
std::uint32_t word(Bytes bytes) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < 4; ++i) value |= std::to_integer<std::uint32_t>(bytes[i]) << (8 * i);
  return value;
}

class HeaderReader {
public:
  HeaderReader(Bytes file, const std::filesystem::path& path) : file_(file), path_(path) {}

  Bytes take(std::size_t count) {
    if (count > file_.size() - position_) fail("ends within its header; it is truncated or damaged");
    const Bytes taken = file_.subspan(position_, count);
    position_ += count;
    return taken;
  }
  std::uint32_t take_word() { return word(take(4)); }
  // Names end at a zero; the format allows 255 characters.
  std::string take_name() {
    std::string name;
    for (char c = take_character(); c != '\0'; c = take_character()) {
      if (name.size() == 255) fail("has a name of more than 255 characters; its header is damaged");
      name += c;
    }
    return name;
  }
  [[noreturn]] void fail(const std::string& problem) const {
    throw FileError(path_, "header, byte " + std::to_string(position_), problem);
  }

private:
  char take_character() { return static_cast<char>(take(1)[0]); }

  Bytes file_;
  const std::filesystem::path& path_;
  std::size_t position_ = 0;
};

void require_version(HeaderReader& header) {
  constexpr std::uint32_t magic = 20000630;
  constexpr std::uint32_t long_names = 0x400;
  if (header.take_word() != magic) header.fail("is no OpenEXR file");
  const std::uint32_t version = header.take_word();
  if ((version & 0xffU) != 2 || (version & ~(0xffU | long_names)) != 0) {
    header.fail("has tiles, parts or depth; one flat picture in lines is read");
  }
}

void require_window(HeaderReader& header, Bytes value) {
  if (value.size() != 16) header.fail("has a dataWindow that is no window");
  const auto bound = [&](std::size_t i) { return std::int64_t{static_cast<std::int32_t>(word(value.subspan(4 * i)))}; };
  const std::int64_t width = bound(2) - bound(0) + 1, height = bound(3) - bound(1) + 1;
  if (width < 1 || height < 1 || width > 4096 || height > 4096) {
    header.fail(fmt::format("has {} x {} bins; a direction map has 1 to 4096 a side", width, height));
  }
}

void require_lossless(HeaderReader& header, Bytes value) {
  constexpr std::uint8_t last_lossless = 4;  // none, RLE, ZIPS, ZIP, PIZ
  if (value.size() != 1 || std::to_integer<std::uint8_t>(value[0]) > last_lossless) {
    header.fail("is compressed with loss; write it with zip, piz or rle");
  }
}

void require_channels(HeaderReader& header, Bytes value, const std::filesystem::path& path) {
  constexpr std::uint32_t float_type = 2;
  HeaderReader list(value, path);
  constexpr std::size_t most = 432;  // three times the maps, their errors, and 64 orders with theirs
  for (std::size_t count = 0; !list.take_name().empty(); ++count) {
    if (count == most) header.fail("has more than 432 channels; no BSDF has so many");
    if (list.take_word() != float_type) header.fail("has channels that are not 32-bit float");
    list.take_word();  // linear or not, and three bytes without meaning
    if (list.take_word() != 1 || list.take_word() != 1) header.fail("has channels that leave out samples");
  }
}

}  // namespace

void require_sound_exr_header(Bytes file, const std::filesystem::path& path) {
  HeaderReader header(file, path);
  require_version(header);
  bool has_window = false, has_channels = false, has_compression = false;
  for (std::string name = header.take_name(); !name.empty(); name = header.take_name()) {
    const std::string type = header.take_name();
    const Bytes value = header.take(header.take_word());
    if (name == "dataWindow") {
      require_window(header, value);
      has_window = true;
    } else if (name == "compression") {
      require_lossless(header, value);
      has_compression = true;
    } else if (name == "channels") {
      require_channels(header, value, path);
      has_channels = true;
    }
  }
  if (!has_window || !has_channels || !has_compression) header.fail("lacks its window, channels or compression");
}

}  // namespace mezzotint
