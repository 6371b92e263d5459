#include "forward/surface/resample.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "forward/base/error.h"

namespace mezzotint {

namespace {

using Four = std::array<double, 4>;
constexpr double missing = std::numeric_limits<double>::quiet_NaN();
// Coordinates that went through a rotation and back are off by some 1e-12 samples; without this a point meant
// to lie on a sample would need that sample's neighbours too.
constexpr double on_sample = 1e-9;

/// The sample before a place along one axis, and how far it is to the next.
struct AxisPlace {
  std::ptrdiff_t sample = 0;
  double fraction = 0.0;
  bool inside = false;
};

AxisPlace place_on_axis(double samples, std::size_t count, bool periodic) {
  const double last = static_cast<double>(count) - 1.0;
  // The first test keeps NaN, and numbers that no integer holds, from the conversion below.
  if (!(std::abs(samples) < 1e9)) return {};
  if (!periodic && (samples < -on_sample || samples > last + on_sample)) return {};
  const double floor = std::floor(samples + on_sample);
  const double fraction = std::max(0.0, samples - floor);
  return {static_cast<std::ptrdiff_t>(floor), fraction < on_sample ? 0.0 : fraction, true};
}

/// Keys's kernel for a = −½ at the four samples around t, and its derivative.
Four keys_weights(double t) {
  return {((-0.5 * t + 1.0) * t - 0.5) * t, (1.5 * t - 2.5) * t * t + 1.0, ((-1.5 * t + 2.0) * t + 0.5) * t,
          (0.5 * t - 0.5) * t * t};
}
Four keys_slope_weights(double t) {
  return {(-1.5 * t + 2.0) * t - 0.5, (4.5 * t - 5.0) * t, (-4.5 * t + 4.0) * t + 0.5, (1.5 * t - 1.0) * t};
}

double dot(const Four& a, const Four& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3]; }

/// Replaces what is missing of four samples in line, where the middle two are there. Leaves them alone elsewhere.
void extrapolate_missing(Four& f, double t) {
  if (t == 0.0 && std::isnan(f[2])) f[2] = 2.0 * f[1] - f[0];
  if (std::isnan(f[1]) || std::isnan(f[2])) return;
  const bool first = !std::isnan(f[0]);
  const bool last = !std::isnan(f[3]);
  if (!first) f[0] = last ? 3.0 * f[1] - 3.0 * f[2] + f[3] : 2.0 * f[1] - f[2];
  if (!last) f[3] = first ? 3.0 * f[2] - 3.0 * f[1] + f[0] : 2.0 * f[2] - f[1];
}

double value_on_line(Four f, double t) {
  if (t == 0.0) return f[1];
  extrapolate_missing(f, t);
  return dot(keys_weights(t), f);
}
double slope_on_line(Four f, double t) {
  extrapolate_missing(f, t);
  return dot(keys_slope_weights(t), f);
}

/// Height (or missing) of any sample, beyond the ends too.
double sample_um(const HeightField& field, std::ptrdiff_t column, std::ptrdiff_t row) {
  const auto columns = static_cast<std::ptrdiff_t>(field.columns());
  const auto rows = static_cast<std::ptrdiff_t>(field.rows());
  if (field.periodic()) {
    column = (column % columns + columns) % columns;
    row = (row % rows + rows) % rows;
  } else if (column < 0 || column >= columns || row < 0 || row >= rows) {
    return missing;
  }
  return static_cast<double>(field.at(static_cast<std::size_t>(column), static_cast<std::size_t>(row)));
}

using Patch = std::array<Four, 4>;

Patch patch_around(const HeightField& field, std::ptrdiff_t column, std::ptrdiff_t row) {
  const auto columns = static_cast<std::ptrdiff_t>(field.columns());
  const auto rows = static_cast<std::ptrdiff_t>(field.rows());
  const bool inner = column >= 1 && column + 2 < columns && row >= 1 && row + 2 < rows;
  Patch patch;
  for (std::ptrdiff_t j = 0; j < 4; ++j) {
    for (std::ptrdiff_t i = 0; i < 4; ++i) {
      const std::ptrdiff_t c = column + i - 1;
      const std::ptrdiff_t r = row + j - 1;
      patch[j][i] = inner ? static_cast<double>(field.heights_um()[r * columns + c]) : sample_um(field, c, r);
    }
  }
  return patch;
}

/// One number per line of the patch.
template <class OnLine>
Four along_rows(const Patch& patch, OnLine on_line) {
  return {on_line(patch[0]), on_line(patch[1]), on_line(patch[2]), on_line(patch[3])};
}

struct Place {
  AxisPlace x;
  AxisPlace y;
  [[nodiscard]] bool inside() const { return x.inside && y.inside; }
};

Place place_in(const HeightField& field, FieldPoint point) {
  const Grid& grid = field.grid();
  return {place_on_axis(point.x_um / grid.pitch_x.um(), grid.columns, field.periodic()),
          place_on_axis(point.y_um / grid.pitch_y.um(), grid.rows, field.periodic())};
}

/// Height and slopes per sample; NaN as soon as one sample is missing.
SurfacePoint with_all_samples(const Patch& patch, const Place& place) {
  const Four wx = keys_weights(place.x.fraction);
  const Four wy = keys_weights(place.y.fraction);
  const Four slope_wx = keys_slope_weights(place.x.fraction);
  const Four values = along_rows(patch, [&](const Four& f) { return dot(wx, f); });
  const Four slopes = along_rows(patch, [&](const Four& f) { return dot(slope_wx, f); });
  return {dot(wy, values), dot(wy, slopes), dot(keys_slope_weights(place.y.fraction), values)};
}

/// The same where samples are missing: slower, and with what can be extrapolated.
SurfacePoint with_extrapolation(const Patch& patch, const Place& place) {
  const double tx = place.x.fraction;
  const double ty = place.y.fraction;
  const Four values = along_rows(patch, [&](const Four& f) { return value_on_line(f, tx); });
  const Four slopes = along_rows(patch, [&](const Four& f) { return slope_on_line(f, tx); });
  return {value_on_line(values, ty), value_on_line(slopes, ty), slope_on_line(values, ty)};
}

/// The weights of a moving mean: 1 for samples whose cell lies within, a fraction for the two that it cuts.
struct Box {
  Box(Length width, Length pitch) : half(std::max(0.5, 0.5 * (width / pitch))) {
    reach = static_cast<std::ptrdiff_t>(std::ceil(half - 0.5 - on_sample));
  }
  [[nodiscard]] double weight(std::ptrdiff_t distance) const {
    return std::clamp(half + 0.5 - std::abs(static_cast<double>(distance)), 0.0, 1.0);
  }
  double half;
  std::ptrdiff_t reach = 0;
};

/// A moving sum along lines of `count` values, `stride` apart.
std::vector<double> moving_sum(const std::vector<double>& values, const Grid& grid, const Box& box, bool along_x,
                               bool periodic) {
  const auto count = static_cast<std::ptrdiff_t>(along_x ? grid.columns : grid.rows);
  std::vector<double> sums(values.size());
  for (std::size_t r = 0; r < grid.rows; ++r) {
    for (std::ptrdiff_t k = -box.reach; k <= box.reach; ++k) {
      const double weight = box.weight(k);
      for (std::size_t c = 0; c < grid.columns; ++c) {
        std::ptrdiff_t other = static_cast<std::ptrdiff_t>(along_x ? c : r) + k;
        // A box is no wider than the field, so one period is enough to come back.
        if (periodic) other += other < 0 ? count : (other >= count ? -count : 0);
        if (other < 0 || other >= count) continue;
        const std::size_t from = along_x ? r * grid.columns + static_cast<std::size_t>(other)
                                         : static_cast<std::size_t>(other) * grid.columns + c;
        sums[r * grid.columns + c] += weight * values[from];
      }
    }
  }
  return sums;
}

void require_valid_average(const HeightField& field, Length width_x, Length width_y, double least_share) {
  const auto fits = [](Length width, Length pitch, std::size_t count) {
    return width.um() >= 0.0 && width <= pitch * static_cast<double>(count);
  };
  const Grid& grid = field.grid();
  require(fits(width_x, grid.pitch_x, grid.columns) && fits(width_y, grid.pitch_y, grid.rows),
          "the rectangle of an area average must not be negative, nor wider than the field");
  require(least_share > 0.0 && least_share <= 1.0, "the least share of an area average must lie in (0, 1]");
}

}  // namespace

