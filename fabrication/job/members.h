#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace mezzotint {

/// Named pieces of bytes in the making: a zip archive or a folder.
class MemberOutput {
public:
  enum class Packing { Store, Deflate };

  MemberOutput() = default;
  MemberOutput(const MemberOutput&) = delete;
  MemberOutput& operator=(const MemberOutput&) = delete;
  virtual ~MemberOutput() = default;

  /// @throws DeviceError where the disk is full or does not answer.
  virtual void add(const std::string& name, std::string_view bytes, Packing packing) = 0;
  /// Puts the whole under its name. Without it nothing is left.
  /// @throws DeviceError where it cannot be written.
  virtual void close() = 0;
};

/// Named pieces of bytes that are there: a zip archive or a folder.
class MemberInput {
public:
  MemberInput() = default;
  MemberInput(const MemberInput&) = delete;
  MemberInput& operator=(const MemberInput&) = delete;
  virtual ~MemberInput() = default;

  [[nodiscard]] virtual bool has(const std::string& name) const = 0;
  [[nodiscard]] virtual std::vector<std::string> names() const = 0;
  /// @throws FileError naming the member where it is missing, damaged or larger than `most_bytes`; the size is
  ///         checked before memory is taken.
  [[nodiscard]] virtual std::vector<std::byte> read(const std::string& name, std::uint64_t most_bytes) const = 0;
};

}  // namespace mezzotint
