#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "forward/base/error.h"
#include "measurement/comparison/placement.h"
#include "measurement/comparison/registration.h"
#include "measurement/correction/plane.h"

namespace mezzotint {

namespace {

/// As a patch, without continuation, at the resolution of the design at most.
HeightField as_seen_by_design(const HeightField& measured, const Grid& design) {
  const HeightField patch(measured.grid(), Continuation::Mirrored,
                          {measured.heights_um().begin(), measured.heights_um().end()}, measured.datum());
  // Four fifths: a lost sample here and there does no harm, but means at the rim, one-sided, would follow the slope.
  return area_average(patch, design.pitch_x, design.pitch_y, 0.8);
}

HeightField in_design_frame(const HeightField& design, const HeightField& measured, const Registration& registration) {
  const Grid& grid = design.grid();
  const Placement placement{middle_of(grid),
                            {registration.shift_x.value.um(), registration.shift_y.value.um()},
                            registration.rotation.value.radians()};
  const HeightField seen = as_seen_by_design(measured, grid);
  std::vector<float> heights_um(grid.size());
  for (std::size_t k = 0; k < heights_um.size(); ++k) {
    const std::size_t column = k % grid.columns;
    const std::size_t row = k / grid.columns;
    const FieldPoint point{static_cast<double>(column) * grid.pitch_x.um(),
                           static_cast<double>(row) * grid.pitch_y.um()};
    heights_um[k] = static_cast<float>(height_um_at(seen, placement.to_measured(point)));
  }
  return {grid, Continuation::Mirrored, std::move(heights_um), design.datum()};
}

}  // namespace

HeightField resample_to_design(const HeightField& design, const HeightField& measured,
                               const Registration& registration) {
  const HeightField resampled = in_design_frame(design, measured, registration);
  const HeightField levelled = subtract_plane(resampled, fit_plane(residual(design, resampled)));
  // The plane's offset belongs to the instrument: heights are now those of the design's own frame.
  return {levelled.grid(),
          Continuation::Mirrored,
          {levelled.heights_um().begin(), levelled.heights_um().end()},
          design.datum()};
}

HeightField residual(const HeightField& design, const HeightField& resampled) {
  require(design.grid() == resampled.grid(),
          "a residual needs the measurement on the design's grid; resample_to_design brings it there");
  std::vector<float> difference_um(design.grid().size());
  for (std::size_t k = 0; k < difference_um.size(); ++k) {
    difference_um[k] = resampled.heights_um()[k] - design.heights_um()[k];  // NaN where either is missing
  }
  return {design.grid(), Continuation::Mirrored, std::move(difference_um)};
}

}  // namespace mezzotint
