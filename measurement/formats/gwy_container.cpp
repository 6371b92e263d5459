#include "measurement/formats/gwy_container.h"

#include <string>

#include "forward/base/error.h"

namespace mezzotint {

namespace {

constexpr std::size_t bytes_of(char type) {
  switch (type) {
    case 'b':
    case 'c':
    case 'C':
      return 1;
    case 'i':
    case 'I':
      return 4;
    case 'q':
    case 'd':
    case 'Q':
    case 'D':
      return 8;
    default:
      return 0;
  }
}

struct NestedObject {
  std::string_view type;
  ByteReader components;
};

NestedObject take_object(ByteReader& reader) {
  const std::string_view type = reader.take_text("the type of an object");
  const auto size = reader.take_number<std::uint32_t>("the size of an object");
  return {type, reader.take_part(size, "an object")};
}

ByteReader take_array(ByteReader& reader, char type) {
  const auto count = reader.take_number<std::uint32_t>("the length of an array");
  if (count == 0) reader.fail("an array of no values; the format wants at least one");
  if (type == 'S' || type == 'O') {
    // Each takes at least one byte, so that a wrong count soon meets the end of the file.
    for (std::uint32_t i = 0; i < count; ++i) {
      if (type == 'S') {
        reader.take_text("a text of an array");
      } else {
        take_object(reader);
      }
    }
    return reader.take_part(0, "an array");
  }
  return reader.take_part(std::uint64_t{count} * bytes_of(type), "an array");
}

GwyComponent take_component(ByteReader& reader) {
  const std::string_view name = reader.take_text("the name of a component");
  const char type = static_cast<char>(reader.take_number<std::uint8_t>("the type of a component"));
  switch (type) {
    case 'b':
    case 'c':
    case 'i':
    case 'q':
    case 'd':
      return {name, type, {}, reader.take_part(bytes_of(type), "a number")};
    case 's': {
      ByteReader text = reader;
      return {name, type, {}, text.take_part(reader.take_text("a text").size(), "a text")};
    }
    case 'o': {
      const NestedObject object = take_object(reader);
      return {name, type, object.type, object.components};
    }
    case 'C':
    case 'I':
    case 'Q':
    case 'D':
    case 'S':
    case 'O':
      return {name, type, {}, take_array(reader, type)};
    default:
      reader.fail("a component of unknown type; one of b c i q d s o C I Q D S O must stand in the byte before");
  }
}

}  // namespace

void for_each_component(ByteReader object, const std::function<void(const GwyComponent&)>& visit) {
  while (object.remaining() > 0) visit(take_component(object));
}

std::string_view gwy_text(const GwyComponent& component) {
  ByteReader payload = component.payload;
  const auto bytes = payload.take(payload.remaining(), "a text");
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

void require_type(const GwyComponent& component, char type) {
  if (component.type == type) return;
  component.payload.fail(std::string("the value before has the type '") + component.type + "'; '" + type +
                         "' belongs there");
}

}  // namespace mezzotint
