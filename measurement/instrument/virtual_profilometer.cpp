#include "measurement/instrument/virtual_profilometer.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "forward/base/error.h"
#include "forward/base/random.h"
#include "forward/surface/resample.h"

namespace mezzotint {

namespace {

constexpr double missing = std::numeric_limits<double>::quiet_NaN();
constexpr std::uint32_t noise_draw = 0;
constexpr std::uint32_t missing_draw = 1;

void require_valid(const VirtualProfilometer& instrument) {
  for (const double number : {instrument.pitch.um(), instrument.shift_x.um(), instrument.shift_y.um(),
                              instrument.rotation.radians(), instrument.tilt_x, instrument.tilt_y}) {
    require(std::isfinite(number), "every figure of a virtual profilometer must be finite");
  }
  require(instrument.pitch.um() > 0.0, "the pitch of a virtual profilometer must be positive");
  require(instrument.noise.um() >= 0.0 && std::isfinite(instrument.noise.um()),
          "the noise of a virtual profilometer must not be negative");
  require(instrument.missing_share >= 0.0 && instrument.missing_share <= 0.5,
          "the missing share of a virtual profilometer must lie in [0, 0.5]");
}

/// How far the relief is known: a periodic one up to the end of its period, where it begins again.
FieldPoint extent_of(const HeightField& relief) {
  const std::size_t cells = relief.periodic() ? 0 : 1;
  return {static_cast<double>(relief.columns() - cells) * relief.grid().pitch_x.um(),
          static_cast<double>(relief.rows() - cells) * relief.grid().pitch_y.um()};
}

std::size_t samples_along(double extent_um, double pitch_um, bool periodic) {
  constexpr double round_off = 1e-9;  // 100 µm at 0.1 µm are 1000 steps, not 999
  const double steps = extent_um / pitch_um;
  // The end of a period is its beginning, and not measured twice.
  const double count = periodic ? std::ceil(steps - round_off) : std::floor(steps + round_off) + 1.0;
  require(count <= static_cast<double>(std::size_t{1} << 30),
          "the pitch of a virtual profilometer is too small: more than 2^30 samples in a row");
  return static_cast<std::size_t>(std::max(1.0, count));
}

Grid grid_of(const HeightField& relief, Length pitch) {
  const FieldPoint extent = extent_of(relief);
  return {samples_along(extent.x_um, pitch.um(), relief.periodic()),
          samples_along(extent.y_um, pitch.um(), relief.periodic()), pitch, pitch};
}

/// The relief as it lies under the instrument.
class PlacedRelief {
public:
  PlacedRelief(const HeightField& relief, const VirtualProfilometer& instrument)
      : relief_(relief),
        extent_(extent_of(relief)),
        middle_(middle_of(relief.grid())),
        shift_{instrument.shift_x.um(), instrument.shift_y.um()},
        cos_(std::cos(instrument.rotation.radians())),
        sin_(std::sin(instrument.rotation.radians())) {}

  [[nodiscard]] FieldPoint middle() const { return middle_; }

  /// Height under a point of the instrument.
  [[nodiscard]] double height_um(FieldPoint seen) const {
    const double x = seen.x_um - middle_.x_um - shift_.x_um;
    const double y = seen.y_um - middle_.y_um - shift_.y_um;
    const FieldPoint point{cos_ * x + sin_ * y + middle_.x_um, -sin_ * x + cos_ * y + middle_.y_um};
    return holds(point) ? height_um_at(relief_, point) : missing;
  }

  /// Mean over a square pixel, by n × n points at its cells' centres.
  [[nodiscard]] double pixel_um(FieldPoint seen, double width_um, int n) const {
    double sum = 0.0;
    for (int j = 0; j < n; ++j) {
      for (int i = 0; i < n; ++i) {
        sum += height_um({seen.x_um + ((i + 0.5) / n - 0.5) * width_um, seen.y_um + ((j + 0.5) / n - 0.5) * width_um});
      }
    }
    return sum / (n * n);
  }

private:
  [[nodiscard]] bool holds(FieldPoint point) const {
    constexpr double round_off_um = 1e-7;
    const auto within = [](double x, double end) { return x >= -round_off_um && x <= end + round_off_um; };
    return within(point.x_um, extent_.x_um) && within(point.y_um, extent_.y_um);
  }

  const HeightField& relief_;
  FieldPoint extent_;
  FieldPoint middle_;
  FieldPoint shift_;
  double cos_;
  double sin_;
};

/// Points across a pixel: close enough that none of the relief's samples is passed over.
int points_across(const HeightField& relief, Length pitch) {
  const double finest = std::min(relief.grid().pitch_x.um(), relief.grid().pitch_y.um());
  return static_cast<int>(std::max(1.0, std::ceil(pitch.um() / finest - 1e-9)));
}

}  // namespace

HeightField measure_virtually(const HeightField& relief, const VirtualProfilometer& instrument) {
  require_valid(instrument);
  const Grid grid = grid_of(relief, instrument.pitch);
  require_valid_grid(grid);
  const PlacedRelief placed(relief, instrument);
  const int across = points_across(relief, instrument.pitch);
  const RandomStream random(instrument.seed, RandomPurpose::InstrumentNoise);
  std::vector<float> heights_um(grid.size());
  for (std::size_t k = 0; k < heights_um.size(); ++k) {
    const std::size_t column = k % grid.columns;
    const std::size_t row = k / grid.columns;
    const FieldPoint seen{static_cast<double>(column) * instrument.pitch.um(),
                          static_cast<double>(row) * instrument.pitch.um()};
    double height_um = placed.pixel_um(seen, instrument.pitch.um(), across);
    height_um += instrument.tilt_x * (seen.x_um - placed.middle().x_um);
    height_um += instrument.tilt_y * (seen.y_um - placed.middle().y_um);
    height_um += instrument.noise.um() * random.normal4(k, noise_draw)[0];
    const bool unseen = random.uniform4(k, missing_draw)[0] < instrument.missing_share;
    heights_um[k] = static_cast<float>(unseen ? missing : height_um);
  }
  return {grid, Continuation::Mirrored, std::move(heights_um), relief.datum()};
}

}  // namespace mezzotint
