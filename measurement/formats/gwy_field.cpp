#include "measurement/formats/gwy_field.h"

#include <fmt/format.h>

#include "forward/base/error.h"
#include "measurement/formats/text_values.h"

namespace mezzotint {

namespace {

std::uint64_t take_resolution(const GwyComponent& component) {
  require_type(component, 'i');
  ByteReader payload = component.payload;
  const auto value = payload.take_number<std::int32_t>("a resolution");
  if (value <= 0) {
    component.payload.fail(fmt::format("a resolution of {} samples; it must be positive", value));
  }
  return static_cast<std::uint64_t>(value);
}

double take_double(const GwyComponent& component) {
  require_type(component, 'd');
  ByteReader payload = component.payload;
  return payload.take_number<double>("a number");
}

std::string take_unit(const GwyComponent& component) {
  require_type(component, 'o');
  std::string unit;
  for_each_component(component.payload, [&](const GwyComponent& part) {
    if (part.name != "unitstr") return;
    require_type(part, 's');
    unit = clean_text(gwy_text(part));
  });
  return unit;
}

std::span<const std::byte> take_data(const GwyComponent& component) {
  require_type(component, 'D');
  ByteReader payload = component.payload;
  return payload.take(payload.remaining(), "the data");
}

}  // namespace

GwyField read_gwy_field(const GwyComponent& component) {
  require_type(component, 'o');
  GwyField field;
  field.offset = component.payload.offset();
  for_each_component(component.payload, [&](const GwyComponent& part) {
    if (part.name == "xres") field.columns = take_resolution(part);
    if (part.name == "yres") field.rows = take_resolution(part);
    if (part.name == "xreal") field.width = take_double(part);
    if (part.name == "yreal") field.height = take_double(part);
    if (part.name == "si_unit_xy") field.lateral_unit = take_unit(part);
    if (part.name == "si_unit_z") field.value_unit = take_unit(part);
    if (part.name == "data") field.data = take_data(part);
  });
  // Both resolutions are below 2^31, so that the product cannot overflow.
  if (field.data.size() % 8 != 0 || field.columns * field.rows != field.data.size() / 8 || field.data.empty()) {
    component.payload.fail(
        fmt::format("the data field \"{}\" of {} × {} samples holds {} values; the numbers must agree",
                    clean_text(component.name), field.columns, field.rows, field.data.size() / 8));
  }
  return field;
}

std::string gwy_periodic_entry(std::uint64_t columns, std::uint64_t rows) {
  return fmt::format("periodic, {} x {} samples", columns, rows);
}

}  // namespace mezzotint
