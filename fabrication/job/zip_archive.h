#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

struct zip;

namespace mezzotint {

/// A zip archive that is read member by member. Nothing is ever unpacked to a disk.
class ZipReader {
public:
  /// @throws FileError where it is missing, no consistent zip archive, has more than `most_members`, or one name
  ///         twice (two readers could then see two different jobs).
  ZipReader(const std::filesystem::path& path, std::size_t most_members);

  [[nodiscard]] bool has(const std::string& name) const { return members_.contains(name); }
  [[nodiscard]] std::vector<std::string> names() const;

  /// The member's bytes, its checksum verified.
  /// @throws FileError naming the member where it is missing, damaged or larger than `most_bytes`; the size is
  ///         checked before memory is taken.
  [[nodiscard]] std::vector<std::byte> read(const std::string& name, std::uint64_t most_bytes) const;

private:
  struct Member {
    std::uint64_t index = 0;
    std::uint64_t bytes = 0;
  };
  void list_member(std::uint64_t index);

  std::filesystem::path path_;
  std::unique_ptr<zip, void (*)(zip*)> archive_;
  std::map<std::string, Member> members_;
};

/// A zip archive in the making. Members keep their order and get a fixed date, so that the same members give
/// the same bytes.
class ZipWriter {
public:
  enum class Packing { Store, Deflate };

  void add(const std::string& name, std::shared_ptr<const std::string> bytes, Packing packing);

  /// @throws DeviceError where it cannot be written.
  void write(const std::filesystem::path& path) const;

private:
  struct Member {
    std::string name;
    std::shared_ptr<const std::string> bytes;
    Packing packing;
  };
  std::vector<Member> members_;
};

}  // namespace mezzotint
