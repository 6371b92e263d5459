#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

struct zip;

namespace mezzotint {

/// The members of a zip archive that lies in memory, one at a time.
///
/// Errors   FileError with the member's name. Nothing is taken on trust: a member's declared size is compared
///          with what its reader needs, and with what its compressed bytes could possibly hold, before memory
///          is taken (a "zip bomb" is refused). Impossible dates are accepted.
class X3pArchive {
public:
  /// @param bytes  must outlive the archive
  X3pArchive(const std::filesystem::path& path, std::span<const std::byte> bytes);

  [[nodiscard]] bool has(const std::string& member) const;
  /// A member of up to `largest` bytes.
  [[nodiscard]] std::vector<std::byte> read(const std::string& member, std::uint64_t largest) const;
  /// A member that must have exactly `size` bytes; `reason` says why.
  [[nodiscard]] std::vector<std::byte> read_exactly(const std::string& member, std::uint64_t size,
                                                    const std::string& reason) const;

private:
  struct Closer {
    void operator()(zip* archive) const;
  };
  [[nodiscard]] std::uint64_t declared_size(const std::string& member) const;
  [[nodiscard]] std::vector<std::byte> unpack(const std::string& member, std::uint64_t size) const;

  std::filesystem::path path_;
  std::unique_ptr<zip, Closer> archive_;
};

}  // namespace mezzotint
