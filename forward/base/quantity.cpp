#include "forward/base/quantity.h"

#include <cmath>

namespace mezzotint {

namespace {

template <typename Json>
Json finite_or_null(double value) {
  return std::isfinite(value) ? Json(value) : Json(nullptr);
}

template <typename Json>
void write(Json& json, const Quantity& quantity) {
  json = {{"value", finite_or_null<Json>(quantity.value)}, {"unit", quantity.unit}};
  if (quantity.standard_error) json["standard_error"] = finite_or_null<Json>(*quantity.standard_error);
}

}  // namespace

void to_json(nlohmann::json& json, const Quantity& quantity) { write(json, quantity); }
void to_json(nlohmann::ordered_json& json, const Quantity& quantity) { write(json, quantity); }

}  // namespace mezzotint
