#pragma once

#include <functional>
#include <string_view>

#include "measurement/formats/byte_reader.h"

namespace mezzotint {

/// One named value of a serialised Gwyddion object.
struct GwyComponent {
  std::string_view name;
  char type = 0;                 ///< b c i q d s o, upper case for an array
  std::string_view object_type;  ///< of an 'o'
  ByteReader payload;            ///< the value's bytes: of an 's' without its NUL, of an 'o' its components
};

/// Calls `visit` for every component of an object, in the order of the file. Values are not copied, arrays of
/// text and objects are walked over, and nested objects are not entered.
/// @throws FileError where a component is cut short or of an unknown type.
void for_each_component(ByteReader object, const std::function<void(const GwyComponent&)>& visit);

/// The text of an 's'.
[[nodiscard]] std::string_view gwy_text(const GwyComponent& component);

/// Complains unless the component has the type.
void require_type(const GwyComponent& component, char type);

}  // namespace mezzotint
