#include <cmath>
#include <span>
#include <vector>

#include <fmt/format.h>

#include "forward/base/error.h"
#include "forward/base/file_output.h"
#include "measurement/formats/al3d_layout.h"
#include "measurement/formats/little_endian_writer.h"
#include "measurement/formats/surface_output.h"

namespace mezzotint {

namespace {

using Tag = std::pair<std::string_view, std::string>;

void append_tag(std::string& bytes, const Tag& tag) {
  std::string record(al3d::tag_bytes, '\0');
  put_text(record, 0, al3d::key_bytes - 1, tag.first);
  put_text(record, al3d::key_bytes, al3d::value_bytes - 1, tag.second);
  put_text(record, al3d::key_bytes + al3d::value_bytes, 2, "\r\n");
  bytes += record;
}

std::string header_of(const HeightField& field) {
  const Grid& grid = field.grid();
  std::vector<Tag> tags = {{"Cols", std::to_string(grid.columns)},
                           {"Rows", std::to_string(grid.rows)},
                           {"PixelSizeXMeter", fmt::format("{:.17g}", grid.pitch_x.m())},
                           {"PixelSizeYMeter", fmt::format("{:.17g}", grid.pitch_y.m())},
                           {"InvalidPixelValue", std::string(al3d::marker_text)},
                           {"NumberOfPlanes", "0"},
                           {"TextureImageOffset", "0"},
                           {"IconOffset", "0"},
                           {"CreatingApplication", "Mezzotint"},
                           {al3d::datum_key, fmt::format("{:.17g}", field.datum().m())},
                           {"DepthImageOffset", ""}};
  const std::size_t end = al3d::magic.size() + (tags.size() + 2) * al3d::tag_bytes + al3d::comment_bytes;
  tags.back().second = std::to_string(end);
  std::string header(al3d::magic);
  append_tag(header, {"Version", "1"});
  append_tag(header, {"TagCount", std::to_string(tags.size())});
  for (const Tag& tag : tags) append_tag(header, tag);
  return header + std::string(al3d::comment_bytes - 2, '\0') + "\r\n";
}

}  // namespace

// Heights are written relative to the datum, which has a record of its own: as absolute floats of metres they would
// be rounded to 4 nm at 76 mm.
void write_al3d(const HeightField& field, const std::filesystem::path& path) {
  const Grid& grid = field.grid();
  const std::size_t stride = (4 * grid.columns + 7) / 8 * 8;
  std::string bytes = header_of(field);
  bytes.reserve(bytes.size() + stride * grid.rows);
  std::vector<float> line(grid.columns);
  for (std::size_t row = grid.rows; row-- > 0;) {
    for (std::size_t column = 0; column < grid.columns; ++column) {
      const float z = field.at(column, row);
      line[column] = std::isnan(z) ? al3d::marker : static_cast<float>(z * 1e-6);
    }
    append_little_endian(bytes, std::span<const float>(line));
    bytes.append(stride - 4 * grid.columns, '\0');
  }
  write_file(path, bytes);
}

}  // namespace mezzotint
