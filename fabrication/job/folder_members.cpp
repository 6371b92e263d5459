#include "fabrication/job/folder_members.h"

#include <fmt/format.h>
#include <unistd.h>

#include <fstream>

#include "fabrication/job/member_place.h"
#include "forward/base/error.h"

namespace mezzotint {

namespace fs = std::filesystem;

namespace {

// "jobs/gear/" is a folder named "gear".
fs::path without_trailing_slash(const fs::path& path) { return path.has_filename() ? path : path.parent_path(); }

[[noreturn]] void fail(const fs::path& path, const std::error_code& problem) {
  throw DeviceError("cannot write " + path.string() + ": " + problem.message());
}

}  // namespace

FolderWriter::FolderWriter(const fs::path& path) : path_(without_trailing_slash(path)) {
  temporary_ = path_.parent_path() / ("." + path_.filename().string() + ".part" + std::to_string(::getpid()));
  std::error_code problem;
  const bool is_free =
      !fs::exists(path_, problem) || (fs::is_directory(path_, problem) && fs::is_empty(path_, problem));
  require(is_free, path_.string() + ": is there already; name a folder that is new or empty");
  fs::create_directory(temporary_, problem);
  if (problem) fail(path_, problem);
}

FolderWriter::~FolderWriter() {
  std::error_code ignored;
  if (!temporary_.empty()) fs::remove_all(temporary_, ignored);
}

void FolderWriter::add(const std::string& name, std::string_view bytes, Packing) {
  const fs::path file = temporary_ / name;
  std::error_code problem;
  fs::create_directories(file.parent_path(), problem);
  if (problem) fail(path_, problem);
  std::ofstream stream(file, std::ios::binary);
  stream.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  if (!stream.flush()) throw DeviceError("cannot write " + (path_ / name).string() + ": is the disk full?");
}

void FolderWriter::close() {
  std::error_code problem;
  fs::rename(temporary_, path_, problem);
  if (problem) fail(path_, problem);
  temporary_.clear();
}

FolderReader::FolderReader(const fs::path& path, std::size_t most_members) : path_(without_trailing_slash(path)) {
  std::error_code problem;
  fs::recursive_directory_iterator files(path_, problem);
  if (problem) throw FileError(path_, "", "cannot be read as a folder (" + problem.message() + ")");
  for (const fs::recursive_directory_iterator end; files != end; files.increment(problem)) {
    if (!files->is_regular_file(problem)) continue;
    bytes_[fs::relative(files->path(), path_, problem).generic_string()] = files->file_size(problem);
    if (bytes_.size() > most_members) {
      throw FileError(path_, "", fmt::format("has more than {} files", most_members));
    }
  }
}

std::vector<std::string> FolderReader::names() const {
  std::vector<std::string> all;
  for (const auto& [name, bytes] : bytes_) all.push_back(name);
  return all;
}

std::vector<std::byte> FolderReader::read(const std::string& name, std::uint64_t most_bytes) const {
  const MemberPlace place{path_, name};
  const auto found = bytes_.find(name);
  if (found == bytes_.end()) place.refuse("is missing from the folder");
  if (found->second > most_bytes) {
    place.refuse(fmt::format("has {} bytes; up to {} make sense", found->second, most_bytes));
  }
  std::vector<std::byte> bytes(found->second);
  std::ifstream file(path_ / name, std::ios::binary);
  file.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  if (!file) place.refuse("cannot be read to its end");
  return bytes;
}

}  // namespace mezzotint
