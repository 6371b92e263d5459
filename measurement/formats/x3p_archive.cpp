#include "measurement/formats/x3p_archive.h"

#include <fmt/format.h>
#include <zip.h>

#include "forward/base/error.h"

namespace mezzotint {

namespace {

// Deflate cannot do better than 258 bytes from 2 bits: 1032 to 1.
constexpr std::uint64_t best_compression = 1040;

zip* open_archive(const std::filesystem::path& path, std::span<const std::byte> bytes) {
  zip_error_t error;
  zip_error_init(&error);
  zip_source_t* source = zip_source_buffer_create(bytes.data(), bytes.size(), 0, &error);
  zip* archive = source == nullptr ? nullptr : zip_open_from_source(source, ZIP_RDONLY, &error);
  if (archive == nullptr) {
    const std::string reason = zip_error_strerror(&error);
    if (source != nullptr) zip_source_free(source);
    zip_error_fini(&error);
    throw FileError(path, "", "is no whole zip archive (" + reason + "); it is damaged or was cut short");
  }
  zip_error_fini(&error);
  return archive;
}

}  // namespace

void X3pArchive::Closer::operator()(zip* archive) const { zip_discard(archive); }

X3pArchive::X3pArchive(const std::filesystem::path& path, std::span<const std::byte> bytes) : path_(path) {
  archive_.reset(open_archive(path, bytes));
}

bool X3pArchive::has(const std::string& member) const {
  return zip_name_locate(archive_.get(), member.c_str(), 0) >= 0;
}

std::uint64_t X3pArchive::declared_size(const std::string& member) const {
  zip_stat_t status;
  zip_stat_init(&status);
  if (zip_stat(archive_.get(), member.c_str(), 0, &status) != 0) {
    throw FileError(path_, member, "this member is missing in the archive");
  }
  constexpr zip_uint64_t needed = ZIP_STAT_SIZE | ZIP_STAT_COMP_SIZE | ZIP_STAT_COMP_METHOD;
  const bool plain =
      (status.valid & needed) == needed && (status.comp_method == ZIP_CM_STORE || status.comp_method == ZIP_CM_DEFLATE);
  if (!plain)
    throw FileError(path_, member, "is packed in a way that X3P does not know; it must be stored or deflated");
  if (status.size / best_compression > status.comp_size) {
    throw FileError(path_, member,
                    fmt::format("claims to unpack to {} bytes from {}, which deflate cannot do; the archive is damaged",
                                status.size, status.comp_size));
  }
  return status.size;
}

std::vector<std::byte> X3pArchive::read(const std::string& member, std::uint64_t largest) const {
  const std::uint64_t size = declared_size(member);
  if (size > largest) {
    throw FileError(path_, member, fmt::format("has {} bytes; up to {} are read", size, largest));
  }
  return unpack(member, size);
}

std::vector<std::byte> X3pArchive::read_exactly(const std::string& member, std::uint64_t size,
                                                const std::string& reason) const {
  const std::uint64_t declared = declared_size(member);
  if (declared != size) {
    throw FileError(path_, member, fmt::format("has {} bytes; {} need {}", declared, reason, size));
  }
  return unpack(member, size);
}

std::vector<std::byte> X3pArchive::unpack(const std::string& member, std::uint64_t size) const {
  const auto close = [](zip_file_t* file) { zip_fclose(file); };
  const std::unique_ptr<zip_file_t, decltype(close)> file(zip_fopen(archive_.get(), member.c_str(), 0), close);
  if (file == nullptr) throw FileError(path_, member, zip_strerror(archive_.get()));
  std::vector<std::byte> bytes(size);
  std::uint64_t got = 0;
  while (got < size) {
    const zip_int64_t step = zip_fread(file.get(), bytes.data() + got, size - got);
    if (step <= 0) break;
    got += static_cast<std::uint64_t>(step);
  }
  // libzip compares the checksum when it is asked for a byte beyond the end.
  std::byte beyond{};
  if (got != size || zip_fread(file.get(), &beyond, 1) != 0) {
    throw FileError(
        path_, member,
        fmt::format("is damaged ({}); {} of {} bytes could be unpacked", zip_file_strerror(file.get()), got, size));
  }
  return bytes;
}

}  // namespace mezzotint
