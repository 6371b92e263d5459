#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "forward/process/gray_image.h"

namespace mezzotint {

/// A printed wedge: strips of even gray side by side along x, all of one width, in a frame that shows the base.
///
/// Ends     A strip of full gray at the dark end makes both ends of the wedge visible, whatever does not cure: with it
///          a scan can tell a wrong number of steps.
struct WedgeLayout {
  std::vector<int> levels;  ///< of 8 bits, from x = 0 on
  std::size_t step_pixels = 40;
  std::size_t rows = 60;  ///< of the strips
  std::size_t frame_pixels = 30;
};

/// The levels of the wedge that is printed where none are told: full gray, then 0 to 255 by 15.
inline constexpr std::string_view default_wedge_levels = "255,0:255:15";

/// Levels from "255,0:255:15": numbers and FROM:TO:STEP (down where FROM is the larger), separated by commas.
/// @throws InvalidInput for anything else, levels outside of 0 … 255, or fewer than 2 or more than 1000 of them.
[[nodiscard]] std::vector<int> parse_levels(std::string_view text);

/// @throws InvalidInput for a layout without strips, pixels or rows.
[[nodiscard]] GrayImage wedge_image(const WedgeLayout& layout);

}  // namespace mezzotint
