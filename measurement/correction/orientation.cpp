#include "measurement/correction/orientation.h"

#include <cmath>
#include <string>
#include <vector>

#include <tbb/parallel_for.h>

#include "forward/base/error.h"
#include "forward/surface/resample.h"

namespace mezzotint {

namespace {

// A field of another grid whose sample (column, row) is at(column, row).
template <class At>
HeightField rearranged(const HeightField& field, const Grid& grid, Continuation ends, const At& at) {
  std::vector<float> heights_um(grid.size());
  tbb::parallel_for(std::size_t{0}, grid.rows, [&](std::size_t row) {
    for (std::size_t column = 0; column < grid.columns; ++column)
      heights_um[row * grid.columns + column] = static_cast<float>(at(column, row));
  });
  return HeightField(grid, ends, std::move(heights_um), field.datum());
}

std::size_t new_count(std::size_t count, Length pitch, Length wanted, bool periodic) {
  require(std::isfinite(wanted.um()) && wanted.um() > 0.0, "a spacing must be positive and finite");
  const double intervals = static_cast<double>(periodic ? count : count - 1) * (pitch / wanted);
  require(intervals >= 1.0 && intervals < 0x1p30, "this spacing leaves fewer than two samples, or more than 2^30");
  if (!periodic) return static_cast<std::size_t>(intervals * (1.0 + 1e-12)) + 1;
  const double whole = std::round(intervals);
  require(std::abs(intervals - whole) < 1e-6 * intervals,
          "a periodic field keeps its period: its length must be a whole number of the new spacings, not " +
              std::to_string(intervals));
  return static_cast<std::size_t>(whole);
}

}  // namespace

HeightField mirrored_in_x(const HeightField& field) {
  const std::size_t last = field.columns() - 1;
  return rearranged(field, field.grid(), field.continuation(),
                    [&](std::size_t column, std::size_t row) { return field.at(last - column, row); });
}

HeightField mirrored_in_y(const HeightField& field) {
  const std::size_t last = field.rows() - 1;
  return rearranged(field, field.grid(), field.continuation(),
                    [&](std::size_t column, std::size_t row) { return field.at(column, last - row); });
}

HeightField turned_by_quarters(const HeightField& field, int quarters) {
  const Grid& grid = field.grid();
  const Grid other{grid.rows, grid.columns, grid.pitch_y, grid.pitch_x};
  switch ((quarters % 4 + 4) % 4) {
    case 1:  // (x, y) → (−y, x)
      return rearranged(field, other, field.continuation(),
                        [&](std::size_t column, std::size_t row) { return field.at(row, grid.rows - 1 - column); });
    case 2:
      return mirrored_in_x(mirrored_in_y(field));
    case 3:
      return rearranged(field, other, field.continuation(),
                        [&](std::size_t column, std::size_t row) { return field.at(grid.columns - 1 - row, column); });
    default:
      return field;
  }
}

HeightField upside_down(const HeightField& field) {
  std::vector<float> heights_um(field.heights_um().begin(), field.heights_um().end());
  for (float& z : heights_um) z = -z;
  return HeightField(field.grid(), field.continuation(), std::move(heights_um), -field.datum());
}

HeightField resampled(const HeightField& field, Length pitch_x, Length pitch_y) {
  const Grid& old = field.grid();
  const Grid grid{new_count(old.columns, old.pitch_x, pitch_x, field.periodic()),
                  new_count(old.rows, old.pitch_y, pitch_y, field.periodic()), pitch_x, pitch_y};
  require_valid_grid(grid);
  const bool coarser = pitch_x > old.pitch_x || pitch_y > old.pitch_y;
  const HeightField source = coarser ? area_average(field, pitch_x, pitch_y) : field;
  return rearranged(field, grid, field.continuation(), [&](std::size_t column, std::size_t row) {
    return height_um_at(source, {static_cast<double>(column) * pitch_x.um(), static_cast<double>(row) * pitch_y.um()});
  });
}

HeightField turned(const HeightField& field, Angle angle) {
  require(std::isfinite(angle.radians()), "an angle must be finite");
  const Grid& grid = field.grid();
  const FieldPoint middle = middle_of(grid);
  const double c = std::cos(angle.radians()), s = std::sin(angle.radians());
  // As a patch: nothing comes round from the other end of a period.
  const HeightField patch(grid, Continuation::Mirrored, {field.heights_um().begin(), field.heights_um().end()},
                          field.datum());
  return rearranged(patch, grid, Continuation::Mirrored, [&](std::size_t column, std::size_t row) {
    const double x = static_cast<double>(column) * grid.pitch_x.um() - middle.x_um;
    const double y = static_cast<double>(row) * grid.pitch_y.um() - middle.y_um;
    return height_um_at(patch, {middle.x_um + c * x + s * y, middle.y_um - s * x + c * y});
  });
}

}  // namespace mezzotint
