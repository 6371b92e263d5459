#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <string_view>

#include "forward/surface/height_field.h"

namespace mezzotint {

/// The grid that a header promises, before anything of it is believed.
struct PromisedGrid {
  std::uint64_t columns = 0;
  std::uint64_t rows = 0;
  double pitch_x_m = 0.0;
  double pitch_y_m = 0.0;
};

/// Which end of the field a file's first row is.
enum class FirstRow {
  Top,    ///< as in pictures: the reader flips
  Bottom  ///< y = 0, as in memory
};

/// The promise as a grid.
/// @throws FileError at `place` where no height field can have this grid.
[[nodiscard]] Grid checked_grid(const std::filesystem::path& path, std::string_view place,
                                const PromisedGrid& promised);

/// A height field from heights in metres, in the file's order; a missing one is NaN. Call it when the file is
/// known to hold as many samples as its grid promises. The mean is taken out in double before the heights
/// become floats, and kept in the datum.
/// @param row_m  writes the heights of one of the file's rows; is called twice for each
/// @throws FileError at `place` for heights that no surface has.
[[nodiscard]] HeightField assemble_rows(const std::filesystem::path& path, std::string_view place, const Grid& grid,
                                        FirstRow first_row, Continuation continuation,
                                        const std::function<void(std::size_t, std::span<double>)>& row_m);

/// The same from a function of the sample's place in the file, called twice for each.
template <class Height>
[[nodiscard]] HeightField assemble_heights(const std::filesystem::path& path, std::string_view place, const Grid& grid,
                                           FirstRow first_row, Continuation continuation, const Height& height_m) {
  return assemble_rows(path, place, grid, first_row, continuation, [&](std::size_t row, std::span<double> heights_m) {
    for (std::size_t c = 0; c < heights_m.size(); ++c) heights_m[c] = height_m(row * heights_m.size() + c);
  });
}

}  // namespace mezzotint
