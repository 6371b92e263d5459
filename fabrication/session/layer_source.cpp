#include "fabrication/session/layer_source.h"

#include <array>
#include <fstream>
#include <memory>
#include <span>

#include "fabrication/job/job_file.h"
#include "forward/base/digest.h"
#include "forward/base/error.h"

namespace mezzotint {

namespace {

// Piece by piece, since an archive may be larger than the memory: a hash of the hashes.
std::string file_identity(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw FileError(path, "", "cannot be read");
  std::vector<char> piece(std::size_t{1} << 22);
  std::string hashes;
  while (file) {
    file.read(piece.data(), static_cast<std::streamsize>(piece.size()));
    hashes += sha256_hex(std::as_bytes(std::span(piece.data(), static_cast<std::size_t>(file.gcount()))));
  }
  return sha256_hex(std::as_bytes(std::span(hashes.data(), hashes.size())));
}

std::filesystem::path identifying_file(const std::filesystem::path& path) {
  if (!std::filesystem::is_directory(path)) return path;
  const auto manifest = path / "manifest.json";
  return std::filesystem::exists(manifest) ? manifest : path / "config.json";
}

}  // namespace

LayerSource open_layers(const std::filesystem::path& path) {
  auto reader = std::make_shared<JobReader>(path);
  LayerSource source{reader->frame(), file_identity(identifying_file(path)), {}};
  source.read = [reader](std::size_t index) { return reader->read_layer(index); };
  return source;
}

}  // namespace mezzotint
