#include <algorithm>

#include "fabrication/job/png_picture.h"
#include "fabrication/job/uvj_layout.h"
#include "fabrication/job/zip_archive.h"
#include "forward/base/digest.h"

namespace mezzotint {

namespace {

// The sizes that UVtools gives to the two previews.
constexpr std::size_t tiny_columns = 400, tiny_rows = 400;
constexpr std::size_t huge_columns = 800, huge_rows = 480;

std::string layer_png(const Job& job, const JobLayer& layer) {
  std::vector<std::uint8_t> top_down;
  top_down.reserve(layer.gray.size());
  for (std::size_t row = job.rows; row-- > 0;) {
    const auto begin = layer.gray.begin() + static_cast<std::ptrdiff_t>(row * job.columns);
    top_down.insert(top_down.end(), begin, begin + static_cast<std::ptrdiff_t>(job.columns));
  }
  return encode_png(top_down, job.columns, job.rows, 1);
}

// The last layer, as large as it fits, in the middle of a black RGB picture.
std::string preview_png(const Job& job, std::size_t columns, std::size_t rows) {
  const double scale = std::max(static_cast<double>(job.columns) / static_cast<double>(columns),
                                static_cast<double>(job.rows) / static_cast<double>(rows));
  const auto fitted = [scale](std::size_t pixels, std::size_t most) {
    const auto size = static_cast<std::size_t>(static_cast<double>(pixels) / scale);
    return std::clamp<std::size_t>(size, 1, most);
  };
  const std::size_t width = fitted(job.columns, columns), height = fitted(job.rows, rows);
  const std::size_t left = (columns - width) / 2, top = (rows - height) / 2;
  std::vector<std::uint8_t> picture(columns * rows * 3, 0);
  for (std::size_t y = 0; y < height; ++y) {
    const std::size_t row = job.rows - 1 - y * job.rows / height;
    for (std::size_t x = 0; x < width; ++x) {
      const std::uint8_t gray = job.layers.back().gray[row * job.columns + x * job.columns / width];
      std::fill_n(picture.begin() + static_cast<std::ptrdiff_t>(((top + y) * columns + left + x) * 3), 3, gray);
    }
  }
  return encode_png(picture, columns, rows, 3);
}

// Members as they are added, and their hashes for the manifest.
class UvjBuilder {
public:
  void add(const std::string& name, std::shared_ptr<const std::string> bytes, ZipWriter::Packing packing) {
    hashes_[name] = sha256_hex(std::as_bytes(std::span(*bytes)));
    zip_.add(name, std::move(bytes), packing);
  }
  void add(const std::string& name, std::string bytes, ZipWriter::Packing packing) {
    add(name, std::make_shared<const std::string>(std::move(bytes)), packing);
  }
  [[nodiscard]] const MemberHashes& hashes() const { return hashes_; }
  void write(const std::filesystem::path& path) const { zip_.write(path); }

private:
  ZipWriter zip_;
  MemberHashes hashes_;
};

}  // namespace

void write_uvj(const Job& job, const std::filesystem::path& path) {
  require_valid(job);
  constexpr auto store = ZipWriter::Packing::Store;  // a PNG is packed already
  constexpr auto deflate = ZipWriter::Packing::Deflate;
  UvjBuilder archive;
  archive.add(config_member, write_config(job), deflate);
  archive.add(tiny_preview_member, preview_png(job, tiny_columns, tiny_rows), store);
  archive.add(huge_preview_member, preview_png(job, huge_columns, huge_rows), store);
  std::shared_ptr<const std::string> png;
  for (std::size_t i = 0; i < job.layers.size(); ++i) {
    // The layers of a base are equal; one picture in memory stands for all of them.
    if (i == 0 || job.layers[i].gray != job.layers[i - 1].gray) {
      png = std::make_shared<const std::string>(layer_png(job, job.layers[i]));
    }
    archive.add(slice_member(i), png, store);
  }
  archive.add(manifest_member, write_manifest(job, archive.hashes()), deflate);
  archive.write(path);
}

}  // namespace mezzotint
