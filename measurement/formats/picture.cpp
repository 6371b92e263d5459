#include <cmath>
#include <limits>
#include <memory>
#include <variant>
#include <vector>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <fmt/format.h>

#include "forward/base/bounded_memory.h"
#include "forward/base/error.h"
#include "measurement/formats/byte_reader.h"
#include "measurement/formats/parsers.h"
#include "measurement/formats/picture_header.h"
#include "measurement/formats/plain_parsers.h"
#include "measurement/formats/text_values.h"

namespace mezzotint {

namespace {

using Bytes = std::span<const std::byte>;

// LZW packs better than deflate: a code of 12 bits can stand for 4 kB.
constexpr std::uint64_t best_compression = 4096;

struct Picture {
  std::uint64_t columns = 0, rows = 0;
  unsigned white = 0;  ///< 255 or 65535; 0: floats
  std::variant<std::vector<std::uint16_t>, std::vector<float>> pixels;
};

class PictureFile {
public:
  PictureFile(const std::filesystem::path& path, const char* format, Bytes bytes)
      : path_(path), memory_(bytes.data(), bytes.size()) {
    file_ = OIIO::ImageInput::create(format, false, nullptr, &memory_);
    if (!file_) throw DeviceError(fmt::format("cannot read {}: OpenImageIO has no {} here", path.string(), format));
    OIIO::ImageSpec configuration;
    configuration.attribute("oiio:ioproxy", OIIO::TypeDesc::PTR, &proxy_);
    if (!file_->open(format, spec_, configuration)) refuse();
  }

  [[nodiscard]] const OIIO::ImageSpec& spec() const { return spec_; }
  [[nodiscard]] bool has_more() const { return file_->seek_subimage(1, 0); }

  template <class Pixel>
  std::vector<Pixel> read(OIIO::TypeDesc type, std::size_t count) const {
    std::vector<Pixel> pixels(count);
    if (!file_->read_image(0, 0, 0, 1, type, pixels.data()) || file_->has_error()) refuse();
    return pixels;
  }

private:
  [[noreturn]] void refuse() const {
    throw FileError(path_, "", fmt::format("is a damaged picture: {}", clean_text(file_->geterror())));
  }

