#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <span>
#include <string>

#include "fabrication/job/member_place.h"

namespace mezzotint {

/// A value of a JSON file together with where it stands, so that every complaint can say it.
class CheckedJson {
public:
  CheckedJson(const nlohmann::json& value, std::string key, const MemberPlace& place)
      : value_(value), key_(std::move(key)), place_(place) {}

  [[nodiscard]] bool has(const std::string& key) const;
  /// A member of an object; refused where it is missing.
  [[nodiscard]] CheckedJson at(const std::string& key) const;
  /// An element of an array; the caller knows the size.
  [[nodiscard]] CheckedJson element(std::size_t index) const;
  [[nodiscard]] std::size_t array_size() const;

  /// A number > 0.
  [[nodiscard]] double positive() const;
  /// A number ≥ 0.
  [[nodiscard]] double at_least_zero() const;
  /// A whole number from `low` to `high`.
  [[nodiscard]] std::size_t whole(std::size_t low, std::size_t high) const;
  [[nodiscard]] std::string text() const;
  [[nodiscard]] const nlohmann::json& value() const { return value_; }

  [[noreturn]] void refuse(const std::string& problem) const;

private:
  [[nodiscard]] double number() const;

  const nlohmann::json& value_;
  std::string key_;
  const MemberPlace& place_;
};

/// @throws FileError with the parser's position where the text is no JSON object.
[[nodiscard]] nlohmann::json parse_json_object(std::span<const std::byte> text, const MemberPlace& place);

}  // namespace mezzotint
