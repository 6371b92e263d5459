#include "fabrication/part/three_mf_package.h"

#include <algorithm>
#include <map>
#include <memory>
#include <string>
#include <string_view>

#include <fmt/format.h>
#include <zip.h>

#include "forward/base/error.h"

namespace mezzotint {

namespace {

// A model of 2^28 triangles as text is larger; this one takes minutes to read already.
constexpr std::uint64_t largest_unpacked = std::uint64_t{4} << 30U;

struct Discard {
  void operator()(zip_t* archive) const { zip_discard(archive); }
};

struct Close {
  void operator()(zip_file_t* member) const { zip_fclose(member); }
};

/// What is unpacked of a member; less than it claims where it is damaged, which the library will find.
std::string unpacked_text(zip_t* archive, zip_uint64_t index, std::uint64_t size) {
  std::string text;
  const std::unique_ptr<zip_file_t, Close> member(zip_fopen_index(archive, index, 0));
  while (member && text.size() < size) {
    constexpr std::uint64_t piece = 1U << 20U;
    const std::size_t begin = text.size();
    text.resize(begin + std::min(piece, size - begin));
    const zip_int64_t got = zip_fread(member.get(), text.data() + begin, text.size() - begin);
    text.resize(begin + static_cast<std::size_t>(std::max<zip_int64_t>(got, 0)));
    if (got <= 0) break;
  }
  return text;
}

std::string_view attribute_of(std::string_view tag, std::string_view name) {
  const std::size_t at = tag.find(name);
  if (at == std::string_view::npos) return {};
  const std::string_view rest = tag.substr(at + name.size());
  const std::size_t open = rest.find_first_of("\"'");
  if (open == std::string_view::npos) return {};
  const std::size_t close = rest.find(rest[open], open + 1);
  return close == std::string_view::npos ? std::string_view{} : rest.substr(open + 1, close - open - 1);
}

bool names(std::string_view tag, std::string_view wanted) {
  std::string_view name = tag.substr(0, tag.find_first_of(" \t\r\n/"));
  if (const std::size_t colon = name.find(':'); colon != std::string_view::npos) name.remove_prefix(colon + 1);
  return name == wanted;
}

// Objects come before the components that name them.
bool multiplies_without_bounds(std::string_view model) {
  std::map<std::string_view, std::size_t> instances;
  std::size_t* current = nullptr;
  for (std::size_t open = model.find('<'); open != std::string_view::npos; open = model.find('<', open + 1)) {
    const std::string_view tag = model.substr(open + 1, model.find('>', open) - open - 1);
    if (names(tag, "object")) {
      current = &instances[attribute_of(tag, " id")];
      *current = 1;
    } else if (current != nullptr && names(tag, "component")) {
      const auto held = instances.find(attribute_of(tag, "objectid"));
      *current += held == instances.end() ? 1 : held->second;
      if (*current > most_instances) return true;
    }
  }
  return false;
}

}  // namespace

void check_three_mf_package(const std::filesystem::path& path, std::span<const std::byte> bytes) {
  zip_error_t error;
  zip_error_init(&error);
  zip_source_t* source = zip_source_buffer_create(bytes.data(), bytes.size(), 0, &error);
  std::unique_ptr<zip_t, Discard> archive(source != nullptr ? zip_open_from_source(source, ZIP_RDONLY, &error)
                                                            : nullptr);
  if (!archive) {
    if (source != nullptr) zip_source_free(source);
    const std::string problem = zip_error_strerror(&error);
    zip_error_fini(&error);
    throw FileError(path, "", fmt::format("is no 3MF, which is a zip archive: {}", problem));
  }
  zip_error_fini(&error);
  std::uint64_t unpacked = 0;
  const zip_int64_t count = zip_get_num_entries(archive.get(), 0);
  for (zip_int64_t k = 0; k < count; ++k) {
    zip_stat_t entry;
    zip_stat_init(&entry);
    if (zip_stat_index(archive.get(), static_cast<zip_uint64_t>(k), 0, &entry) != 0) continue;
    if ((entry.valid & ZIP_STAT_SIZE) == 0 || entry.size > largest_unpacked - unpacked)
      throw FileError(path, "", "holds more than 4 GiB unpacked; a 3MF up to that is read");
    unpacked += entry.size;
    const std::string_view name = (entry.valid & ZIP_STAT_NAME) != 0 ? entry.name : "";
    if (!name.ends_with(".model")) continue;
    if (multiplies_without_bounds(unpacked_text(archive.get(), static_cast<zip_uint64_t>(k), entry.size))) {
      throw FileError(path, name,
                      fmt::format("has components in components that make more than {} objects", most_instances));
    }
  }
}

}  // namespace mezzotint
