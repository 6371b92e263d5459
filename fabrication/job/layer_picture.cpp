#include "fabrication/job/layer_picture.h"

#include <algorithm>
#include <cassert>
#include <cstring>

namespace mezzotint {

std::span<const GrayRun> runs_of_row(const LayerPicture& picture, std::size_t row) {
  const std::size_t begin = row == 0 ? 0 : picture.row_ends[row - 1];
  return std::span(picture.runs).subspan(begin, picture.row_ends[row] - begin);
}

LayerPictureBuilder::LayerPictureBuilder(std::size_t columns, std::size_t rows) {
  picture_.columns = columns;
  picture_.rows = rows;
  picture_.row_ends.reserve(rows);
}

void LayerPictureBuilder::begin_row(std::size_t row) {
  assert(row >= picture_.row_ends.size() && row < picture_.rows);
  picture_.row_ends.resize(row, picture_.runs.size());
  row_begin_ = picture_.runs.size();
}

LayerPicture LayerPictureBuilder::finish() {
  picture_.row_ends.resize(picture_.rows, picture_.runs.size());
  return std::move(picture_);
}

namespace {

// Eight equal bytes at a time: layers are mostly empty or full.
std::size_t equal_until(const std::uint8_t* pixels, std::size_t begin, std::size_t end) {
  std::uint64_t pattern, word;
  std::memset(&pattern, pixels[begin], sizeof pattern);
  std::size_t at = begin;
  for (; at + sizeof word <= end; at += sizeof word) {
    std::memcpy(&word, pixels + at, sizeof word);
    if (word != pattern) break;
  }
  while (at < end && pixels[at] == pixels[begin]) ++at;
  return at;
}

}  // namespace

LayerPicture to_runs(std::span<const std::uint8_t> gray, std::size_t columns, std::size_t rows) {
  LayerPictureBuilder builder(columns, rows);
  for (std::size_t row = 0; row < rows; ++row) {
    builder.begin_row(row);
    const std::uint8_t* const pixels = gray.data() + row * columns;
    for (std::size_t begin = 0; begin < columns;) {
      const std::size_t end = equal_until(pixels, begin, columns);
      builder.add(begin, end, pixels[begin]);
      begin = end;
    }
  }
  return builder.finish();
}

std::vector<std::uint8_t> to_pixels(const LayerPicture& picture) {
  std::vector<std::uint8_t> gray(picture.columns * picture.rows, 0);
  for (std::size_t row = 0; row < picture.rows; ++row) {
    std::uint8_t* const pixels = gray.data() + row * picture.columns;
    for (const GrayRun& run : runs_of_row(picture, row)) std::fill(pixels + run.begin, pixels + run.end, run.level);
  }
  return gray;
}

PictureFigures figures_of(const LayerPicture& picture) {
  PictureFigures figures;
  for (const GrayRun& run : picture.runs) {
    const auto length = static_cast<std::uint64_t>(run.end - run.begin);
    figures.lit += length;
    if (run.level == 255) figures.full += length;
    figures.gray_sum += length * run.level;
  }
  return figures;
}

}  // namespace mezzotint
