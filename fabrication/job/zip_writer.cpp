#include <fcntl.h>
#include <fmt/format.h>
#include <zip.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "fabrication/job/member_place.h"
#include "fabrication/job/zip_archive.h"
#include "forward/base/error.h"
#include "forward/base/file_output.h"

namespace mezzotint {

namespace {

// The first day that a zip can name, at midnight: a real date would make every archive different, and libzip
// would turn it into the local time of the machine.
constexpr zip_uint16_t fixed_date = 0x0021;
constexpr zip_uint16_t fixed_time = 0;
constexpr zip_uint32_t deflate_level = 6;

[[noreturn]] void fail(const std::filesystem::path& path, const std::string& reason) {
  throw DeviceError("cannot write " + path.string() + ": " + reason);
}

// A file that has lost its name already: it vanishes with the program, however that ends.
Descriptor nameless_file_beside(const std::filesystem::path& path) {
  const std::filesystem::path folder = path.has_parent_path() ? path.parent_path() : ".";
  std::string name = (folder / ".mezzotint-XXXXXX").string();
  Descriptor file(::mkostemp(name.data(), O_CLOEXEC));
  if (file.number() < 0) fail(path, std::strerror(errno));
  ::unlink(name.c_str());
  return file;
}

/// A member's bytes in the waiting file, as libzip asks for them.
struct WaitingBytes {
  int file;
  std::uint64_t begin, size;
  std::uint64_t done = 0;
  zip_error_t error = {};

  zip_int64_t read(void* to, zip_uint64_t count) {
    const std::uint64_t wanted = std::min(count, size - done);
    const ssize_t got = ::pread(file, to, wanted, static_cast<off_t>(begin + done));
    if (got < 0 || (got == 0 && wanted > 0)) {
      zip_error_set(&error, ZIP_ER_READ, errno);
      return -1;
    }
    done += static_cast<std::uint64_t>(got);
    return got;
  }

  zip_int64_t describe(void* to) const {
    auto* const status = static_cast<zip_stat_t*>(to);
    zip_stat_init(status);
    status->size = size;
    status->valid = ZIP_STAT_SIZE;
    return sizeof *status;
  }
};

extern "C" zip_int64_t serve_waiting_bytes(void* user, void* data, zip_uint64_t length, zip_source_cmd_t command) {
  auto* const bytes = static_cast<WaitingBytes*>(user);
  switch (command) {
    case ZIP_SOURCE_SUPPORTS:
      return zip_source_make_command_bitmap(ZIP_SOURCE_OPEN, ZIP_SOURCE_READ, ZIP_SOURCE_CLOSE, ZIP_SOURCE_STAT,
                                            ZIP_SOURCE_ERROR, ZIP_SOURCE_FREE, -1);
    case ZIP_SOURCE_OPEN:
      bytes->done = 0;
      return 0;
    case ZIP_SOURCE_READ:
      return bytes->read(data, length);
    case ZIP_SOURCE_CLOSE:
      return 0;
    case ZIP_SOURCE_STAT:
      return bytes->describe(data);
    case ZIP_SOURCE_ERROR:
      return zip_error_to_data(&bytes->error, data, length);
    case ZIP_SOURCE_FREE:
      delete bytes;
      return 0;
    default:
      zip_error_set(&bytes->error, ZIP_ER_OPNOTSUPP, 0);
      return -1;
  }
}

class Archive {
public:
  explicit Archive(const std::filesystem::path& path) : path_(path) {
    int code = 0;
    archive_ = zip_open(path.c_str(), ZIP_CREATE | ZIP_TRUNCATE, &code);
    if (archive_ == nullptr) throw DeviceError("cannot write " + path.string());
  }
  ~Archive() {
    if (archive_ != nullptr) zip_discard(archive_);
  }
  Archive(const Archive&) = delete;
  Archive& operator=(const Archive&) = delete;

  void add(const std::string& name, const WaitingBytes& bytes, bool deflate) {
    auto waiting = std::make_unique<WaitingBytes>(bytes);
    zip_source_t* const source = zip_source_function(archive_, serve_waiting_bytes, waiting.get());
    check(source != nullptr);
    (void)waiting.release();  // libzip frees it with the source
    const zip_int64_t index = zip_file_add(archive_, name.c_str(), source, ZIP_FL_ENC_UTF_8);
    if (index < 0) zip_source_free(source);
    check(index >= 0);
    const auto member = static_cast<zip_uint64_t>(index);
    check(zip_set_file_compression(archive_, member, deflate ? ZIP_CM_DEFLATE : ZIP_CM_STORE, deflate_level) == 0);
    check(zip_file_set_dostime(archive_, member, fixed_time, fixed_date, 0) == 0);
  }

  void close() {
    check(zip_close(archive_) == 0);
    archive_ = nullptr;
  }

private:
  void check(bool good) const {
    if (!good) fail(path_, zip_strerror(archive_));
  }

  std::filesystem::path path_;
  zip_t* archive_ = nullptr;
};

}  // namespace

ZipWriter::ZipWriter(std::filesystem::path path) : path_(std::move(path)), waiting_(nameless_file_beside(path_)) {}

void ZipWriter::add(const std::string& name, std::string_view bytes, Packing packing) {
  members_.push_back({name, waiting_bytes_, bytes.size(), packing});
  while (!bytes.empty()) {
    const ssize_t written = ::pwrite(waiting_.number(), bytes.data(), bytes.size(), static_cast<off_t>(waiting_bytes_));
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) fail(path_, written < 0 ? std::strerror(errno) : "the disk takes no more");
    waiting_bytes_ += static_cast<std::uint64_t>(written);
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
}

void ZipWriter::close() {
  write_aside(path_, [this](const std::filesystem::path& temporary) {
    Archive archive(temporary);
    for (const Member& member : members_) {
      archive.add(member.name, {waiting_.number(), member.begin, member.size}, member.packing == Packing::Deflate);
    }
    archive.close();
  });
  waiting_ = Descriptor();
}

}  // namespace mezzotint
