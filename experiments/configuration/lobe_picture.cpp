#include "experiments/configuration/lobe_picture.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include <OpenImageIO/imageio.h>
#include <fmt/format.h>

#include "experiments/configuration/png_end.h"
#include "forward/base/error.h"
#include "forward/optics/exr_input.h"

namespace mezzotint {

namespace {

constexpr int least_side = 8, most_side = 4096;

struct Pixels {
  int channels = 1;
  bool floats = false;
  std::vector<float> values;
};

int checked_side(const OIIO::ImageSpec& picture, const std::filesystem::path& path) {
  if (picture.width != picture.height || picture.width < least_side || picture.width > most_side) {
    throw FileError(path, "",
                    fmt::format("has {} x {} pixels; a painted lobe is a square about the disc of directions, {} to {} "
                                "pixels a side",
                                picture.width, picture.height, least_side, most_side));
  }
  if (picture.nchannels != 1 && picture.nchannels != 3) {
    throw FileError(
        path, "",
        fmt::format("has {} channels; a painted lobe is gray, or R, G and B, without transparency", picture.nchannels));
  }
  return picture.width;
}

Pixels pixels_of(OIIO::ImageInput& input, const OIIO::ImageSpec& picture, const std::filesystem::path& path) {
  const auto side = static_cast<std::size_t>(checked_side(picture, path));
  Pixels pixels{picture.nchannels, picture.format == OIIO::TypeDesc::FLOAT, {}};
  pixels.values.resize(side * side * static_cast<std::size_t>(pixels.channels));
  // The picture begins at its top, the map at y = −1.
  const auto line = static_cast<OIIO::stride_t>(side * static_cast<std::size_t>(pixels.channels) * sizeof(float));
  float* last = pixels.values.data() + pixels.values.size() - side * static_cast<std::size_t>(pixels.channels);
  const bool good = input.read_image(0, 0, 0, pixels.channels, OIIO::TypeDesc::FLOAT, last, OIIO::AutoStride, -line);
  if (!good || input.has_error()) throw FileError(path, "", "is a damaged picture: " + input.geterror());
  return pixels;
}

Pixels read_png(const std::filesystem::path& path) {
  std::error_code problem;
  if (!std::filesystem::is_regular_file(path, problem)) throw FileError(path, "", "no such file");
  if (is_cut_off_png(path)) throw FileError(path, "", "is no PNG picture and no OpenEXR, or was cut off");
  const std::unique_ptr<OIIO::ImageInput> input = OIIO::ImageInput::create("png");
  OIIO::ImageSpec picture;
  if (!input || !input->open(path.string(), picture)) {
    throw FileError(path, "", "is no PNG picture: " + (input ? input->geterror() : OIIO::geterror()));
  }
  return pixels_of(*input, picture, path);
}

Pixels read_exr_picture(const std::filesystem::path& path) {
  const ExrInput input = open_exr(path);
  return pixels_of(*input.file, input.spec, path);
}

// IEC 61966-2-1.
double from_srgb(double value) { return value <= 0.04045 ? value / 12.92 : std::pow((value + 0.055) / 1.055, 2.4); }

std::vector<float> light_of(const Pixels& pixels, bool encoded, const std::filesystem::path& path) {
  constexpr double luminance[3] = {0.2126, 0.7152, 0.0722};
  const auto channels = static_cast<std::size_t>(pixels.channels);
  std::vector<float> light(pixels.values.size() / channels);
  for (std::size_t i = 0; i < light.size(); ++i) {
    double sum = 0.0;
    for (std::size_t c = 0; c < channels; ++c) {
      const double value = double{pixels.values[i * channels + c]};
      sum += (channels == 1 ? 1.0 : luminance[c]) * (encoded ? from_srgb(value) : value);
    }
    if (!std::isfinite(sum) || sum < 0.0) {
      throw FileError(path, fmt::format("pixel {}", i),
                      fmt::format("holds {}; light is a number, and not negative", sum));
    }
    light[i] = static_cast<float>(sum);
  }
  return light;
}

// Pixels that the rim crosses may hold anything; beyond, there is no direction.
void require_light_in_the_disc(const LobePicture& picture) {
  const double side = static_cast<double>(picture.side);
  double inside = 0.0, outside = 0.0;
  for (std::size_t row = 0; row < picture.side; ++row) {
    for (std::size_t column = 0; column < picture.side; ++column) {
      const double x = 2.0 * (static_cast<double>(column) + 0.5) / side - 1.0;
      const double y = 2.0 * (static_cast<double>(row) + 0.5) / side - 1.0;
      const bool beyond = std::hypot(x, y) > 1.0 + 2.0 * std::sqrt(2.0) / side;
      (beyond ? outside : inside) += double{picture.light[row * picture.side + column]};
    }
  }
  if (!(inside > 0.0)) throw FileError(picture.source, "", "is dark everywhere in the disc of directions");
  if (outside > 0.01 * (inside + outside)) {
    throw FileError(picture.source, "",
                    fmt::format("has {:.0f} % of its light outside of the disc, which is below the horizon; paint on "
                                "black",
                                100.0 * outside / (inside + outside)));
  }
}

}  // namespace

LobePicture read_lobe_picture(const std::filesystem::path& path, bool linear) {
  const Pixels pixels = path.extension() == ".exr" ? read_exr_picture(path) : read_png(path);
  LobePicture picture;
  picture.light = light_of(pixels, !linear && !pixels.floats, path);
  picture.side = static_cast<std::size_t>(std::llround(std::sqrt(static_cast<double>(picture.light.size()))));
  picture.source = path;
  require_light_in_the_disc(picture);
  return picture;
}

double light_at(const LobePicture& picture, double x, double y) {
  const double side = static_cast<double>(picture.side);
  const double column = std::floor((x + 1.0) / 2.0 * side), row = std::floor((y + 1.0) / 2.0 * side);
  if (column < 0.0 || row < 0.0 || column > side || row > side) return 0.0;
  const auto at = [&](double value) { return std::min(static_cast<std::size_t>(value), picture.side - 1); };
  return double{picture.light[at(row) * picture.side + at(column)]};
}

}  // namespace mezzotint
