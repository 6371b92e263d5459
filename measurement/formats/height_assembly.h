#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
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
/// @param height_m  is called twice for each sample
/// @throws FileError at `place` for heights that no surface has.
[[nodiscard]] HeightField assemble_heights(const std::filesystem::path& path, std::string_view place, const Grid& grid,
                                           FirstRow first_row, Continuation continuation,
                                           const std::function<double(std::size_t)>& height_m);

}  // namespace mezzotint
