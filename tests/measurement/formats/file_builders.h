#pragma once

#include <bit>
#include <cstdint>
#include <cstring>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

// Surface files put together byte by byte from their published layouts, so that the readers are compared with
// something that shares no code with them.
namespace mezzotint::test {

/// Appends a number in little-endian order.
template <class Number>
void append(std::string& bytes, Number value) {
  std::uint64_t bits = 0;
  std::memcpy(&bits, &value, sizeof value);  // the tests run on little-endian machines
  for (std::size_t i = 0; i < sizeof value; ++i) bytes.push_back(static_cast<char>(bits >> (8 * i) & 0xFF));
}

inline std::span<const std::byte> as_bytes(std::string_view text) {
  return {reinterpret_cast<const std::byte*>(text.data()), text.size()};
}

struct Al3dRecipe {
  std::uint64_t columns = 0;
  std::uint64_t rows = 0;
  std::vector<float> heights_m;  ///< the top row first
  bool padded_rows = false;
  bool with_texture = true;
  std::map<std::string, std::string> tags;  ///< in place of, or besides, the usual ones
};
std::string build_al3d(const Al3dRecipe& recipe);

/// Components of a serialised Gwyddion object.
class GwyBuilder {
public:
  GwyBuilder& integer(std::string_view name, std::int32_t value);
  GwyBuilder& real(std::string_view name, double value);
  GwyBuilder& text(std::string_view name, std::string_view value);
  GwyBuilder& reals(std::string_view name, const std::vector<double>& values);
  GwyBuilder& texts(std::string_view name, const std::vector<std::string>& values);
  GwyBuilder& object(std::string_view name, std::string_view type, const GwyBuilder& content);
  GwyBuilder& objects(std::string_view name, std::string_view type, const std::vector<GwyBuilder>& contents);
  /// The file with this as its container.
  [[nodiscard]] std::string file() const;

private:
  GwyBuilder& component(std::string_view name, char type);
  void nested(std::string_view type, const GwyBuilder& content);
  std::string bytes_;
};
/// A GwyDataField; an empty unit is left out.
GwyBuilder gwy_field(std::int32_t columns, std::int32_t rows, double width, double height,
                     const std::vector<double>& values, std::string_view lateral_unit = "m",
                     std::string_view height_unit = "m");

struct ZipMember {
  std::string name;
  std::string content;
  std::uint16_t method = 0;         ///< 0 stored, 8 deflated
  std::int64_t declared_size = -1;  ///< uncompressed; −1: the content's
};
/// A zip archive with the impossible date 1980-00-00.
std::string build_zip(const std::vector<ZipMember>& members);
/// The same, with a 64-bit end record that promises this many members.
std::string build_zip64(const std::vector<ZipMember>& members, std::uint64_t promised_members);

struct X3pRecipe {
  std::uint64_t columns = 0;
  std::uint64_t rows = 0;
  std::string z_axis = "<AxisType>A</AxisType><DataType>D</DataType>";
  std::string record3;  ///< what follows MatrixDimension
  std::string feature = "SUR";
  std::string prefix;  ///< of every element, with its colon
};
std::string build_main_xml(const X3pRecipe& recipe);
/// Record 3 of a file with binary data.
std::string data_link(const std::string& md5 = "", bool with_validity = false);

}  // namespace mezzotint::test