  const std::filesystem::path& path_;
  BoundedMemory memory_;
  OIIO::Filesystem::IOProxy* proxy_ = &memory_;
  std::unique_ptr<OIIO::ImageInput> file_;
  OIIO::ImageSpec spec_;
};

unsigned white_of(const std::filesystem::path& path, const OIIO::ImageSpec& spec) {
  const int bits = spec.get_int_attribute("oiio:BitsPerSample", static_cast<int>(spec.format.size()) * 8);
  if (spec.format == OIIO::TypeDesc::FLOAT) return 0;
  if (spec.format == OIIO::TypeDesc::UINT8 && bits == 8) return 255;
  if (spec.format == OIIO::TypeDesc::UINT16 && bits == 16) return 65535;
  throw FileError(path, "header",
                  fmt::format("pixels of type {} with {} bits; gray of 8 or 16 bits and 32-bit floats are read",
                              spec.format.c_str(), bits));
}

void require_upright_gray(const std::filesystem::path& path, const OIIO::ImageSpec& spec) {
  if (spec.nchannels != 1 || spec.depth > 1) {
    throw FileError(path, "header", fmt::format("{} channels; a relief has one, its heights", spec.nchannels));
  }
  const int orientation = spec.get_int_attribute("Orientation", 1);
  if (orientation != 1) {
    throw FileError(path, "header", fmt::format("the orientation {} turns the picture; save it upright", orientation));
  }
}

// A TIFF says how many rows go together, and the library takes memory for as many before it looks whether they are
// there.
void require_possible_strips(const std::filesystem::path& path, const OIIO::ImageSpec& spec, std::uint64_t file_bytes) {
  const auto positive = [](int value) { return static_cast<std::uint64_t>(std::max(value, 1)); };
  const std::uint64_t strip = positive(spec.get_int_attribute("tiff:RowsPerStrip", 1)) * positive(spec.width);
  const std::uint64_t tile = positive(spec.tile_width) * positive(spec.tile_height);
  // The last strip, or a tile at the rim, may reach beyond the picture; a strip of all rows there can be, too.
  constexpr std::uint64_t harmless = std::uint64_t{1} << 22;
  const std::uint64_t picture = positive(spec.width) * positive(spec.height);
  if (std::max(strip, tile) <= std::max(harmless, 2 * picture)) return;
  throw FileError(path, "header",
                  fmt::format("strips or tiles of {} pixels in a picture of {} and a file of {} bytes; it is damaged",
                              std::max(strip, tile), picture, file_bytes));
}

Picture read_pixels(const PictureFile& file, const std::filesystem::path& path, std::uint64_t file_bytes) {
  const OIIO::ImageSpec& spec = file.spec();
  require_upright_gray(path, spec);
  Picture picture;
  picture.columns = static_cast<std::uint64_t>(std::max(spec.width, 0));
  picture.rows = static_cast<std::uint64_t>(std::max(spec.height, 0));
  picture.white = white_of(path, spec);
  const std::uint64_t count = checked_grid(path, "header", {picture.columns, picture.rows, 1e-6, 1e-6}).size();
  require_plausible_size(path, count * spec.format.size(), file_bytes);
  require_possible_strips(path, spec, file_bytes);
  if (picture.white == 0) {
    picture.pixels = file.read<float>(OIIO::TypeDesc::FLOAT, count);
    return picture;
  }
  auto gray = file.read<std::uint16_t>(OIIO::TypeDesc::UINT16, count);
  // The library spreads 8 bits over 16: 255 becomes 65535.
  if (picture.white == 255) {
    for (std::uint16_t& level : gray) level = static_cast<std::uint16_t>(level / 257);
  }
  picture.pixels = std::move(gray);
  return picture;
}

Picture decode(const std::filesystem::path& path, Bytes bytes, std::string& format, std::string& assumption) {
  if (looks_like_png(bytes)) {
    format = "png";
    const std::vector<std::byte> plain = plain_png(path, bytes);
    return read_pixels(PictureFile(path, "png", plain), path, bytes.size());
  }
  if (looks_like_exr(bytes)) {
    format = "exr";
    require_relief_exr(path, bytes);
    return read_pixels(PictureFile(path, "exr", bytes), path, bytes.size());
  }
  format = "tiff";
  const PictureFile file(path, "tiff", bytes);
  Picture picture = read_pixels(file, path, bytes.size());
  if (file.has_more()) add_assumption(assumption, "the first of several pictures is the relief");
  return picture;
}

double gray_height_um(const Picture& picture, const Sidecar& sidecar, double depth_um, std::size_t i) {
  const unsigned gray = std::get<0>(picture.pixels)[i];
  if (sidecar.missing_gray && gray == *sidecar.missing_gray) return std::numeric_limits<double>::quiet_NaN();
  return sidecar.datum_um + gray * depth_um / picture.white;
}

double float_height_um(const Picture& picture, const Sidecar& sidecar, double value_um, std::size_t i) {
  const float value = std::get<1>(picture.pixels)[i];
  return std::isfinite(value) ? sidecar.datum_um + value * value_um : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace

void require_plausible_size(const std::filesystem::path& path, std::uint64_t bytes_needed, std::uint64_t file_bytes) {
  if (bytes_needed / best_compression <= file_bytes) return;
  throw FileError(
      path, "header",
      fmt::format("{} bytes of pixels from a file of {}, which no compression can do", bytes_needed, file_bytes));
}

bool looks_like_tiff(Bytes bytes) {
  return begins_with(bytes, std::string_view("II*\0", 4)) || begins_with(bytes, std::string_view("MM\0*", 4));
}

bool looks_like_picture(Bytes bytes) {
  return looks_like_png(bytes) || looks_like_exr(bytes) || looks_like_tiff(bytes);
}

SurfaceFile parse_picture(const std::filesystem::path& path, Bytes bytes, const Sidecar& sidecar) {
  if (!looks_like_picture(bytes)) throw FileError(path, "byte 0", "is no PNG, TIFF or OpenEXR picture");
  std::string format, assumption;
  const Picture picture = decode(path, bytes, format, assumption);
  const Grid grid = sidecar_grid(path, sidecar, picture.columns, picture.rows);
  const bool floats = picture.white == 0;
  const double scale_um = floats ? required_scale_um(path, sidecar.value_um, "value_um")
                                 : required_scale_um(path, sidecar.depth_um, "depth_um");
  if (picture.white == 255) add_assumption(assumption, "8 bits: the relief has 256 levels");
  const auto height_m = [&](std::size_t i) {
    return 1e-6 *
           (floats ? float_height_um(picture, sidecar, scale_um, i) : gray_height_um(picture, sidecar, scale_um, i));
  };
  HeightField field =
      assemble_heights(path, "pixels", grid, sidecar.first_row_on_top ? FirstRow::Top : FirstRow::Bottom,
                       sidecar_continuation(sidecar), height_m);
  return {std::move(field), format, sidecar.title, sidecar.provenance, assumption};
}

}  // namespace mezzotint
