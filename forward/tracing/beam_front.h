#pragma once

#include <cstdint>
#include <vector>

#include "forward/optics/direction.h"
#include "forward/tracing/height_pyramid.h"

namespace mezzotint {

/// How high above the relief the rays of one parallel beam can meet it at the most: where to start them.
///
/// A ray of a beam is named by its aim, the point where it passes the plane z = `plane`. Seen along the beam, every
/// cell of the relief covers a stretch of that plane; the highest of those over a cell of aims bounds from above where
/// its rays end. A ray that starts there is at most a few cells from its end, however low the sun; without it a ray
/// at 80° crosses dozens of cells first.
///
/// Frame    aims in cells of the tile (index units), periodic like it.
/// Bound    conservative: no ray of the beam meets the relief above it.
/// Cost     one pass over the cells, each split where the beam moves on by more than a cell: 11, 12 and 20 ns a cell at
///          0, 45 and 80°.
class BeamFront {
public:
  /// @param travel  direction in which the light travels, downwards; a unit vector in cells of pitch_x.
  BeamFront(const HeightPyramid& relief, const Direction& travel, double plane);

  /// The height at which a ray with this aim may start; `column`, `row` within the tile.
  [[nodiscard]] float height(std::int32_t column, std::int32_t row) const {
    return bound_[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) +
                  static_cast<std::size_t>(column)];
  }
  /// All of them, row after row.
  [[nodiscard]] const float* heights() const { return bound_.data(); }
  /// The way (cells) that aims move for each unit of height: place = aim + (z − plane)·shift.
  [[nodiscard]] double shift_x() const { return shift_x_; }
  [[nodiscard]] double shift_y() const { return shift_y_; }

private:
  void cast(const HeightPyramid& relief, std::int32_t first_row, std::int32_t end_row,
            std::vector<float>& corners) const;
  void spread(const std::vector<float>& a, const std::vector<float>& b);

  std::int32_t columns_, rows_;
  double plane_, shift_x_, shift_y_;
  std::vector<float> bound_;
};

}  // namespace mezzotint
