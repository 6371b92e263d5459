#pragma once

#include <cstddef>
#include <map>
#include <span>
#include <string>

#include "fabrication/job/member_place.h"

namespace mezzotint {

/// Lines "key = value" of an archive's .ini member.
class IniText {
public:
  IniText(std::span<const std::byte> text, const MemberPlace& place);

  /// @throws FileError where the key is missing.
  [[nodiscard]] std::string text(const std::string& key) const;
  /// @throws FileError where it is missing or no number from `low` to `high`.
  [[nodiscard]] double number(const std::string& key, double low, double high) const;
  [[nodiscard]] std::size_t whole(const std::string& key, std::size_t low, std::size_t high) const;
  [[nodiscard]] bool has(const std::string& key) const { return values_.contains(key); }

private:
  std::map<std::string, std::string> values_;
  const MemberPlace& place_;
};

}  // namespace mezzotint
