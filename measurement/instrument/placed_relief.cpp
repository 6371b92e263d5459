#include "measurement/instrument/placed_relief.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace mezzotint {

namespace {

constexpr double missing = std::numeric_limits<double>::quiet_NaN();

int points_across(const HeightField& relief, Length pitch) {
  const double finest = std::min(relief.grid().pitch_x.um(), relief.grid().pitch_y.um());
  return static_cast<int>(std::max(1.0, std::ceil(pitch.um() / finest - 1e-9)));
}

}  // namespace

FieldPoint extent_of(const HeightField& relief) {
  const std::size_t cells = relief.periodic() ? 0 : 1;
  return {static_cast<double>(relief.columns() - cells) * relief.grid().pitch_x.um(),
          static_cast<double>(relief.rows() - cells) * relief.grid().pitch_y.um()};
}

PlacedRelief::PlacedRelief(const HeightField& relief, const VirtualProfilometer& instrument)
    : relief_(relief),
      extent_(extent_of(relief)),
      middle_(middle_of(relief.grid())),
      shift_{instrument.shift_x.um(), instrument.shift_y.um()},
      cos_(std::cos(instrument.rotation.radians())),
      sin_(std::sin(instrument.rotation.radians())),
      tilt_x_(instrument.tilt_x),
      tilt_y_(instrument.tilt_y),
      width_um_(instrument.pitch.um()),
      across_(points_across(relief, instrument.pitch)) {}

FieldPoint PlacedRelief::on_relief(FieldPoint seen) const {
  const double x = seen.x_um - middle_.x_um - shift_.x_um;
  const double y = seen.y_um - middle_.y_um - shift_.y_um;
  return {cos_ * x + sin_ * y + middle_.x_um, -sin_ * x + cos_ * y + middle_.y_um};
}

bool PlacedRelief::holds(FieldPoint point) const {
  constexpr double round_off_um = 1e-7;
  const auto within = [](double x, double end) { return x >= -round_off_um && x <= end + round_off_um; };
  return within(point.x_um, extent_.x_um) && within(point.y_um, extent_.y_um);
}

double PlacedRelief::height_um(FieldPoint seen) const {
  const FieldPoint point = on_relief(seen);
  return holds(point) ? height_um_at(relief_, point) : missing;
}

double PlacedRelief::pixel_um(FieldPoint seen) const {
  const int n = across_;
  double sum = 0.0;
  for (int j = 0; j < n; ++j) {
    for (int i = 0; i < n; ++i) {
      sum += height_um({seen.x_um + ((i + 0.5) / n - 0.5) * width_um_, seen.y_um + ((j + 0.5) / n - 0.5) * width_um_});
    }
  }
  double tilted = sum / (n * n);
  tilted += tilt_x_ * (seen.x_um - middle_.x_um);
  tilted += tilt_y_ * (seen.y_um - middle_.y_um);
  return tilted;
}

double PlacedRelief::slope(FieldPoint seen) const {
  const FieldPoint point = on_relief(seen);
  if (!holds(point)) return missing;
  const SurfacePoint s = surface_at(relief_, point);
  return std::hypot(cos_ * s.slope_x - sin_ * s.slope_y + tilt_x_, sin_ * s.slope_x + cos_ * s.slope_y + tilt_y_);
}

}  // namespace mezzotint
