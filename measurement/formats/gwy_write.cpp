#include <bit>
#include <cmath>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "forward/base/error.h"
#include "forward/base/file_output.h"
#include "measurement/formats/gwy_field.h"
#include "measurement/formats/little_endian_writer.h"
#include "measurement/formats/surface_file.h"
#include "measurement/formats/text_values.h"

namespace mezzotint {

namespace {

/// Serialises objects; sizes are patched in when an object ends.
class GwyWriter {
public:
  explicit GwyWriter(std::size_t expected_bytes) { bytes_.reserve(expected_bytes); }

  [[nodiscard]] const std::string& bytes() const { return bytes_; }

  void text(std::string_view value) { bytes_.append(value).push_back('\0'); }
  template <class Unsigned>
  void number(Unsigned value) {
    for (std::size_t i = 0; i < sizeof value; ++i) bytes_.push_back(static_cast<char>(value >> (8 * i) & 0xFF));
  }
  void real(double value) { number(std::bit_cast<std::uint64_t>(value)); }
  void reals(std::span<const double> values) { append_little_endian(bytes_, values); }

  /// Name, type and then the value, which the caller appends.
  void component(std::string_view name, char type) {
    text(name);
    bytes_.push_back(type);
  }
  void text_component(std::string_view name, std::string_view value) {
    component(name, 's');
    text(value);
  }

  template <class Body>
  void object(std::string_view type, const Body& body) {
    text(type);
    const std::size_t size_at = bytes_.size();
    number(std::uint32_t{0});
    body();
    const std::size_t size = bytes_.size() - size_at - 4;
    for (std::size_t i = 0; i < 4; ++i) bytes_[size_at + i] = static_cast<char>(size >> (8 * i) & 0xFF);
  }

private:
  std::string bytes_ = "GWYP";
};

void write_unit(GwyWriter& writer, std::string_view name, std::string_view unit) {
  writer.component(name, 'o');
  writer.object("GwySIUnit", [&] { writer.text_component("unitstr", unit); });
}

// Values are asked for from the top of the picture: the last row of the field comes first.
template <class Value>
void write_field(GwyWriter& writer, std::string_view name, const Grid& grid, std::string_view unit,
                 const Value& value) {
  writer.component(name, 'o');
  writer.object("GwyDataField", [&] {
    writer.component("xres", 'i');
    writer.number(static_cast<std::uint32_t>(grid.columns));
    writer.component("yres", 'i');
    writer.number(static_cast<std::uint32_t>(grid.rows));
    writer.component("xreal", 'd');
    writer.real(grid.pitch_x.m() * static_cast<double>(grid.columns));
    writer.component("yreal", 'd');
    writer.real(grid.pitch_y.m() * static_cast<double>(grid.rows));
    write_unit(writer, "si_unit_xy", "m");
    write_unit(writer, "si_unit_z", unit);
    writer.component("data", 'D');
    writer.number(static_cast<std::uint32_t>(grid.size()));
    std::vector<double> line(grid.columns);
    for (std::size_t row = grid.rows; row-- > 0;) {
      for (std::size_t column = 0; column < grid.columns; ++column) line[column] = value(column, row);
      writer.reals(line);
    }
  });
}

// Gwyddion knows no NaN: a missing sample is masked, and lies at the datum.
void write_heights(GwyWriter& writer, const HeightField& field) {
  write_field(writer, "/0/data", field.grid(), "m", [&](std::size_t column, std::size_t row) {
    const float z = field.at(column, row);
    return (field.datum() + Length::from_um(std::isnan(z) ? 0.0 : z)).m();
  });
  if (field.missing_count() == 0) return;
  write_field(writer, "/0/mask", field.grid(), "",
              [&](std::size_t column, std::size_t row) { return std::isnan(field.at(column, row)) ? 1.0 : 0.0; });
}

void write_meta(GwyWriter& writer, const HeightField& field, const std::map<std::string, std::string>& provenance) {
  writer.component("/0/meta", 'o');
  writer.object("GwyContainer", [&] {
    for (const auto& [key, value] : provenance) {
      const std::string name = clean_text(key);
      if (!name.empty() && name != gwy_continuation_key) writer.text_component(name, clean_text(value));
    }
    if (field.periodic()) {
      writer.text_component(gwy_continuation_key, gwy_periodic_entry(field.columns(), field.rows()));
    }
  });
}

}  // namespace

void write_gwy(const HeightField& field, const std::string& title, const std::map<std::string, std::string>& provenance,
               const std::filesystem::path& path) {
  constexpr std::size_t room_for_words = std::size_t{1} << 20;
  const std::size_t needed = field.grid().size() * (field.missing_count() > 0 ? 16 : 8);
  require(needed < std::numeric_limits<std::uint32_t>::max() - 16 * room_for_words,
          "a .gwy file holds up to 4 GiB, and this field needs " + std::to_string(needed) + " bytes; crop it");
  std::size_t words = room_for_words / 256;
  for (const auto& [key, value] : provenance) words += key.size() + value.size() + 4;
  require(words < 8 * room_for_words, "more provenance than 8 MiB does not go into a .gwy file");
  GwyWriter writer(needed + words);
  writer.object("GwyContainer", [&] {
    write_heights(writer, field);
    writer.text_component("/0/data/title", clean_text(title));
    write_meta(writer, field, provenance);
  });
  write_file(path, writer.bytes());
}

}  // namespace mezzotint
