#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace mezzotint {

/// Columns [begin, end) of a row that have one gray level, 1 to 255.
struct GrayRun {
  std::uint16_t begin = 0, end = 0;
  std::uint8_t level = 0;
  bool operator==(const GrayRun&) const = default;
};

/// The picture of a layer as runs of equal gray: most of a layer is dark or full, and costs nothing then.
///
/// Shape    rows × columns; row 0 at y = 0. Runs go from left to right; between them is 0.
struct LayerPicture {
  std::size_t columns = 0, rows = 0;
  std::vector<GrayRun> runs;
  std::vector<std::size_t> row_ends;  ///< a row's runs end there; those of the next begin
};

[[nodiscard]] std::span<const GrayRun> runs_of_row(const LayerPicture& picture, std::size_t row);

/// Appends rows from y = 0 on; adjoining runs of one level become one, level 0 becomes none.
class LayerPictureBuilder {
public:
  LayerPictureBuilder(std::size_t columns, std::size_t rows);
  /// Begins `row`, which must not lie before the last one; rows between are dark.
  void begin_row(std::size_t row);
  void add(std::size_t begin, std::size_t end, std::uint8_t level) {
    if (level == 0) return;
    if (picture_.runs.size() > row_begin_ && picture_.runs.back().end == begin && picture_.runs.back().level == level) {
      picture_.runs.back().end = static_cast<std::uint16_t>(end);
      return;
    }
    picture_.runs.push_back({static_cast<std::uint16_t>(begin), static_cast<std::uint16_t>(end), level});
  }
  [[nodiscard]] LayerPicture finish();

private:
  LayerPicture picture_;
  std::size_t row_begin_ = 0;
};

/// From and to 8-bit pixels, row 0 at y = 0.
[[nodiscard]] LayerPicture to_runs(std::span<const std::uint8_t> gray, std::size_t columns, std::size_t rows);
[[nodiscard]] std::vector<std::uint8_t> to_pixels(const LayerPicture& picture);

/// What a layer holds.
struct PictureFigures {
  std::uint64_t lit = 0;       ///< pixels above 0
  std::uint64_t full = 0;      ///< pixels at 255
  std::uint64_t gray_sum = 0;  ///< of all levels
};
[[nodiscard]] PictureFigures figures_of(const LayerPicture& picture);

}  // namespace mezzotint
