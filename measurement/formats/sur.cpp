#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "forward/base/error.h"
#include "measurement/formats/byte_reader.h"
#include "measurement/formats/height_assembly.h"
#include "measurement/formats/parsers.h"
#include "measurement/formats/sur_layout.h"
#include "measurement/formats/text_values.h"
#include "measurement/formats/zlib_stream.h"

namespace mezzotint {

namespace {

using Bytes = std::span<const std::byte>;

class SurHeader {
public:
  SurHeader(const std::filesystem::path& path, Bytes bytes) : path_(path), bytes_(bytes) {}

  template <class Number>
  [[nodiscard]] Number number(std::size_t at) const {
    return little_endian<Number>(bytes_.data() + at);
  }
  [[nodiscard]] std::string text(std::size_t at, std::size_t size) const {
    const std::string_view field(reinterpret_cast<const char*>(bytes_.data()) + at, size);
    return clean_text(utf8_or_latin1(field.substr(0, field.find('\0'))));
  }
  [[nodiscard]] bool compressed() const { return text(0, sur::magic_plain.size()) == sur::magic_compressed; }
  [[nodiscard]] std::uint64_t count(std::size_t at, std::string_view what) const {
    const auto value = number<std::int32_t>(at);
    if (value <= 0) fail(at, fmt::format("{} is {}; it must be positive", what, value));
    return static_cast<std::uint64_t>(value);
  }
  // 0: x, 1: y, 2: z. A step times the unit of the step, in metres.
  [[nodiscard]] double step_m(std::size_t axis) const {
    return unit_m(axis) * static_cast<double>(number<float>(sur::at_step_x + 4 * axis));
  }
  [[nodiscard]] double unit_m(std::size_t axis) const {
    const std::size_t at = sur::at_step_units + axis * sur::text_bytes;
    const std::string unit = text(at, sur::text_bytes);
    const auto metres = metres_of_unit(unit);
    if (!metres || unit.empty()) {
      fail(at, fmt::format("the unit of the {} step is \"{}\"; m, mm, µm, nm or pm is needed", "xyz"[axis], unit));
    }
    return *metres;
  }
  [[noreturn]] void fail(std::size_t at, const std::string& problem) const {
    throw FileError(path_, byte_place(at), problem);
  }

private:
  const std::filesystem::path& path_;
  Bytes bytes_;
};

void require_surface(const SurHeader& header, std::string& assumption) {
  const auto format = header.number<std::int16_t>(sur::at_format);
  if (format != 0) {
    header.fail(sur::at_format, fmt::format("the byte order is {}; only 0 (little-endian) is read", format));
  }
  const int type = header.number<std::int16_t>(sur::at_type);
  const auto objects = header.number<std::int16_t>(sur::at_objects);
  const bool with_pictures = type == sur::type_surface_and_intensity || type == sur::type_surface_and_colour ||
                             type == sur::type_surface_and_both;
  // Gwyddion has written surfaces as profiles.
  const bool several_lines = type == sur::type_profile && header.number<std::int32_t>(sur::at_rows) > 1;
  if (type != sur::type_surface && !with_pictures && !several_lines) {
    header.fail(sur::at_type, fmt::format("it holds a studiable of type {}; 2 (a surface) is read, and 11, 13 and 16 "
                                          "(a surface with pictures)",
                                          type));
  }
  if (several_lines) add_assumption(assumption, "says that it is a profile but has several lines: read as a surface");
  if (objects > 1) add_assumption(assumption, fmt::format("the first of {} objects is the relief", objects));
}

std::size_t bytes_a_point(const SurHeader& header) {
  const auto bits = header.number<std::int16_t>(sur::at_bits);
  if (bits != 16 && bits != 32) header.fail(sur::at_bits, fmt::format("{} bits a point; 16 or 32 are read", bits));
  return static_cast<std::size_t>(bits) / 8;
}

PromisedGrid promised_grid(const SurHeader& header) {
  const PromisedGrid grid{header.count(sur::at_columns, "the number of points a line"),
                          header.count(sur::at_rows, "the number of lines"), header.step_m(0), header.step_m(1)};
  const std::uint64_t points = header.count(sur::at_points, "the number of points");
  if (points != grid.columns * grid.rows) {
    header.fail(sur::at_points, fmt::format("{} points, but {} × {} are {}", points, grid.columns, grid.rows,
                                            grid.columns * grid.rows));
  }
  return grid;
}

struct Stream {
  std::uint32_t unpacked = 0, packed = 0;
};

// A number of streams, the two lengths of each, and then the streams, which follow each other when unpacked.
std::vector<Stream> take_directory(ByteReader& reader, std::uint64_t needed) {
  const auto count = reader.take_number<std::uint32_t>("the number of streams");
  if (count == 0 || count > reader.remaining() / 8) {
    reader.fail(fmt::format("{} streams; there must be at least one, and each takes more than 8 bytes", count));
  }
  std::vector<Stream> streams(count);
  std::uint64_t unpacked = 0;
  for (Stream& stream : streams) {
    stream.unpacked = reader.take_number<std::uint32_t>("the length of a stream");
    stream.packed = reader.take_number<std::uint32_t>("the packed length of a stream");
    if (stream.unpacked / best_deflate_ratio > stream.packed) {
      reader.fail(fmt::format("a stream claims to unpack to {} bytes from {}, which deflate cannot do", stream.unpacked,
                              stream.packed));
    }
    unpacked += stream.unpacked;
  }
  if (unpacked != needed) {
    reader.fail(fmt::format("the streams unpack to {} bytes; the points need {}", unpacked, needed));
  }
  return streams;
}

std::vector<std::byte> unpack(ByteReader reader, const SurHeader& header, std::uint64_t needed) {
  const auto promised = header.number<std::uint32_t>(sur::at_compressed_size);
  const std::size_t start = reader.offset();
  const auto streams = take_directory(reader, needed);
  // Each stream is looked for before memory is taken for all.
  std::vector<Bytes> packed;
  packed.reserve(streams.size());
  for (const Stream& stream : streams) packed.push_back(reader.take(stream.packed, "a packed stream"));
  const std::size_t taken = reader.offset() - start;
  if (promised != 0 && promised != taken) {
    header.fail(sur::at_compressed_size, fmt::format("promises {} packed bytes; there are {}", promised, taken));
  }
  std::vector<std::byte> points(needed);
  std::size_t at = 0;
  for (std::size_t i = 0; i < streams.size(); ++i) {
    const std::string problem = inflate_exactly(packed[i], std::span(points).subspan(at, streams[i].unpacked));
    if (!problem.empty()) {
      throw FileError(reader.path(), fmt::format("stream {} of {}", i + 1, streams.size()), problem);
    }
    at += streams[i].unpacked;
  }
  return points;
}

std::string date_of(const SurHeader& header) {
  const auto part = [&](std::size_t i) { return header.number<std::int16_t>(sur::at_date + 2 * i); };
  if (part(5) <= 0) return "";
  return fmt::format("{:04}-{:02}-{:02} {:02}:{:02}:{:02}", part(5), part(4), part(3), part(2), part(1), part(0));
}

std::map<std::string, std::string> provenance_of(const SurHeader& header, Bytes comment) {
  const std::string_view text(reinterpret_cast<const char*>(comment.data()), comment.size());
  std::map<std::string, std::string> provenance = {
      {"operator", header.text(sur::at_operator, sur::name_bytes)},
      {"date", date_of(header)},
      {"comment", clean_text(utf8_or_latin1(text.substr(0, text.find('\0'))))}};
  std::erase_if(provenance, [](const auto& entry) { return entry.second.empty(); });
  return provenance;
}

std::uint64_t zone_bytes(const SurHeader& header, std::size_t at) {
  const auto size = header.number<std::int16_t>(at);
  if (size < 0) header.fail(at, fmt::format("a zone of {} bytes", size));
  return static_cast<std::uint64_t>(size);
}

HeightField assemble(const std::filesystem::path& path, const SurHeader& header, const Grid& grid, Bytes points,
                     std::size_t width) {
  const bool has_marker = header.number<std::int16_t>(sur::at_non_measured) == 1;
  const std::int64_t marker =
      std::int64_t{header.number<std::int32_t>(sur::at_lowest)} - sur::non_measured_below_lowest;
  const double step_m = header.step_m(2);
  const double offset_m = header.unit_m(2) * static_cast<double>(header.number<float>(sur::at_offset_z));
  if (!std::isfinite(step_m) || step_m == 0.0 || !std::isfinite(offset_m)) {
    header.fail(sur::at_step_z, fmt::format("a step of {} m and an offset of {} m in z; numbers belong there, and the "
                                            "step is not 0",
                                            step_m, offset_m));
  }
  const auto height_m = [&](std::size_t i) {
    const std::byte* const at = points.data() + i * width;
    const std::int64_t raw = width == 2 ? little_endian<std::int16_t>(at) : little_endian<std::int32_t>(at);
    if (has_marker && raw == marker) return std::numeric_limits<double>::quiet_NaN();
    return static_cast<double>(raw) * step_m + offset_m;
  };
  return assemble_heights(path, "points", grid, FirstRow::Top, Continuation::Mirrored, height_m);
}

}  // namespace

bool looks_like_sur(Bytes bytes) {
  return begins_with(bytes, sur::magic_plain) || begins_with(bytes, sur::magic_compressed);
}

SurfaceFile parse_sur(const std::filesystem::path& path, Bytes bytes) {
  if (!looks_like_sur(bytes)) {
    throw FileError(path, "byte 0", "a .sur file begins with \"DIGITAL SURF\" or \"DSCOMPRESSED\"");
  }
  ByteReader reader(path, bytes);
  const SurHeader header(path, reader.take(sur::header_bytes, "the header"));
  std::string assumption;
  require_surface(header, assumption);
  const std::size_t width = bytes_a_point(header);
  const Grid grid = checked_grid(path, "header", promised_grid(header));
  const Bytes comment = reader.take(zone_bytes(header, sur::at_comment_bytes), "the comment");
  reader.take(zone_bytes(header, sur::at_private_bytes), "the private zone");
  const std::vector<std::byte> unpacked =
      header.compressed() ? unpack(reader, header, grid.size() * width) : std::vector<std::byte>{};
  const Bytes points = header.compressed() ? Bytes(unpacked) : reader.take(grid.size() * width, "the points");
  return {assemble(path, header, grid, points, width), "sur", header.text(sur::at_name, sur::name_bytes),
          provenance_of(header, comment), assumption};
}

}  // namespace mezzotint
