#include <fmt/format.h>
#include <zip.h>

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

  void add(const std::string& name, const std::string& bytes, bool deflate) {
    zip_source_t* const source = zip_source_buffer(archive_, bytes.data(), bytes.size(), 0);
    check(source != nullptr);
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
    if (!good) throw DeviceError(fmt::format("cannot write {}: {}", path_.string(), zip_strerror(archive_)));
  }

  std::filesystem::path path_;
  zip_t* archive_ = nullptr;
};

}  // namespace

void ZipWriter::add(const std::string& name, std::shared_ptr<const std::string> bytes, Packing packing) {
  members_.push_back({name, std::move(bytes), packing});
}

void ZipWriter::write(const std::filesystem::path& path) const {
  write_aside(path, [this](const std::filesystem::path& temporary) {
    Archive archive(temporary);
    for (const Member& member : members_) {
      archive.add(member.name, *member.bytes, member.packing == Packing::Deflate);
    }
    archive.close();
  });
}

}  // namespace mezzotint
