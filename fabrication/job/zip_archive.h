#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "fabrication/job/descriptor.h"
#include "fabrication/job/members.h"

struct zip;

namespace mezzotint {

/// A zip archive that is read member by member. Nothing is ever unpacked to a disk.
class ZipReader final : public MemberInput {
public:
  /// @throws FileError where it is missing, no consistent zip archive, has more than `most_members`, or one name
  ///         twice (two readers could then see two different jobs).
  ZipReader(const std::filesystem::path& path, std::size_t most_members);

  [[nodiscard]] bool has(const std::string& name) const override { return members_.contains(name); }
  [[nodiscard]] std::vector<std::string> names() const override;

  /// The member's bytes, its checksum verified.
  /// @throws FileError naming the member where it is missing, damaged or larger than `most_bytes`; the size is
  ///         checked before memory is taken.
  [[nodiscard]] std::vector<std::byte> read(const std::string& name, std::uint64_t most_bytes) const override;

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
/// the same bytes. They wait in a file without a name beside the archive, since libzip wants all members at its
/// end: memory holds one at a time, and whatever happens, nothing stays on the disk.
class ZipWriter final : public MemberOutput {
public:
  /// @throws DeviceError where the folder cannot be written.
  explicit ZipWriter(std::filesystem::path path);

  void add(const std::string& name, std::string_view bytes, Packing packing) override;
  void close() override;

private:
  struct Member {
    std::string name;
    std::uint64_t begin, size;
    Packing packing;
  };
  std::filesystem::path path_;
  Descriptor waiting_;
  std::uint64_t waiting_bytes_ = 0;
  std::vector<Member> members_;
};

}  // namespace mezzotint
