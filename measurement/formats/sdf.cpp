#include <algorithm>
#include <vector>

#include <fmt/format.h>

#include "forward/base/error.h"
#include "measurement/formats/parsers.h"
#include "measurement/formats/sdf_header.h"

namespace mezzotint {

namespace {

constexpr std::size_t version_bytes = 8;

std::string_view version_of(std::span<const std::byte> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), std::min(bytes.size(), version_bytes)};
}

// ISO 25178-71: y = (i − 1) · Yscale for profile i. The forerunner left the order open; MountainsMap and others show
// its first profile on top.
FirstRow first_row(const SdfHeader& header, std::string& assumption) {
  if (!header.forerunner) return FirstRow::Bottom;
  add_assumption(assumption, "BCR-1.0 does not say where its first profile lies: taken as the top");
  return FirstRow::Top;
}

SurfaceFile finish(const std::filesystem::path& path, SdfHeader& header, const Grid& grid,
                   const std::function<double(std::size_t)>& raw) {
  std::string assumption;
  const FirstRow first = first_row(header, assumption);
  const auto height_m = [&](std::size_t i) { return raw(i) * header.z_scale_m; };
  HeightField field = assemble_heights(path, "data", grid, first, Continuation::Mirrored, height_m);
  return {std::move(field), "sdf", "", std::move(header.provenance), assumption};
}

SurfaceFile parse_binary(const std::filesystem::path& path, SdfHeader header, std::span<const std::byte> bytes) {
  ByteReader reader(path, bytes);
  reader.take(version_bytes, "the version");
  take_sdf_header(header, reader);
  const Grid grid = checked_grid(path, "header", header.grid);
  const std::size_t width = sdf_bytes_of(header.data_type);
  const auto points = reader.take(grid.size() * width, "the data");
  return finish(path, header, grid, [&](std::size_t i) { return sdf_value(header, points.data() + i * width); });
}

std::vector<double> take_points(const SdfHeader& header, const Grid& grid, TextScanner& scanner) {
  // Every number takes a digit and a blank, so that a wrong promise costs no memory.
  if (grid.size() > (scanner.remaining() + 1) / 2) {
    scanner.fail(fmt::format("{} × {} numbers are promised; only {} bytes are left", grid.columns, grid.rows,
                             scanner.remaining()));
  }
  std::vector<double> points(grid.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const std::string_view word = scanner.take_word();
    if (word.empty() || word == "*") {
      scanner.fail(fmt::format("the data end after {} numbers; {} × {} are promised", i, grid.columns, grid.rows));
    }
    points[i] = sdf_value(header, height_of_cell(word, scanner));
  }
  if (scanner.take_word() != "*") {
    scanner.fail(fmt::format("the data do not end in a * after {} × {} numbers", grid.columns, grid.rows));
  }
  return points;
}

SurfaceFile parse_text(const std::filesystem::path& path, SdfHeader header, std::span<const std::byte> bytes) {
  TextScanner scanner(path, bytes);
  take_sdf_header(header, scanner);
  const Grid grid = checked_grid(path, "header", header.grid);
  const std::vector<double> points = take_points(header, grid, scanner);
  return finish(path, header, grid, [&](std::size_t i) { return points[i]; });
}

}  // namespace

bool looks_like_sdf(std::span<const std::byte> bytes) {
  std::string_view version = version_of(bytes);
  if (version.empty() || std::string_view("aAbB").find(version.front()) == std::string_view::npos) return false;
  version.remove_prefix(1);
  return version.starts_with("ISO-") || version.starts_with("BCR-");
}

// Source   ISO 25178-71.
SurfaceFile parse_sdf(const std::filesystem::path& path, std::span<const std::byte> bytes) {
  if (!looks_like_sdf(bytes)) {
    throw FileError(path, "byte 0", "an .sdf file begins with its version, as aISO-1.0 or bISO-2.0");
  }
  const SdfHeader header = sdf_version(path, bytes);
  return header.ascii ? parse_text(path, header, bytes) : parse_binary(path, header, bytes);
}

}  // namespace mezzotint
