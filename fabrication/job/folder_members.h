#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <string_view>

#include "fabrication/job/members.h"

namespace mezzotint {

/// A folder in the making, under another name until it is whole.
class FolderWriter final : public MemberOutput {
public:
  /// @throws InvalidInput where there is something of that name already (an empty folder is taken), DeviceError where
  ///         nothing can be made there.
  explicit FolderWriter(const std::filesystem::path& path);
  ~FolderWriter() override;

  void add(const std::string& name, std::string_view bytes, Packing packing) override;
  void close() override;

private:
  std::filesystem::path path_, temporary_;
};

/// A folder's files, and those of its folders, by their paths from there.
class FolderReader final : public MemberInput {
public:
  /// @throws FileError where it cannot be read or has more than `most_members` files.
  FolderReader(const std::filesystem::path& path, std::size_t most_members);

  [[nodiscard]] bool has(const std::string& name) const override { return bytes_.contains(name); }
  [[nodiscard]] std::vector<std::string> names() const override;
  [[nodiscard]] std::vector<std::byte> read(const std::string& name, std::uint64_t most_bytes) const override;

private:
  std::filesystem::path path_;
  std::map<std::string, std::uint64_t> bytes_;
};

}  // namespace mezzotint
