#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <limits>
#include <string>

#include <fmt/format.h>

#include "forward/base/error.h"
#include "measurement/formats/al3d_layout.h"
#include "measurement/formats/byte_reader.h"
#include "measurement/formats/height_assembly.h"
#include "measurement/formats/parsers.h"
#include "measurement/formats/text_values.h"

namespace mezzotint {

namespace {

using al3d::key_bytes, al3d::magic, al3d::tag_bytes, al3d::value_bytes;

// The invalid value stands as text with fewer digits than a float has.
constexpr double marker_tolerance = 1.5e-7;
// No surface has such heights, but every marker seen so far does (±3e15).
constexpr double least_obvious_marker = 1e15;

using Tags = std::map<std::string, std::string, std::less<>>;

// What follows the first NUL of a key or value is garbage in files of some versions.
std::string up_to_nul(std::span<const std::byte> bytes) {
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  return std::string(text.substr(0, text.find('\0')));
}

std::string take_tag(ByteReader& reader, Tags& tags) {
  auto record = reader.take(tag_bytes, "a header record");
  std::string key = up_to_nul(record.first(key_bytes));
  tags[key] = up_to_nul(record.subspan(key_bytes, value_bytes));
  return key;
}

// Two records, of which the second counts those that follow.
Tags take_tags(ByteReader& reader) {
  Tags tags;
  for (const std::string_view expected : {"Version", "TagCount"}) {
    const std::size_t offset = reader.offset();
    if (take_tag(reader, tags) != expected) {
      throw FileError(reader.path(), byte_place(offset), fmt::format("the record \"{}\" must stand here", expected));
    }
  }
  const auto count = to_count(tags["TagCount"]);
  if (!count || *count > reader.remaining() / tag_bytes) {
    reader.fail(
        fmt::format("TagCount is \"{}\"; it must be the number of records of {} bytes that follow, and {} bytes do",
                    clean_text(tags["TagCount"]), tag_bytes, reader.remaining()));
  }
  for (std::uint64_t i = 0; i < *count; ++i) take_tag(reader, tags);
  return tags;
}

const std::string& tag(const std::filesystem::path& path, const Tags& tags, std::string_view key) {
  const auto found = tags.find(key);
  if (found == tags.end()) throw FileError(path, "header", fmt::format("the record {} is missing", key));
  return found->second;
}

std::uint64_t count_tag(const std::filesystem::path& path, const Tags& tags, std::string_view key) {
  const std::string& text = tag(path, tags, key);
  const auto value = to_count(text);
  if (!value)
    throw FileError(path, "header", fmt::format("{} is \"{}\"; a whole number belongs there", key, clean_text(text)));
  return *value;
}

double number_tag(const std::filesystem::path& path, const Tags& tags, std::string_view key) {
  const std::string& text = tag(path, tags, key);
  const auto value = to_number(text);
  if (!value)
    throw FileError(path, "header", fmt::format("{} is \"{}\"; a number belongs there", key, clean_text(text)));
  return *value;
}

// Where the depth image must end: at the next block, or with the file. 0 means that there is no such block.
std::uint64_t end_of_depth(const std::filesystem::path& path, const Tags& tags, std::uint64_t depth,
                           std::uint64_t size) {
  std::uint64_t end = size;
  for (const std::string_view key : {"TextureImageOffset", "IconOffset"}) {
    if (tags.find(key) == tags.end()) continue;
    const std::uint64_t offset = count_tag(path, tags, key);
    if (offset > size) {
      throw FileError(path, "header",
                      fmt::format("{} is {}, but the file has only {} bytes; it was cut short", key, offset, size));
    }
    if (offset > depth) end = std::min(end, offset);
  }
  return end;
}

struct DepthImage {
  std::span<const std::byte> bytes;
  std::size_t stride = 0;
};

// Writers disagree whether a row of odd width is padded to a multiple of 8 bytes; the room between the offsets
// tells. An image of even width has one stride only.
std::size_t depth_stride(const std::filesystem::path& path, const Grid& grid, std::uint64_t depth, std::uint64_t room,
                         std::string& assumption) {
  const std::uint64_t packed = 4 * grid.columns, padded = (packed + 7) / 8 * 8;
  if (room == packed * grid.rows) return packed;
  if (room >= padded * grid.rows) {
    if (room > padded * grid.rows && padded != packed) {
      add_assumption(assumption,
                     fmt::format("rows of {} heights: padding to a multiple of 8 bytes assumed", grid.columns));
    }
    return padded;
  }
  throw FileError(path, byte_place(depth),
                  fmt::format("the depth image has {} bytes; {} × {} heights need {} (or {} with padded rows)", room,
                              grid.columns, grid.rows, packed * grid.rows, padded * grid.rows));
}

DepthImage locate_depth(const std::filesystem::path& path, const Tags& tags, const Grid& grid, std::size_t header_end,
                        std::span<const std::byte> bytes, std::string& assumption) {
  const std::uint64_t depth = count_tag(path, tags, "DepthImageOffset");
  if (depth < header_end || depth > bytes.size()) {
    throw FileError(path, "header",
                    fmt::format("DepthImageOffset is {}; it must lie behind the header ({}) and within the file ({}). "
                                "A file without a depth image holds no heights",
                                depth, header_end, bytes.size()));
  }
  const std::uint64_t room = end_of_depth(path, tags, depth, bytes.size()) - depth;
  const std::size_t stride = depth_stride(path, grid, depth, room, assumption);
  return {bytes.subspan(depth, room), stride};
}

// The value of a sample that the instrument did not see; NaN where the file names none. Microsoft's C library
// writes NaN as "1.#QNAN" and the like.
double invalid_marker(const std::filesystem::path& path, const Tags& tags) {
  const auto found = tags.find("InvalidPixelValue");
  const bool named = found != tags.end() && found->second.find('#') == std::string::npos;
  return named ? number_tag(path, tags, "InvalidPixelValue") : std::numeric_limits<double>::quiet_NaN();
}

bool is_missing(double z, double marker) {
  if (!(std::abs(z) <= least_obvious_marker)) return true;  // NaN too
  return std::abs(z - marker) <= marker_tolerance * std::abs(marker);
}

// Of files that Mezzotint wrote; in all others heights are absolute.
double written_datum_m(const std::filesystem::path& path, const Tags& tags) {
  if (tags.find(al3d::datum_key) == tags.end()) return 0.0;
  const double datum_m = number_tag(path, tags, al3d::datum_key);
  if (!std::isfinite(datum_m)) throw FileError(path, "header", fmt::format("{} is {} m", al3d::datum_key, datum_m));
  return datum_m;
}

std::map<std::string, std::string> provenance_of(const Tags& tags) {
  std::map<std::string, std::string> provenance;
  for (const std::string_view key : {"CreatingApplication", "Version", "DepthResShiftVal", "DepthResFilterVal"}) {
    const auto found = tags.find(key);
    if (found != tags.end()) provenance[std::string(key)] = clean_text(found->second);
  }
  return provenance;
}

}  // namespace

bool looks_like_al3d(std::span<const std::byte> bytes) { return begins_with(bytes, magic); }

SurfaceFile parse_al3d(const std::filesystem::path& path, std::span<const std::byte> bytes) {
  if (!looks_like_al3d(bytes)) throw FileError(path, "byte 0", "an .al3d file begins with \"AliconaImaging\"");
  ByteReader reader(path, bytes);
  reader.take(magic.size(), "the first line");
  const Tags tags = take_tags(reader);
  const Grid grid =
      checked_grid(path, "header",
                   {count_tag(path, tags, "Cols"), count_tag(path, tags, "Rows"),
                    number_tag(path, tags, "PixelSizeXMeter"), number_tag(path, tags, "PixelSizeYMeter")});
  std::string assumption;
  const DepthImage depth = locate_depth(path, tags, grid, reader.offset(), bytes, assumption);
  const double marker = invalid_marker(path, tags);
  const double datum_m = written_datum_m(path, tags);
  const auto height_m = [&](std::size_t i) {
    const std::size_t place = i / grid.columns * depth.stride + i % grid.columns * sizeof(float);
    const double z = little_endian<float>(depth.bytes.data() + place);
    return is_missing(z, marker) ? std::numeric_limits<double>::quiet_NaN() : z + datum_m;
  };
  // The first row is the top of the picture that the instrument shows.
  HeightField field = assemble_heights(path, "depth image", grid, FirstRow::Top, Continuation::Mirrored, height_m);
  return {std::move(field), "al3d", "", provenance_of(tags), assumption};
}

}  // namespace mezzotint
