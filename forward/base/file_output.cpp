#include "forward/base/file_output.h"

#include <fcntl.h>
#include <unistd.h>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>
#include <string>

#include "forward/base/error.h"

namespace mezzotint {

namespace fs = std::filesystem;

namespace {

fs::path temporary_beside(const fs::path& destination) {
  const std::string name =
      "." + destination.stem().string() + ".part" + std::to_string(::getpid()) + destination.extension().string();
  return destination.parent_path() / name;
}

[[noreturn]] void fail(const fs::path& destination, const std::string& reason) {
  throw DeviceError("cannot write " + destination.string() + ": " + reason);
}

// A rename may reach the disk before the data do; after a power cut the file would be empty.
void flush_to_disk(const fs::path& temporary, const fs::path& destination) {
  const int descriptor = ::open(temporary.c_str(), O_RDONLY);
  if (descriptor < 0) fail(destination, std::strerror(errno));
  const int result = ::fsync(descriptor);
  const int reason = errno;
  ::close(descriptor);
  // Some file systems (pipes, certain network mounts) know no fsync; that is no reason to lose the file.
  if (result != 0 && reason != EINVAL && reason != EROFS) fail(destination, std::strerror(reason));
}

}  // namespace

void write_aside(const fs::path& destination, const std::function<void(const fs::path&)>& write) {
  const fs::path temporary = temporary_beside(destination);
  try {
    write(temporary);
    flush_to_disk(temporary, destination);
    fs::rename(temporary, destination);
  } catch (const fs::filesystem_error& error) {
    std::error_code ignored;
    fs::remove(temporary, ignored);
    fail(destination, error.code().message());
  } catch (...) {
    std::error_code ignored;
    fs::remove(temporary, ignored);
    throw;
  }
}

void write_pieces(const fs::path& destination, const std::function<void(const PutBytes&)>& write) {
  write_aside(destination, [&](const fs::path& temporary) {
    const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(temporary.c_str(), "wb"), std::fclose);
    if (!file) fail(destination, std::strerror(errno));
    constexpr std::size_t buffer_bytes = std::size_t{1} << 18;  // of one row each would be a call to the system
    std::setvbuf(file.get(), nullptr, _IOFBF, buffer_bytes);
    write([&](std::string_view bytes) {
      if (std::fwrite(bytes.data(), 1, bytes.size(), file.get()) != bytes.size())
        fail(destination, std::strerror(errno));
    });
    if (std::fflush(file.get()) != 0) fail(destination, std::strerror(errno));
  });
}

void write_file(const fs::path& destination, std::string_view bytes) {
  write_pieces(destination, [bytes](const PutBytes& put) { put(bytes); });
}

}  // namespace mezzotint
