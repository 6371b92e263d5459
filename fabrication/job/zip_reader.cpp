#include <fmt/format.h>
#include <zip.h>

#include "fabrication/job/member_place.h"
#include "fabrication/job/zip_archive.h"

namespace mezzotint {

namespace {

std::string open_problem(int code) {
  zip_error_t error;
  zip_error_init_with_code(&error, code);
  std::string text = fmt::format("is no readable zip archive ({})", zip_error_strerror(&error));
  zip_error_fini(&error);
  return text;
}

struct CloseFile {
  void operator()(zip_file_t* file) const { zip_fclose(file); }
};
using OpenFile = std::unique_ptr<zip_file_t, CloseFile>;

// Reads one byte more than was announced: the end must come there, and with it libzip's check of the CRC.
void read_to_end(zip_file_t* file, std::vector<std::byte>& bytes, const MemberPlace& place) {
  std::uint64_t done = 0;
  while (done < bytes.size()) {
    const zip_int64_t got = zip_fread(file, bytes.data() + done, bytes.size() - done);
    if (got < 0) place.refuse(fmt::format("is damaged ({})", zip_file_strerror(file)));
    if (got == 0) place.refuse("is shorter than the archive's directory says");
    done += static_cast<std::uint64_t>(got);
  }
  std::byte beyond;
  const zip_int64_t more = zip_fread(file, &beyond, 1);
  if (more < 0) place.refuse(fmt::format("is damaged ({})", zip_file_strerror(file)));
  if (more > 0) place.refuse("is longer than the archive's directory says");
}

}  // namespace

ZipReader::ZipReader(const std::filesystem::path& path, std::size_t most_members)
    : path_(path), archive_(nullptr, zip_discard) {
  std::error_code ignored;
  if (!std::filesystem::exists(path, ignored)) throw FileError(path, "", "no such file");
  if (!std::filesystem::is_regular_file(path, ignored)) throw FileError(path, "", "is not a regular file");
  int code = 0;
  archive_.reset(zip_open(path.c_str(), ZIP_RDONLY | ZIP_CHECKCONS, &code));
  if (!archive_) throw FileError(path, "", open_problem(code));
  const zip_int64_t count = zip_get_num_entries(archive_.get(), 0);
  if (count <= 0) throw FileError(path, "", "is an empty archive");
  if (static_cast<std::uint64_t>(count) > most_members) {
    throw FileError(path, "", fmt::format("has {} members; up to {} are read", count, most_members));
  }
  for (std::uint64_t i = 0; i < static_cast<std::uint64_t>(count); ++i) list_member(i);
}

void ZipReader::list_member(std::uint64_t index) {
  zip_stat_t status;
  const bool known = zip_stat_index(archive_.get(), index, 0, &status) == 0 && (status.valid & ZIP_STAT_NAME) != 0 &&
                     (status.valid & ZIP_STAT_SIZE) != 0;
  if (!known) throw FileError(path_, fmt::format("member {}", index), "has no name or size");
  if (!members_.insert({status.name, Member{index, status.size}}).second) {
    throw FileError(path_, status.name, "is twice in the archive");
  }
}

std::vector<std::string> ZipReader::names() const {
  std::vector<std::string> all;
  all.reserve(members_.size());
  for (const auto& [name, member] : members_) all.push_back(name);
  return all;
}

std::vector<std::byte> ZipReader::read(const std::string& name, std::uint64_t most_bytes) const {
  const MemberPlace place{path_, name};
  const auto found = members_.find(name);
  if (found == members_.end()) place.refuse("is missing from the archive");
  if (found->second.bytes > most_bytes) {
    place.refuse(fmt::format("unpacks to {} bytes; up to {} make sense", found->second.bytes, most_bytes));
  }
  const OpenFile file(zip_fopen_index(archive_.get(), found->second.index, 0));
  if (!file) place.refuse(fmt::format("cannot be unpacked ({})", zip_strerror(archive_.get())));
  std::vector<std::byte> bytes(found->second.bytes);
  read_to_end(file.get(), bytes, place);
  return bytes;
}

}  // namespace mezzotint
