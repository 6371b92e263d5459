#include <array>
#include <bit>
#include <cmath>

#include <fmt/format.h>

#include "forward/base/error.h"
#include "forward/surface/mesh_parsers.h"
#include "forward/surface/text_words.h"

namespace mezzotint {

namespace {

enum class Type { Int8, Uint8, Int16, Uint16, Int32, Uint32, Float32, Float64 };
enum class Encoding { Text, LittleEndian, BigEndian };

struct Property {
  std::string name;
  Type type = Type::Float32;
  std::optional<Type> count;  ///< of the length of a list
};

struct Element {
  std::string name;
  std::size_t count = 0;
  std::vector<Property> properties;
};

struct Header {
  Encoding encoding = Encoding::Text;
  std::vector<Element> elements;
};

std::size_t size_of(Type type) {
  constexpr std::array<std::size_t, 8> sizes = {1, 1, 2, 2, 4, 4, 4, 8};
  return sizes[static_cast<std::size_t>(type)];
}

Type type_of(const std::filesystem::path& path, const TextWords& text, std::string_view name) {
  constexpr std::array<std::array<std::string_view, 2>, 8> names = {{{"char", "int8"},
                                                                     {"uchar", "uint8"},
                                                                     {"short", "int16"},
                                                                     {"ushort", "uint16"},
                                                                     {"int", "int32"},
                                                                     {"uint", "uint32"},
                                                                     {"float", "float32"},
                                                                     {"double", "float64"}}};
  for (std::size_t k = 0; k < names.size(); ++k) {
    if (name == names[k][0] || name == names[k][1]) return static_cast<Type>(k);
  }
  throw FileError(path, text.place(), fmt::format("\"{}\" is no type of PLY", name.substr(0, 40)));
}

Encoding encoding_of(const std::filesystem::path& path, const TextWords& text, std::string_view name) {
  if (name == "ascii") return Encoding::Text;
  if (name == "binary_little_endian") return Encoding::LittleEndian;
  if (name == "binary_big_endian") return Encoding::BigEndian;
  throw FileError(path, text.place(), fmt::format("\"{}\" is no encoding of PLY", name.substr(0, 40)));
}

Element read_element(const std::filesystem::path& path, TextWords& text) {
  Element element;
  element.name = text.word();
  const auto count = integer_in(text.word());
  if (!count || *count < 0) throw FileError(path, text.place(), "an element needs a count of 0 or more");
  element.count = static_cast<std::size_t>(*count);
  return element;
}

Property read_property(const std::filesystem::path& path, TextWords& text) {
  Property property;
  std::string_view word = text.word();
  if (word == "list") {
    property.count = type_of(path, text, text.word());
    if (*property.count >= Type::Float32) throw FileError(path, text.place(), "a list cannot have a fraction's length");
    word = text.word();
  }
  property.type = type_of(path, text, word);
  property.name = text.word();
  return property;
}

Header read_header(const std::filesystem::path& path, TextWords& text) {
  Header header;
  if (!text.next_line() || text.word() != "ply") throw FileError(path, "line 1", "is no PLY file");
  bool has_format = false;
  while (text.next_line()) {
    const std::string_view keyword = text.word();
    if (keyword == "end_header") {
      if (!has_format) throw FileError(path, text.place(), "has a header without a format");
      return header;
    }
    if (keyword == "format") {
      header.encoding = encoding_of(path, text, text.word());
      has_format = true;
    } else if (keyword == "element") {
      header.elements.push_back(read_element(path, text));
    } else if (keyword == "property") {
      if (header.elements.empty()) throw FileError(path, text.place(), "has a property before any element");
      header.elements.back().properties.push_back(read_property(path, text));
    }
  }
  throw FileError(path, text.place(), "ends within its header; it is truncated or no PLY");
}

/// Numbers of the body, one after the other.
class Body {
public:
  Body(const std::filesystem::path& path, const Header& header, std::span<const std::byte> bytes)
      : path_(path), encoding_(header.encoding), bytes_(bytes), text_(bytes) {}

  double number(Type type) { return encoding_ == Encoding::Text ? number_of_text() : number_of_bytes(type); }

