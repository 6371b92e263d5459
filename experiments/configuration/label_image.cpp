#include "experiments/configuration/label_image.h"

#include <algorithm>
#include <vector>

#include <OpenImageIO/imageio.h>
#include <fmt/format.h>

#include "experiments/configuration/png_end.h"
#include "forward/base/error.h"

namespace mezzotint {

namespace {

constexpr int most_pixels_a_side = 8192;

void check_picture(const OIIO::ImageSpec& picture, const std::filesystem::path& path) {
  if (picture.nchannels != 1 || picture.format != OIIO::TypeDesc::UINT8) {
    throw FileError(path, "",
                    fmt::format("has {} channels of {}; labels are a gray PNG picture of 8 bits without alpha",
                                picture.nchannels, picture.format.c_str()));
  }
  if (std::max(picture.width, picture.height) > most_pixels_a_side) {
    throw FileError(path, "",
                    fmt::format("has {} x {} pixels; labels have at most {} a side", picture.width, picture.height,
                                most_pixels_a_side));
  }
}

}  // namespace

void read_label_image(const std::filesystem::path& path, PatternRegions& into) {
  std::error_code problem;
  if (!std::filesystem::is_regular_file(path, problem)) throw FileError(path, "", "no such file");
  if (is_cut_off_png(path)) throw FileError(path, "", "is no PNG picture, or was cut off");
  const std::unique_ptr<OIIO::ImageInput> input = OIIO::ImageInput::create("png");
  OIIO::ImageSpec picture;
  if (!input || !input->open(path.string(), picture)) {
    throw FileError(path, "", "is no PNG picture: " + (input ? input->geterror() : OIIO::geterror()));
  }
  check_picture(picture, path);
  const auto columns = static_cast<std::size_t>(picture.width), rows = static_cast<std::size_t>(picture.height);
  std::vector<std::uint8_t> labels(columns * rows);
  // The picture begins at its top, the labels at y = 0.
  const auto stride = static_cast<OIIO::stride_t>(columns);
  const bool good =
      input->read_image(0, 0, 0, 1, OIIO::TypeDesc::UINT8, labels.data() + (rows - 1) * columns, 1, -stride);
  if (!good || input->has_error()) throw FileError(path, "", "is a damaged PNG picture: " + input->geterror());
  into.columns = columns;
  into.rows = rows;
  into.labels = std::move(labels);
  into.source = path.string();
}

}  // namespace mezzotint
