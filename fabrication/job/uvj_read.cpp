#include <fmt/format.h>

#include <algorithm>

#include "fabrication/job/png_picture.h"
#include "fabrication/job/uvj_layout.h"
#include "fabrication/job/zip_archive.h"
#include "forward/base/digest.h"

namespace mezzotint {

namespace {

// Members besides the slices that an archive of another program may hold.
constexpr std::size_t most_other_members = 1000;

// A JSON file grows with the number of layers; what is larger than that is a bomb.
std::uint64_t most_json_bytes(std::size_t member_count) {
  return (64U << 10U) + (std::uint64_t{4} << 10U) * member_count;
}

// Rows of a PNG have one byte more than pixels, and deflate may add a thousandth; the rest is for other chunks.
std::uint64_t most_png_bytes(const Job& job) {
  const std::uint64_t raw = (job.columns + 1) * job.rows;
  return raw + raw / 100 + (1U << 20U);
}

constexpr std::uint64_t most_preview_bytes = std::uint64_t{64} << 20U;

class UvjArchive {
public:
  explicit UvjArchive(const std::filesystem::path& path)
      : path_(path), zip_(path, largest_layer_count + most_other_members), names_(zip_.names()) {}

  [[nodiscard]] Job read() {
    const std::uint64_t most_bytes = most_json_bytes(names_.size());
    const std::vector<std::byte> config = zip_.read(config_member, most_bytes);
    Job job = read_config(config, place(config_member));
    job.name = path_.stem().string();
    if (zip_.has(manifest_member)) {
      hashes_ = read_manifest(zip_.read(manifest_member, most_bytes), place(manifest_member), job);
      check_list();
      check_hash(config_member, config);
      check_previews();
    }
    check_slice_count(job.layers.size());
    for (std::size_t i = 0; i < job.layers.size(); ++i) job.layers[i].gray = read_slice(job, i);
    return job;
  }

private:
  [[nodiscard]] MemberPlace place(const std::string& member) const { return {path_, member}; }

  // Every member is listed in the manifest, and every listed one is there.
  void check_list() const {
    for (const auto& [name, hash] : hashes_) {
      if (!zip_.has(name)) place(name).refuse("is listed in manifest.json but missing from the archive");
    }
    for (const std::string& name : names_) {
      if (name != manifest_member && !hashes_.contains(name)) place(name).refuse("is not listed in manifest.json");
    }
  }

  void check_hash(const std::string& member, std::span<const std::byte> bytes) const {
    if (hashes_.empty()) return;
    if (sha256_hex(bytes) != hashes_.at(member)) {
      place(member).refuse("does not have the SHA-256 of manifest.json; the archive was changed or damaged");
    }
  }

  // Whatever is no slice and has a hash; nothing of it is used.
  void check_previews() const {
    for (const auto& [name, hash] : hashes_) {
      if (name == config_member || name.starts_with("slice/")) continue;
      check_hash(name, zip_.read(name, most_preview_bytes));
    }
  }

  void check_slice_count(std::size_t layer_count) const {
    const auto slices = static_cast<std::size_t>(std::count_if(names_.begin(), names_.end(), [](const auto& name) {
      return name.starts_with("slice/") && name.ends_with(".png");
    }));
    if (slices > layer_count) {
      place("slice").refuse(fmt::format("holds {} pictures; config.json says {} layers", slices, layer_count));
    }
  }

  [[nodiscard]] std::vector<std::uint8_t> read_slice(const Job& job, std::size_t index) const {
    const std::string member = slice_member(index);
    const std::vector<std::byte> png = zip_.read(member, most_png_bytes(job));
    check_hash(member, png);
    std::vector<std::uint8_t> gray = decode_gray_png(png, job.columns, job.rows, place(member));
    for (std::size_t row = 0; row < job.rows / 2; ++row) {
      const auto low = gray.begin() + static_cast<std::ptrdiff_t>(row * job.columns);
      const auto high = gray.begin() + static_cast<std::ptrdiff_t>((job.rows - 1 - row) * job.columns);
      std::swap_ranges(low, low + static_cast<std::ptrdiff_t>(job.columns), high);
    }
    return gray;
  }

  std::filesystem::path path_;
  ZipReader zip_;
  std::vector<std::string> names_;
  MemberHashes hashes_;
};

}  // namespace

Job read_uvj(const std::filesystem::path& path) {
  Job job = UvjArchive(path).read();
  try {
    require_valid(job);
  } catch (const InvalidInput& error) {
    throw FileError(path, config_member, error.what());
  }
  return job;
}

}  // namespace mezzotint
