#include <cmath>
#include <limits>
#include <optional>

#include <fmt/format.h>

#include "forward/base/error.h"
#include "measurement/formats/byte_reader.h"
#include "measurement/formats/height_assembly.h"
#include "measurement/formats/parsers.h"
#include "measurement/formats/text_values.h"

namespace mezzotint {

namespace {

constexpr std::string_view magic(
    "\x01\x00"
    "Directory\x00",
    12);
constexpr std::size_t magic_bytes = 2, name_bytes = 16, entry_bytes = 24;
// From these on, a sample is bad.
constexpr std::int16_t least_bad_integer = 32766;
constexpr float least_bad_float = 1e10F;

enum class BlockType : std::int16_t { Directory = 1, Array = 3, Text = 5, Short = 6, Float = 7 };

struct Block {
  std::string name;
  BlockType type = BlockType::Directory;
  ByteReader content;
};

std::string field_text(std::span<const std::byte> bytes) {
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  return clean_text(utf8_or_latin1(text.substr(0, text.find('\0'))));
}

// The directory lies first and lists itself first; the blocks follow it in its order, without gaps.
std::vector<Block> take_blocks(ByteReader& reader) {
  ByteReader first = reader;
  first.take(name_bytes + 2, "the first entry of the directory");
  const auto size = first.take_number<std::int32_t>("the length of the directory");
  if (size < static_cast<std::int32_t>(entry_bytes) || size % static_cast<std::int32_t>(entry_bytes) != 0) {
    reader.fail(fmt::format("a directory of {} bytes; it consists of entries of {}", size, entry_bytes));
  }
  ByteReader directory = reader.take_part(static_cast<std::uint64_t>(size), "the directory");
  directory.take(entry_bytes, "an entry");
  std::vector<Block> blocks;
  while (directory.remaining() > 0) {
    std::string name = field_text(directory.take(name_bytes, "an entry"));
    const auto type = static_cast<BlockType>(directory.take_number<std::int16_t>("an entry"));
    const auto length = directory.take_number<std::int32_t>("an entry");
    directory.take(2, "an entry");
    if (length < 0) directory.fail(fmt::format("the block \"{}\" has {} bytes", name, length));
    if (length > 0)
      blocks.push_back({std::move(name), type, reader.take_part(static_cast<std::uint64_t>(length), "a block")});
  }
  return blocks;
}

std::optional<double> number_of(const std::vector<Block>& blocks, std::string_view name) {
  for (const Block& block : blocks) {
    ByteReader content = block.content;
    if (block.name != name) continue;
    if (block.type == BlockType::Short) return content.take_number<std::int16_t>(name);
    if (block.type == BlockType::Float) return content.take_number<float>(name);
  }
  return std::nullopt;
}

double positive(const std::filesystem::path& path, const std::vector<Block>& blocks, std::string_view name) {
  const auto value = number_of(blocks, name);
  if (!value) throw FileError(path, "directory", fmt::format("the block {} is missing", name));
  if (!(*value > 0.0) || !std::isfinite(*value)) {
    throw FileError(path, "directory", fmt::format("{} is {}; a positive number belongs there", name, *value));
  }
  return *value;
}

struct Array {
  std::uint64_t columns = 0, rows = 0;
  std::size_t width = 0;  // bytes a sample
  std::span<const std::byte> samples;
  std::size_t offset = 0;
};

Array take_array(const std::filesystem::path& path, const std::vector<Block>& blocks) {
  for (const Block& block : blocks) {
    const bool is_relief = block.name == "RAW_DATA" || block.name == "RAW DATA" || block.name == "OPD";
    if (!is_relief || block.type != BlockType::Array) continue;
    ByteReader content = block.content;
    Array array;
    array.offset = content.offset();
    array.columns = content.take_number<std::uint16_t>("the size of the relief");
    array.rows = content.take_number<std::uint16_t>("the size of the relief");
    array.width = content.take_number<std::uint16_t>("the size of a sample");
    if (array.width != 2 && array.width != 4) {
      content.fail(fmt::format("samples of {} bytes; 2 (integers) and 4 (floats) are read", array.width));
    }
    array.samples = content.take(array.columns * array.rows * array.width, "the relief");
    return array;
  }
  throw FileError(path, "directory", "holds no relief; a block RAW_DATA or OPD is needed");
}

// Heights are counted in wavelengths, as integers in parts of one.
double metres_per_count(const std::filesystem::path& path, const std::vector<Block>& blocks, const Array& array) {
  const double wavelength_m = positive(path, blocks, "Wavelength") * 1e-9;
  return array.width == 2 ? wavelength_m / positive(path, blocks, "Mult") : wavelength_m;
}

double pitch_ratio(const std::filesystem::path& path, const std::vector<Block>& blocks, std::string& assumption) {
  if (number_of(blocks, "Aspect")) return positive(path, blocks, "Aspect");
  add_assumption(assumption, "no Aspect: square samples assumed");
  return 1.0;
}

std::map<std::string, std::string> provenance_of(const std::vector<Block>& blocks) {
  constexpr std::string_view wanted[] = {"Date",         "Time",      "Note",           "MachineID",
                                         "SerialNum",    "MeasMode",  "ObjectiveLabel", "FOVLabel",
                                         "Terms_String", "Filt_Type", "Data_Restore",   "Data_Invert"};
  std::map<std::string, std::string> provenance;
  for (const Block& block : blocks) {
    for (const std::string_view name : wanted) {
      if (block.name != name || block.type != BlockType::Text) continue;
      ByteReader content = block.content;
      const std::string text = field_text(content.take(content.remaining(), name));
      if (!text.empty()) provenance[block.name] = text;
    }
  }
  return provenance;
}

std::string title_of(const std::vector<Block>& blocks) {
  for (const Block& block : blocks) {
    ByteReader content = block.content;
    if (block.name == "Title" && block.type == BlockType::Text)
      return field_text(content.take(content.remaining(), ""));
  }
  return "";
}

double value_of(const Array& array, std::size_t i) {
  const std::byte* const at = array.samples.data() + i * array.width;
  constexpr double missing = std::numeric_limits<double>::quiet_NaN();
  if (array.width == 2) {
    const auto value = little_endian<std::int16_t>(at);
    return value >= least_bad_integer ? missing : value;
  }
  const auto value = little_endian<float>(at);
  return value < least_bad_float ? static_cast<double>(value) : missing;  // NaN too
}

}  // namespace

bool looks_like_opd(std::span<const std::byte> bytes) { return begins_with(bytes, magic); }

// Source   no public specification; layout as read by Gwyddion 2.62 and checked against a file of a Wyko NT1100.
SurfaceFile parse_opd(const std::filesystem::path& path, std::span<const std::byte> bytes) {
  if (!looks_like_opd(bytes)) throw FileError(path, "byte 0", "an .opd file begins with its directory");
  ByteReader reader(path, bytes);
  reader.take(magic_bytes, "the first bytes");
  const std::vector<Block> blocks = take_blocks(reader);
  const Array array = take_array(path, blocks);
  std::string assumption;
  const double pitch_m = positive(path, blocks, "Pixel_size") * 1e-3;
  const Grid grid = checked_grid(path, byte_place(array.offset),
                                 {array.columns, array.rows, pitch_m, pitch_m * pitch_ratio(path, blocks, assumption)});
  const double count_m = metres_per_count(path, blocks, array);
  // Column after column, each from the bottom up.
  const auto height_m = [&](std::size_t i) {
    return value_of(array, i % grid.columns * grid.rows + i / grid.columns) * count_m;
  };
  HeightField field = assemble_heights(path, "relief", grid, FirstRow::Bottom, Continuation::Mirrored, height_m);
  return {std::move(field), "opd", title_of(blocks), provenance_of(blocks), assumption};
}

}  // namespace mezzotint
