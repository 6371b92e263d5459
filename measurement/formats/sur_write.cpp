#include <algorithm>
#include <cmath>
#include <limits>

#include "forward/base/error.h"
#include "forward/base/file_output.h"
#include "measurement/formats/little_endian_writer.h"
#include "measurement/formats/sur_layout.h"
#include "measurement/formats/surface_output.h"
#include "measurement/formats/text_values.h"

namespace mezzotint {

namespace {

constexpr double largest_count = 1 << 30;

// How heights become counts: height_mm = count · step + offset. Step and offset stand as floats in the header, so
// that the counts are made with the floats and the rounding of the offset does not move the heights.
struct Scale {
  float step_mm = 1.0F, offset_mm = 0.0F;
  double shift_mm = 0.0;  ///< from the offset to the datum
  std::int32_t lowest = 0, highest = 0;

  [[nodiscard]] std::int32_t count(double z_um) const {
    return static_cast<std::int32_t>(std::round((z_um * 1e-3 + shift_mm) / static_cast<double>(step_mm)));
  }
};

Scale scale_of(const HeightField& field) {
  Scale scale;
  scale.offset_mm = static_cast<float>(field.datum().mm());
  scale.shift_mm = field.datum().mm() - static_cast<double>(scale.offset_mm);
  if (field.missing_count() == field.grid().size()) return scale;
  const HeightRange range = height_range(field);
  const double farthest_mm =
      std::max(std::abs(range.lowest.mm() + scale.shift_mm), std::abs(range.highest.mm() + scale.shift_mm));
  // A little more than needed, since the float may be rounded down.
  scale.step_mm =
      std::max(static_cast<float>(farthest_mm * (1.0 + 1e-6) / largest_count), std::numeric_limits<float>::min());
  scale.lowest = scale.count(range.lowest.um());
  scale.highest = scale.count(range.highest.um());
  return scale;
}

std::string header_of(const HeightField& field, const std::string& title, const Scale& scale, std::size_t comment) {
  std::string header(sur::header_bytes, '\0');
  const Grid& grid = field.grid();
  put_text(header, 0, sur::magic_plain.size(), sur::magic_plain);
  put_little_endian(header, sur::at_objects, std::int16_t{1});
  put_little_endian(header, sur::at_version, std::int16_t{1});
  put_little_endian(header, sur::at_type, static_cast<std::int16_t>(sur::type_surface));
  put_text(header, sur::at_name, sur::name_bytes, title);
  put_little_endian(header, sur::at_non_measured, static_cast<std::int16_t>(field.missing_count() > 0 ? 1 : 0));
  put_little_endian(header, sur::at_absolute_z, std::int16_t{1});
  put_little_endian(header, sur::at_bits, std::int16_t{32});
  put_little_endian(header, sur::at_lowest, scale.lowest);
  put_little_endian(header, sur::at_highest, scale.highest);
  put_little_endian(header, sur::at_columns, static_cast<std::int32_t>(grid.columns));
  put_little_endian(header, sur::at_rows, static_cast<std::int32_t>(grid.rows));
  put_little_endian(header, sur::at_points, static_cast<std::int32_t>(grid.size()));
  put_little_endian(header, sur::at_step_x, static_cast<float>(grid.pitch_x.mm()));
  put_little_endian(header, sur::at_step_y, static_cast<float>(grid.pitch_y.mm()));
  put_little_endian(header, sur::at_step_z, scale.step_mm);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    put_text(header, sur::at_names + axis * sur::text_bytes, sur::text_bytes, std::string_view("XYZ").substr(axis, 1));
    put_text(header, sur::at_step_units + axis * sur::text_bytes, sur::text_bytes, "mm");
    put_text(header, sur::at_units + axis * sur::text_bytes, sur::text_bytes, "mm");
    put_little_endian(header, sur::at_ratios + 4 * axis, 1.0F);
  }
  put_little_endian(header, sur::at_replica, std::int16_t{1});
  put_little_endian(header, sur::at_comment_bytes, static_cast<std::int16_t>(comment));
  put_little_endian(header, sur::at_offset_z, scale.offset_mm);
  return header;
}

std::string comment_of(const Provenance& provenance) {
  constexpr std::size_t most_bytes = 32000;  // the length is an int16
  std::string comment;
  for (const auto& [key, value] : provenance) comment += clean_text(key) + ": " + clean_text(value) + "\r\n";
  return comment.substr(0, most_bytes);
}

void append_points(std::string& bytes, const HeightField& field, const Scale& scale) {
  const std::int32_t marker = scale.lowest - sur::non_measured_below_lowest;
  for (std::size_t row = field.rows(); row-- > 0;) {
    for (std::size_t column = 0; column < field.columns(); ++column) {
      const float z = field.at(column, row);
      append_little_endian(bytes, std::isnan(z) ? marker : scale.count(z));
    }
  }
}

}  // namespace

void write_sur(const HeightField& field, const std::string& title, const Provenance& provenance,
               const std::filesystem::path& path) {
  const Scale scale = scale_of(field);
  const std::string comment = comment_of(provenance);
  std::string bytes;
  bytes.reserve(sur::header_bytes + comment.size() + 4 * field.grid().size());
  bytes += header_of(field, clean_text(title), scale, comment.size());
  bytes += comment;
  append_points(bytes, field, scale);
  write_file(path, bytes);
}

}  // namespace mezzotint
