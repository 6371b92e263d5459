#include "measurement/instrument/virtual_profilometer.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include <tbb/parallel_for.h>

#include "forward/base/error.h"
#include "forward/base/random.h"
#include "measurement/correction/gaussian_filter.h"
#include "measurement/instrument/holes.h"
#include "measurement/instrument/light_collected.h"
#include "measurement/instrument/placed_relief.h"

namespace mezzotint {

namespace {

constexpr double missing = std::numeric_limits<double>::quiet_NaN();
constexpr std::uint32_t noise_draw = 0;
constexpr std::uint32_t missing_draw = 1;

void require_size(Length length, const char* name) {
  require(std::isfinite(length.um()) && length.um() >= 0.0,
          std::string("the ") + name + " of a virtual profilometer must not be negative");
}

void require_share(double share, const char* name) {
  require(share >= 0.0 && share <= 0.5,
          std::string("the ") + name + " share of a virtual profilometer must lie in [0, 0.5]");
}

void require_valid(const VirtualProfilometer& instrument) {
  for (const double number :
       {instrument.pitch.um(), instrument.shift_x.um(), instrument.shift_y.um(), instrument.rotation.radians(),
        instrument.tilt_x, instrument.tilt_y, instrument.offset.um()}) {
    require(std::isfinite(number), "every figure of a virtual profilometer must be finite");
  }
  require(instrument.pitch.um() > 0.0, "the pitch of a virtual profilometer must be positive");
  require_size(instrument.bandwidth, "bandwidth");
  require_size(instrument.noise, "noise");
  require_size(instrument.outlier_size, "outlier size");
  require_size(instrument.hole_diameter, "hole diameter");
  require_share(instrument.missing_share, "missing");
  require_share(instrument.outlier_share, "outlier");
  require_share(instrument.hole_share, "hole");
  require(instrument.hole_share == 0.0 || instrument.hole_diameter.um() > 0.0,
          "holes of a virtual profilometer need a diameter");
  require(instrument.aperture >= 0.0 && instrument.aperture <= 1.0,
          "the numerical aperture of a virtual profilometer must lie in [0, 1]");
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

/// One sample at a time, each a pure function of its number.
class Measurement {
public:
  Measurement(const HeightField& resolved, const VirtualProfilometer& instrument)
      : instrument_(instrument),
        placed_(resolved, instrument),
        holes_(instrument.hole_share, instrument.hole_diameter, instrument.seed),
        noise_(instrument.seed, RandomPurpose::InstrumentNoise),
        outlier_(instrument.seed, RandomPurpose::InstrumentOutlier) {}

  [[nodiscard]] double height_um(FieldPoint seen, std::uint64_t number) const {
    const double light = instrument_.aperture > 0.0 ? light_collected(placed_.slope(seen), instrument_.aperture) : 1.0;
    if (is_unseen(seen, light, number)) return missing;
    return placed_.pixel_um(seen) + error_um(light, number);
  }

private:
  [[nodiscard]] bool is_unseen(FieldPoint seen, double light, std::uint64_t number) const {
    const double probability = probability_at(light, instrument_.missing_share);
    // Nor is a sample seen whose slope is not known.
    return !(noise_.uniform4(number, missing_draw)[0] >= probability) || holes_.cover(seen);
  }

  [[nodiscard]] double error_um(double light, std::uint64_t number) const {
    const double noise = instrument_.noise.um() * noise_.normal4(number, noise_draw)[0];
    if (instrument_.outlier_share == 0.0) return noise;
    const auto draw = outlier_.uniform4(number);
    const bool spike = draw[0] < probability_at(light, instrument_.outlier_share);
    return noise + (spike ? instrument_.outlier_size.um() * (2.0 * draw[1] - 1.0) : 0.0);
  }

  const VirtualProfilometer& instrument_;
  PlacedRelief placed_;
  Holes holes_;
  RandomStream noise_, outlier_;
};

HeightField sample(const HeightField& resolved, const VirtualProfilometer& instrument, const Grid& grid) {
  const Measurement measurement(resolved, instrument);
  std::vector<float> heights_um(grid.size());
  tbb::parallel_for(std::size_t{0}, grid.rows, [&](std::size_t row) {
    for (std::size_t column = 0; column < grid.columns; ++column) {
      const FieldPoint seen{static_cast<double>(column) * instrument.pitch.um(),
                            static_cast<double>(row) * instrument.pitch.um()};
      const std::size_t number = row * grid.columns + column;
      heights_um[number] = static_cast<float>(measurement.height_um(seen, number));
    }
  });
  return {grid, Continuation::Mirrored, std::move(heights_um), resolved.datum() + instrument.offset};
}

}  // namespace

HeightField measure_virtually(const HeightField& relief, const VirtualProfilometer& instrument) {
  require_valid(instrument);
  const Grid grid = grid_of(relief, instrument.pitch);
  require_valid_grid(grid);
  if (instrument.bandwidth.um() == 0.0) return sample(relief, instrument, grid);
  return sample(s_filter(relief, instrument.bandwidth), instrument, grid);
}

}  // namespace mezzotint
