#include "forward/base/file_input.h"

#include <fstream>

#include "forward/base/error.h"

namespace mezzotint {

std::vector<std::byte> read_file(const std::filesystem::path& path) {
  std::error_code problem;
  if (!std::filesystem::exists(path, problem)) throw FileError(path, "", "no such file");
  if (!std::filesystem::is_regular_file(path, problem)) throw FileError(path, "", "is not a regular file");
  const std::uintmax_t size = std::filesystem::file_size(path, problem);
  if (problem) throw FileError(path, "", problem.message());
  if (size == 0) throw FileError(path, "", "is empty");
  if (size > largest_input_bytes) {
    throw FileError(path, "", "has " + std::to_string(size) + " bytes; files up to 4 GiB are read");
  }
  std::ifstream stream(path, std::ios::binary);
  if (!stream) throw FileError(path, "", "cannot be opened for reading");
  std::vector<std::byte> bytes(size);
  stream.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(size));
  if (static_cast<std::uintmax_t>(stream.gcount()) != size) throw FileError(path, "", "cannot be read to its end");
  return bytes;
}

}  // namespace mezzotint
