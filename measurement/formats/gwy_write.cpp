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

/// Serialises objects. Each begins with its size, so all is gone through twice: first the sizes are found, then the
/// bytes go to the file.
class GwyWriter {
public:
  /// Finds sizes.
  GwyWriter() = default;
  /// Writes, with the sizes that another one found.
  GwyWriter(const PutBytes& put, std::vector<std::size_t> sizes) : put_(&put), sizes_(std::move(sizes)) {}

  [[nodiscard]] bool only_counts() const { return put_ == nullptr; }
  [[nodiscard]] const std::vector<std::size_t>& sizes() const { return sizes_; }
  [[nodiscard]] std::size_t count() const { return count_; }

  void bytes(std::string_view bytes) {
    count_ += bytes.size();
    if (put_ != nullptr) (*put_)(bytes);
  }
  void skip(std::size_t count) { count_ += count; }
  void text(std::string_view value) {
    bytes(value);
    bytes(std::string_view("", 1));
  }
  template <class Unsigned>
  void number(Unsigned value) {
    std::string digits;
    append_little_endian(digits, value);
    bytes(digits);
  }
  void real(double value) { number(value); }
  void reals(std::span<const double> values) {
    if constexpr (std::endian::native == std::endian::little)
      return bytes({reinterpret_cast<const char*>(values.data()), values.size_bytes()});
    std::string digits;
    append_little_endian(digits, values);
    bytes(digits);
  }

  /// Name, type and then the value, which the caller appends.
  void component(std::string_view name, char type) {
    text(name);
    bytes({&type, 1});
  }
  void text_component(std::string_view name, std::string_view value) {
    component(name, 's');
    text(value);
  }

  template <class Body>
  void object(std::string_view type, const Body& body) {
    text(type);
    const std::size_t at = objects_++;
    if (only_counts()) sizes_.push_back(0);
    number(static_cast<std::uint32_t>(sizes_[at]));
    const std::size_t begin = count_;
    body();
    if (only_counts()) sizes_[at] = count_ - begin;
  }

private:
  const PutBytes* put_ = nullptr;
  std::vector<std::size_t> sizes_;
  std::size_t count_ = 0, objects_ = 0;
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
    if (writer.only_counts()) return writer.skip(8 * grid.size());
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
  const auto serialise = [&](GwyWriter& writer) {
    writer.bytes("GWYP");
    writer.object("GwyContainer", [&] {
      write_heights(writer, field);
      writer.text_component("/0/data/title", clean_text(title));
      write_meta(writer, field, provenance);
    });
  };
  GwyWriter sizes;
  serialise(sizes);
  require(sizes.count() <= std::numeric_limits<std::uint32_t>::max(),
          "a .gwy file holds up to 4 GiB, and this field needs " + std::to_string(sizes.count()) + " bytes; crop it");
  write_pieces(path, [&](const PutBytes& put) {
    GwyWriter writer(put, sizes.sizes());
    serialise(writer);
  });
}

}  // namespace mezzotint
