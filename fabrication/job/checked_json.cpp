#include "fabrication/job/checked_json.h"

#include <fmt/format.h>

#include <cmath>

namespace mezzotint {

bool CheckedJson::has(const std::string& key) const { return value_.is_object() && value_.contains(key); }

CheckedJson CheckedJson::at(const std::string& key) const {
  if (!value_.is_object()) refuse("must be an object");
  const auto found = value_.find(key);
  const std::string path = key_.empty() ? key : key_ + "." + key;
  if (found == value_.end()) CheckedJson(value_, path, place_).refuse("is missing");
  return CheckedJson(*found, path, place_);
}

CheckedJson CheckedJson::element(std::size_t index) const {
  return CheckedJson(value_.at(index), fmt::format("{}[{}]", key_, index), place_);
}

std::size_t CheckedJson::array_size() const {
  if (!value_.is_array()) refuse("must be an array");
  return value_.size();
}

double CheckedJson::number() const {
  if (!value_.is_number()) refuse("must be a number");
  return value_.get<double>();
}

double CheckedJson::positive() const {
  const double value = number();
  if (!(std::isfinite(value) && value > 0.0)) refuse("must be above 0");
  return value;
}

double CheckedJson::at_least_zero() const {
  const double value = number();
  if (!(std::isfinite(value) && value >= 0.0)) refuse("must be 0 or more");
  return value;
}

std::size_t CheckedJson::whole(std::size_t low, std::size_t high) const {
  const double value = number();
  const bool good =
      value >= static_cast<double>(low) && value <= static_cast<double>(high) && value == std::floor(value);
  if (!good) refuse(fmt::format("must be a whole number from {} to {}", low, high));
  return static_cast<std::size_t>(value);
}

std::string CheckedJson::text() const {
  if (!value_.is_string()) refuse("must be a text");
  return value_.get<std::string>();
}

void CheckedJson::refuse(const std::string& problem) const { place_.refuse(fmt::format("\"{}\" {}", key_, problem)); }

nlohmann::json parse_json_object(std::span<const std::byte> text, const MemberPlace& place) {
  const auto* const begin = reinterpret_cast<const char*>(text.data());
  try {
    nlohmann::json value = nlohmann::json::parse(begin, begin + text.size());
    if (!value.is_object()) place.refuse("must hold a JSON object");
    return value;
  } catch (const nlohmann::json::exception& error) {
    place.refuse(fmt::format("is no valid JSON ({})", error.what()));
  }
}

}  // namespace mezzotint
