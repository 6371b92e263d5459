#include <cmath>
#include <limits>
#include <memory>
#include <vector>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <fmt/format.h>

#include "forward/base/error.h"
#include "forward/base/file_output.h"
#include "measurement/formats/sidecar.h"
#include "measurement/formats/surface_output.h"

namespace mezzotint {

namespace {

constexpr unsigned white = 65535;

OIIO::ImageSpec specification(const Grid& grid, const OIIO::TypeDesc& type) {
  OIIO::ImageSpec spec(static_cast<int>(grid.columns), static_cast<int>(grid.rows), 1, type);
  spec.channelnames = {"Y"};
  spec.attribute("DateTime", "");  // otherwise the time of writing: the same relief shall give the same bytes
  return spec;
}

// A line at a time, the top of the picture first, into memory: written straight to a full disk, OpenEXR swallows the
// error when it closes the file, and calls half a picture a whole one.
template <class Pixel, class Value>
std::vector<unsigned char> encode(const char* format, const Grid& grid, const OIIO::TypeDesc& type,
                                  const Value& value) {
  const std::unique_ptr<OIIO::ImageOutput> file = OIIO::ImageOutput::create(format);
  if (!file) throw DeviceError(fmt::format("cannot write {}: OpenImageIO does not know it here", format));
  const auto check = [&](bool good) {
    if (!good) throw DeviceError(fmt::format("cannot make a picture ({}): {}", format, file->geterror()));
  };
  std::vector<unsigned char> bytes;
  OIIO::Filesystem::IOVecOutput sink(bytes);
  OIIO::Filesystem::IOProxy* const proxy = &sink;
  OIIO::ImageSpec spec = specification(grid, type);
  spec.attribute("oiio:ioproxy", OIIO::TypeDesc::PTR, &proxy);
  if (type == OIIO::TypeDesc::FLOAT) spec.attribute("compression", "zip");
  check(file->open(format, spec));
  std::vector<Pixel> line(grid.columns);
  for (std::size_t row = grid.rows; row-- > 0;) {
    for (std::size_t column = 0; column < grid.columns; ++column) line[column] = value(column, row);
    check(file->write_scanline(static_cast<int>(grid.rows - 1 - row), 0, type, line.data()));
  }
  check(file->close());
  return bytes;
}

Sidecar common_sidecar(const HeightField& field, const std::string& title, const Provenance& provenance) {
  Sidecar sidecar;
  sidecar.width_um = field.grid().pitch_x.um() * static_cast<double>(field.columns());
  sidecar.length_um = field.grid().pitch_y.um() * static_cast<double>(field.rows());
  sidecar.datum_um = field.datum().um();
  sidecar.periodic = field.periodic();
  sidecar.title = title;
  sidecar.provenance = provenance;
  return sidecar;
}

// Both are whole before either takes its name; the picture takes its own last.
void write_both(const std::filesystem::path& path, const Sidecar& sidecar, const std::vector<unsigned char>& picture) {
  write_aside(path, [&](const std::filesystem::path& temporary) {
    write_file(temporary, {reinterpret_cast<const char*>(picture.data()), picture.size()});
    write_file(sidecar_path(path), sidecar_text(sidecar));
  });
}

struct GrayScale {
  double lowest_um = 0.0, depth_um = 1.0;
  bool has_missing = false;

  // Black is kept for missing samples.
  [[nodiscard]] std::uint16_t gray(float z) const {
    if (std::isnan(z)) return 0;
    const double level = std::round((z - lowest_um) / depth_um * white);
    return static_cast<std::uint16_t>(level);
  }
};

GrayScale gray_scale(const HeightField& field) {
  GrayScale scale;
  const std::size_t missing = field.missing_count();
  scale.has_missing = missing > 0;
  if (missing == field.grid().size()) return scale;
  const HeightRange range = height_range(field);
  const double relief_um = (range.highest - range.lowest).um();
  if (!scale.has_missing) {
    scale.lowest_um = range.lowest.um();
    scale.depth_um = relief_um > 0.0 ? relief_um : 1.0;
    return scale;
  }
  const double step_um = relief_um > 0.0 ? relief_um / (white - 1) : 1.0;
  scale.lowest_um = range.lowest.um() - step_um;
  scale.depth_um = step_um * white;
  return scale;
}

}  // namespace

void write_png(const HeightField& field, const std::string& title, const Provenance& provenance,
               const std::filesystem::path& path) {
  const GrayScale scale = gray_scale(field);
  Sidecar sidecar = common_sidecar(field, title, provenance);
  sidecar.datum_um += scale.lowest_um;
  sidecar.depth_um = scale.depth_um;
  if (scale.has_missing) sidecar.missing_gray = 0;
  write_both(
      path, sidecar,
      encode<std::uint16_t>("png", field.grid(), OIIO::TypeDesc::UINT16,
                            [&](std::size_t column, std::size_t row) { return scale.gray(field.at(column, row)); }));
}

void write_relief_exr(const HeightField& field, const std::string& title, const Provenance& provenance,
                      const std::filesystem::path& path) {
  Sidecar sidecar = common_sidecar(field, title, provenance);
  sidecar.value_um = 1.0;
  write_both(path, sidecar,
             encode<float>("openexr", field.grid(), OIIO::TypeDesc::FLOAT,
                           [&](std::size_t column, std::size_t row) { return field.at(column, row); }));
}

}  // namespace mezzotint
