#include "measurement/formats/surface_file.h"

#include <algorithm>
#include <charconv>

#include <fmt/format.h>

#include "forward/base/error.h"
#include "forward/base/file_input.h"
#include "measurement/formats/al3d_folder.h"
#include "measurement/formats/parsers.h"
#include "measurement/formats/plain_parsers.h"

namespace mezzotint {

namespace fs = std::filesystem;

namespace {

struct Source {
  fs::path file;
  std::optional<std::uint32_t> channel;
};

// FILE#/N/data, unless there is a file of that name.
Source split_channel(const fs::path& path) {
  std::error_code ignored;
  const std::string text = path.string();
  const std::size_t hash = text.rfind("#/");
  if (hash == std::string::npos || fs::exists(path, ignored)) return {path, {}};
  std::string_view number = std::string_view(text).substr(hash + 2);
  if (number.ends_with("/data")) number.remove_suffix(5);
  std::uint32_t channel = 0;
  const auto [end, problem] = std::from_chars(number.data(), number.data() + number.size(), channel);
  if (number.empty() || problem != std::errc() || end != number.data() + number.size()) {
    throw FileError(path, "", "a channel is named FILE#/N/data, with N a whole number");
  }
  return {text.substr(0, hash), channel};
}

Source source_of(const fs::path& path) {
  return is_al3d_folder(path) ? Source{al3d_of_folder(path), {}} : split_channel(path);
}

SurfaceFile parse_text(const fs::path& path, std::span<const std::byte> bytes) {
  if (path.extension() == ".csv") return parse_csv(path, bytes, read_sidecar(path));
  if (path.extension() == ".xyz") return parse_xyz(path, bytes, read_sidecar(path));
  throw FileError(
      path, "byte 0",
      fmt::format("the first bytes are those of no surface format that is read here; {} are", read_surface_formats));
}

SurfaceFile parse_surface(const Source& source, std::span<const std::byte> bytes) {
  const fs::path& path = source.file;
  if (looks_like_gwy(bytes)) return parse_gwy_channel(path, bytes, source.channel);
  if (source.channel) throw FileError(path, "", "has no channels; #/N/data is for .gwy files");
  if (looks_like_al3d(bytes)) return parse_al3d(path, bytes);
  if (looks_like_x3p(bytes)) return parse_x3p(path, bytes);
  if (looks_like_sur(bytes)) return parse_sur(path, bytes);
  if (looks_like_sdf(bytes)) return parse_sdf(path, bytes);
  if (looks_like_opd(bytes)) return parse_opd(path, bytes);
  if (looks_like_picture(bytes)) return parse_picture(path, bytes, read_sidecar(path));
  return parse_text(path, bytes);
}

}  // namespace

void add_assumption(std::string& assumptions, std::string_view sentence) {
  if (!assumptions.empty()) assumptions += "; ";
  assumptions += sentence;
}

bool has_sidecar(const fs::path& picture) {
  std::error_code ignored;
  return fs::is_regular_file(sidecar_path(picture), ignored);
}

std::vector<fs::path> files_of_surface(const fs::path& path) {
  std::vector<fs::path> files = {source_of(path).file};
  if (has_sidecar(files.front())) files.push_back(sidecar_path(files.front()));
  return files;
}

SurfaceFile read_surface(const fs::path& path, const ReadOptions& options) {
  const bool folder = is_al3d_folder(path);
  const Source source = source_of(path);
  SurfaceFile surface = parse_surface(source, read_file(source.file));
  if (folder) add_al3d_information(path, surface);
  if (options.min_quality) {
    if (surface.format != "al3d") throw FileError(path, "", "has no quality map; only Alicona's folders have one");
    mask_low_quality(source.file.parent_path(), *options.min_quality, surface);
  }
  return surface;
}

std::optional<SampleQuality> sample_quality(const fs::path& path, const SurfaceFile& surface) {
  const fs::path folder = source_of(path).file.parent_path();
  if (surface.format != "al3d" || !has_quality_map(folder)) return {};
  std::vector<std::uint8_t> gray = read_quality_map(folder, surface.field).gray;
  const auto middle = gray.begin() + static_cast<std::ptrdiff_t>(gray.size() / 2);
  std::ranges::nth_element(gray, middle);
  const auto [lowest, highest] = std::ranges::minmax(gray);
  return SampleQuality{lowest, *middle, highest};
}

SurfaceFile read_gwy(const fs::path& path) { return parse_gwy(path, read_file(path)); }

}  // namespace mezzotint