FieldPoint middle_of(const Grid& grid) {
  return {0.5 * static_cast<double>(grid.columns - 1) * grid.pitch_x.um(),
          0.5 * static_cast<double>(grid.rows - 1) * grid.pitch_y.um()};
}

double height_um_at(const HeightField& field, FieldPoint point) {
  const Place place = place_in(field, point);
  if (!place.inside()) return missing;
  const Patch patch = patch_around(field, place.x.sample, place.y.sample);
  const Four weights = keys_weights(place.x.fraction);
  const double height =
      dot(along_rows(patch, [&](const Four& f) { return dot(weights, f); }), keys_weights(place.y.fraction));
  if (!std::isnan(height)) return height;
  return value_on_line(along_rows(patch, [&](const Four& f) { return value_on_line(f, place.x.fraction); }),
                       place.y.fraction);
}

SurfacePoint surface_at(const HeightField& field, FieldPoint point) {
  const Place place = place_in(field, point);
  if (!place.inside()) return {missing, missing, missing};
  const Patch patch = patch_around(field, place.x.sample, place.y.sample);
  const SurfacePoint whole = with_all_samples(patch, place);
  const bool complete = !std::isnan(whole.height_um) && !std::isnan(whole.slope_x) && !std::isnan(whole.slope_y);
  const SurfacePoint at_point = complete ? whole : with_extrapolation(patch, place);
  return {at_point.height_um, at_point.slope_x / field.grid().pitch_x.um(),
          at_point.slope_y / field.grid().pitch_y.um()};
}

HeightField area_average(const HeightField& field, Length width_x, Length width_y, double least_share) {
  require_valid_average(field, width_x, width_y, least_share);
  const Grid& grid = field.grid();
  const Box box_x(width_x, grid.pitch_x);
  const Box box_y(width_y, grid.pitch_y);
  std::vector<double> sums(grid.size());
  std::vector<double> shares(grid.size());
  for (std::size_t k = 0; k < sums.size(); ++k) {
    const float height = field.heights_um()[k];
    shares[k] = std::isnan(height) ? 0.0 : 1.0;
    sums[k] = std::isnan(height) ? 0.0 : static_cast<double>(height);
  }
  for (auto* values : {&sums, &shares}) {
    *values = moving_sum(*values, grid, box_x, true, field.periodic());
    *values = moving_sum(*values, grid, box_y, false, field.periodic());
  }
  const double least = (least_share - on_sample) * 4.0 * box_x.half * box_y.half;
  std::vector<float> means(grid.size(), std::numeric_limits<float>::quiet_NaN());
  for (std::size_t k = 0; k < means.size(); ++k) {
    if (shares[k] >= least) means[k] = static_cast<float>(sums[k] / shares[k]);
  }
  return {grid, field.continuation(), std::move(means), field.datum()};
}

}  // namespace mezzotint
