#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "forward/base/digest.h"
#include "forward/base/error.h"
#include "measurement/formats/byte_reader.h"
#include "measurement/formats/height_assembly.h"
#include "measurement/formats/parsers.h"
#include "measurement/formats/text_values.h"
#include "measurement/formats/x3p_archive.h"
#include "measurement/formats/x3p_document.h"

namespace mezzotint {

namespace {

// Room for a million heights as text; the parsed tree of a hostile text takes up to 16 times as much memory.
constexpr std::uint64_t largest_xml = std::uint64_t{32} << 20;

std::size_t bytes_of(char data_type) { return data_type == 'I' ? 2 : data_type == 'D' ? 8 : 4; }

double raw_value(char data_type, const std::byte* bytes) {
  switch (data_type) {
    case 'I':
      return little_endian<std::int16_t>(bytes);
    case 'L':
      return little_endian<std::int32_t>(bytes);
    case 'F':
      return little_endian<float>(bytes);
    default:
      return little_endian<double>(bytes);
  }
}

std::string lower_case(std::string_view text) {
  std::string lower(text);
  for (char& c : lower) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return lower;
}

void require_checksum(const std::filesystem::path& path, const std::string& member, std::span<const std::byte> bytes,
                      const std::string& expected) {
  if (expected.empty()) return;
  const std::string actual = md5_hex(bytes);
  if (lower_case(expected) == actual) return;
  throw FileError(
      path, member,
      fmt::format("its MD5 is {}, but main.xml says {}; the data are damaged", actual, clean_text(expected)));
}

std::vector<std::byte> read_points(const std::filesystem::path& path, const X3pArchive& archive,
                                   const X3pDocument& document, const Grid& grid) {
  const std::string reason =
      fmt::format("{} × {} points of type {}", grid.columns, grid.rows, document.height_axis.data_type);
  auto points =
      archive.read_exactly(document.data_link, grid.size() * bytes_of(document.height_axis.data_type), reason);
  require_checksum(path, document.data_link, points, document.data_md5);
  return points;
}

// One bit a point, the lowest bit of the first byte first; 1 is valid. Empty: no such member, all are.
std::vector<std::byte> read_validity(const std::filesystem::path& path, const X3pArchive& archive,
                                     const X3pDocument& document, const Grid& grid) {
  if (document.valid_link.empty()) return {};
  const std::string reason = fmt::format("{} × {} points at one bit each", grid.columns, grid.rows);
  auto bits = archive.read_exactly(document.valid_link, (grid.size() + 7) / 8, reason);
  require_checksum(path, document.valid_link, bits, document.valid_md5);
  return bits;
}

bool is_valid(std::span<const std::byte> bits, std::size_t i) {
  return bits.empty() || std::to_integer<bool>(bits[i / 8] >> (i % 8) & std::byte{1});
}

// The checksum of main.xml itself is wrong in files of some writers, and zip has its own: say it, but read on.
void note_document_checksum(const X3pArchive& archive, std::span<const std::byte> xml, SurfaceFile& surface) {
  constexpr std::uint64_t largest_checksum_file = 1024;
  const std::string member = "md5checksum.hex";
  if (!archive.has(member)) return;
  const auto bytes = archive.read(member, largest_checksum_file);
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  const bool matches = lower_case(text.substr(0, 32)) == md5_hex(xml);
  if (!matches) surface.provenance["checksum of main.xml"] = "does not match md5checksum.hex";
}

HeightField assemble(const std::filesystem::path& path, const X3pArchive& archive, const X3pDocument& document) {
  const Grid grid = checked_grid(path, "main.xml", document.grid);
  const X3pHeightAxis& axis = document.height_axis;
  const bool listed = document.data_link.empty();
  const auto points = listed ? std::vector<std::byte>{} : read_points(path, archive, document, grid);
  const auto validity = listed ? std::vector<std::byte>{} : read_validity(path, archive, document, grid);
  const std::size_t width = bytes_of(axis.data_type);
  const auto height_m = [&](std::size_t i) {
    const double raw = listed ? document.values[i] : raw_value(axis.data_type, points.data() + i * width);
    // Alicona's export marks missing points by +Inf, openGPS by NaN.
    if (!std::isfinite(raw) || !is_valid(validity, i)) return std::numeric_limits<double>::quiet_NaN();
    return raw * axis.increment + axis.offset;
  };
  // The standard's y grows with the row, as ours does: no flip.
  return assemble_heights(path, listed ? "main.xml" : document.data_link, grid, FirstRow::Bottom,
                          Continuation::Mirrored, height_m);
}

}  // namespace

bool looks_like_x3p(std::span<const std::byte> bytes) { return begins_with(bytes, "PK\x03\x04"); }

SurfaceFile parse_x3p(const std::filesystem::path& path, std::span<const std::byte> bytes) {
  if (!looks_like_x3p(bytes)) throw FileError(path, "byte 0", "an .x3p file is a zip archive and begins with \"PK\"");
  const X3pArchive archive(path, bytes);
  if (!archive.has("main.xml"))
    throw FileError(path, "", "has no member main.xml; a zip archive without it is no X3P file");
  const auto xml = archive.read("main.xml", largest_xml);
  X3pDocument document = parse_x3p_document(path, xml);
  SurfaceFile surface{assemble(path, archive, document), "x3p", "", std::move(document.provenance),
                      document.assumption};
  note_document_checksum(archive, xml, surface);
  return surface;
}

}  // namespace mezzotint
