#include "forward/scattering/light_sweep.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <tbb/parallel_for.h>

namespace mezzotint {

namespace {

// Lines that one thread follows together.
constexpr std::uint32_t lines_together = 256;
// A shadow may be this many tiles long; what a longer one darkens is taken for lit.
constexpr std::uint32_t most_laps = 4;
constexpr std::uint32_t tile_edge = 32;

/// Heights turned so that the beam goes mainly from row to row. A row's first sample stands behind its last, too.
struct Turned {
  std::uint32_t rows = 0, columns = 0;
  std::vector<float> heights;
  [[nodiscard]] const float* row(std::uint32_t k) const { return heights.data() + std::size_t{k} * (columns + 1); }
};

Turned turn(const PeriodicTile& tile, bool transposed) {
  Turned turned{tile.rows(), tile.columns(), {}};
  if (transposed) std::swap(turned.rows, turned.columns);
  const std::uint32_t stride = turned.columns + 1;
  turned.heights.resize(std::size_t{turned.rows} * stride);
  tbb::parallel_for(std::uint32_t{0}, (turned.rows + tile_edge - 1) / tile_edge, [&](std::uint32_t band) {
    const std::uint32_t first = band * tile_edge, end = std::min(turned.rows, first + tile_edge);
    for (std::uint32_t left = 0; left < turned.columns; left += tile_edge) {
      const std::uint32_t right = std::min(turned.columns, left + tile_edge);
      for (std::uint32_t row = first; row < end; ++row)
        for (std::uint32_t column = left; column < right; ++column)
          turned.heights[std::size_t{row} * stride + column] =
              transposed ? tile.height(row, column) : tile.height(column, row);
    }
    for (std::uint32_t row = first; row < end; ++row)
      turned.heights[std::size_t{row} * stride + turned.columns] = turned.heights[std::size_t{row} * stride];
  });
  return turned;
}

/// The way of the beam over the turned heights.
struct Way {
  bool up = true;        ///< to higher rows
  double aside = 0.0;    ///< columns a row
  float fall = 0.0F;     ///< of a shadow's height, a row
  std::uint32_t before;  ///< rows from which a shadow can come
};

// Follows lines first … end − 1; marks in `lit` (a row as long as the heights') the places that they find lit.
void follow_lines(const Turned& relief, const Way& way, std::uint32_t first, std::uint32_t end,
                  std::vector<std::uint8_t>& lit) {
  std::vector<float> shade(end - first, -std::numeric_limits<float>::infinity());
  const auto rows = static_cast<std::int64_t>(relief.rows), columns = static_cast<std::int64_t>(relief.columns);
  for (std::int64_t step = -static_cast<std::int64_t>(way.before); step < rows; ++step) {
    const std::int64_t turns = way.up ? step : -step;
    const std::int64_t row = ((turns % rows) + rows) % rows;
    const double aside = static_cast<double>(step) * way.aside, whole = std::floor(aside);
    const auto part = static_cast<float>(aside - whole);
    const float* heights = relief.row(static_cast<std::uint32_t>(row));
    std::uint8_t* marks = step < 0 ? nullptr : lit.data() + row * columns;
    for (std::int64_t line = first; line < end;) {
      const std::int64_t at = (((line + static_cast<std::int64_t>(whole)) % columns) + columns) % columns;
      const std::int64_t count = std::min<std::int64_t>(end - line, columns - at);
      float* shadow = shade.data() + (line - first);
      for (std::int64_t k = 0; k < count; ++k) {
        const float left = heights[at + k], right = heights[at + k + 1];
        const float z = left + part * (right - left), dark_below = shadow[k] - way.fall;
        if (marks != nullptr) marks[at + k] = z >= dark_below ? 1 : 0;
        shadow[k] = std::max(z, dark_below);
      }
      line += count;
    }
  }
}

}  // namespace

std::vector<std::uint8_t> sweep_light(const PeriodicTile& tile, const Direction& to_light) {
  const double along_x = to_light.x(), along_y = to_light.y() / tile.cell_y();
  const bool transposed = std::abs(along_x) > std::abs(along_y);
  const double along = transposed ? along_x : along_y, across = transposed ? along_y : along_x;
  std::vector<std::uint8_t> cells(std::size_t{tile.columns()} * tile.rows(), 2);
  const double height = tile.highest() - tile.lowest();
  // A shadow that is shorter than a thousandth of a cell darkens nothing.
  if (height * std::abs(along) < 1e-3 * to_light.z()) return cells;

  const Turned relief = turn(tile, transposed);
  Way way{along < 0.0, -across / std::abs(along), static_cast<float>(to_light.z() / std::abs(along)), 0};
  way.before = static_cast<std::uint32_t>(
      std::min<double>(std::ceil(height / double{way.fall}) + 1.0, double{most_laps} * relief.rows));
  std::vector<std::uint8_t> lit(cells.size());
  tbb::parallel_for(std::uint32_t{0}, (relief.columns + lines_together - 1) / lines_together, [&](std::uint32_t band) {
    follow_lines(relief, way, band * lines_together, std::min(relief.columns, (band + 1) * lines_together), lit);
  });
  tbb::parallel_for(std::uint32_t{0}, tile.rows(), [&](std::uint32_t row) {
    for (std::uint32_t column = 0; column < tile.columns(); ++column) {
      const std::uint32_t here = transposed ? column : row, aside = transposed ? row : column;
      const std::uint32_t next = here + 1 == relief.rows ? 0 : here + 1;
      cells[std::size_t{row} * tile.columns() + column] = static_cast<std::uint8_t>(
          lit[std::size_t{here} * relief.columns + aside] + lit[std::size_t{next} * relief.columns + aside]);
    }
  });
  return cells;
}

}  // namespace mezzotint
