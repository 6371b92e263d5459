#pragma once

#include <optional>
#include <string>

#include <nlohmann/json.hpp>

namespace mezzotint {

/// A reported number: what it is worth, in what unit, and how far it may be off.
/// An exact number (a count, a setting) has no standard error.
struct Quantity {
  double value = 0.0;
  std::string unit = "1";
  std::optional<double> standard_error;
};

/// {"value": …, "unit": …, "standard_error": …}; a value that is not finite becomes null.
void to_json(nlohmann::json& json, const Quantity& quantity);
void to_json(nlohmann::ordered_json& json, const Quantity& quantity);

}  // namespace mezzotint