  /// How many numbers are left at the most: for sizes that a file only claims.
  [[nodiscard]] std::size_t most_left(Type type) const {
    return encoding_ == Encoding::Text ? bytes_.size() : (bytes_.size() - position_) / size_of(type);
  }
  [[nodiscard]] std::string place() const {
    return encoding_ == Encoding::Text ? "body, " + text_.place() : "body, byte " + std::to_string(position_);
  }
  [[noreturn]] void fail(const std::string& problem) const { throw FileError(path_, place(), problem); }

private:
  double number_of_text() {
    const std::string_view word = text_.word_of_text();
    const auto value = real_in(word);
    if (word.empty()) fail("ends before its last element; it is truncated");
    if (!value) fail(fmt::format("\"{}\" is no number", word.substr(0, 40)));
    return *value;
  }
  double number_of_bytes(Type type) {
    const std::size_t size = size_of(type);
    if (bytes_.size() - position_ < size) fail("ends before its last element; it is truncated");
    std::uint64_t bits = 0;
    for (std::size_t k = 0; k < size; ++k) {
      const std::size_t from = encoding_ == Encoding::LittleEndian ? size - 1 - k : k;
      bits = (bits << 8U) | std::to_integer<std::uint64_t>(bytes_[position_ + from]);
    }
    position_ += size;
    return value_of(type, bits);
  }
  static double value_of(Type type, std::uint64_t bits) {
    switch (type) {
      case Type::Int8:
        return static_cast<std::int8_t>(bits);
      case Type::Int16:
        return static_cast<std::int16_t>(bits);
      case Type::Int32:
        return static_cast<std::int32_t>(bits);
      case Type::Float32:
        return double{std::bit_cast<float>(static_cast<std::uint32_t>(bits))};
      case Type::Float64:
        return std::bit_cast<double>(bits);
      case Type::Uint8:
      case Type::Uint16:
      case Type::Uint32:
        break;
    }
    return static_cast<double>(bits);
  }

  const std::filesystem::path& path_;
  Encoding encoding_;
  std::span<const std::byte> bytes_;
  std::size_t position_ = 0;
  TextWords text_;
};

// The numbers of one property: one, or those of a list.
void read_values(const Property& property, Body& body, std::vector<double>& values) {
  values.clear();
  std::size_t count = 1;
  if (property.count) {
    const double length = body.number(*property.count);
    // The comparison also refuses NaN, which text may hold.
    if (!(length >= 0.0 && length <= static_cast<double>(body.most_left(property.type))))
      body.fail(fmt::format("a list of {} entries is longer than the file", length));
    count = static_cast<std::size_t>(length);
  }
  for (std::size_t k = 0; k < count; ++k) values.push_back(body.number(property.type));
}

std::uint32_t vertex_of(const Body& body, double index, std::size_t count) {
  if (!(index >= 0.0 && index < static_cast<double>(count)) || index != std::floor(index))
    body.fail(fmt::format("a face names vertex {}; there are {}, counted from 0", index, count));
  return static_cast<std::uint32_t>(index);
}

void read_vertices(const std::filesystem::path& path, const Element& element, Body& body, RawMesh& mesh) {
  constexpr std::array<std::string_view, 3> names = {"x", "y", "z"};
  std::vector<double> values;
  for (std::size_t k = 0; k < element.count; ++k) {
    std::array<double, 3> vertex = {std::nan(""), std::nan(""), std::nan("")};
    for (const Property& property : element.properties) {
      read_values(property, body, values);
      for (std::size_t axis = 0; axis < 3; ++axis)
        if (property.name == names[axis] && !property.count) vertex[axis] = values[0];
    }
    add_vertex(path, body.place(), vertex, mesh);
  }
}

void read_faces(const Element& element, Body& body, RawMesh& mesh) {
  std::vector<double> values;
  std::vector<std::uint32_t> corners;
  for (std::size_t k = 0; k < element.count; ++k) {
    for (const Property& property : element.properties) {
      read_values(property, body, values);
      if (property.name != "vertex_indices" && property.name != "vertex_index") continue;
      corners.clear();
      for (const double index : values) corners.push_back(vertex_of(body, index, mesh.vertices.size()));
      add_polygon(corners, mesh);
    }
  }
}

// Elements without properties take no bytes: any count of them would be read for ever.
void require_plausible(const std::filesystem::path& path, const Element& element, std::size_t bytes) {
  if (element.count > 0 && (element.properties.empty() || element.count > bytes)) {
    throw FileError(
        path, "header",
        fmt::format("says {} elements \"{}\", more than the file has bytes for", element.count, element.name));
  }
}

}  // namespace

RawMesh parse_ply(const std::filesystem::path& path, std::span<const std::byte> bytes) {
  TextWords text(bytes);
  const Header header = read_header(path, text);
  RawMesh mesh{.format = header.encoding == Encoding::Text ? "ply (text)" : "ply (binary)"};
  const std::span<const std::byte> rest = bytes.subspan(text.end_of_line());
  Body body(path, header, rest);
  std::vector<double> ignored;
  for (const Element& element : header.elements) {
    require_plausible(path, element, rest.size());
    if (element.name == "vertex") {
      read_vertices(path, element, body, mesh);
    } else if (element.name == "face") {
      read_faces(element, body, mesh);
    } else {
      if (element.name == "tristrips") throw FileError(path, "header", "has strips of triangles; faces are read");
      for (std::size_t k = 0; k < element.count; ++k)
        for (const Property& property : element.properties) read_values(property, body, ignored);
    }
  }
  return mesh;
}

}  // namespace mezzotint
