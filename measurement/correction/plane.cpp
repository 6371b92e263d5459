#include <cmath>

#include "forward/base/error.h"
#include "measurement/correction/plane.h"

namespace mezzotint {

namespace {

// x and y from the middle of the field, in µm.
double centred_um(std::size_t index, std::size_t count, Length pitch) {
  return (static_cast<double>(index) - 0.5 * static_cast<double>(count - 1)) * pitch.um();
}

struct Means {
  double count = 0.0, x = 0.0, y = 0.0, z = 0.0;
};

template <class Visit>
void for_each_measured(const HeightField& field, const Visit& visit) {
  for (std::size_t row = 0; row < field.rows(); ++row) {
    const double y = centred_um(row, field.rows(), field.grid().pitch_y);
    for (std::size_t column = 0; column < field.columns(); ++column) {
      const float z = field.at(column, row);
      if (!std::isnan(z)) visit(centred_um(column, field.columns(), field.grid().pitch_x), y, static_cast<double>(z));
    }
  }
}

Means means_of(const HeightField& field) {
  Means sums;
  for_each_measured(field, [&](double x, double y, double z) {
    sums.count += 1.0;
    sums.x += x;
    sums.y += y;
    sums.z += z;
  });
  require(sums.count >= 3.0, "a plane needs three measured samples at least");
  return {sums.count, sums.x / sums.count, sums.y / sums.count, sums.z / sums.count};
}

struct SecondMoments {
  double xx = 0.0, yy = 0.0, xy = 0.0, xz = 0.0, yz = 0.0;
};

SecondMoments moments_about(const Means& mean, const HeightField& field) {
  SecondMoments sums;
  for_each_measured(field, [&](double x, double y, double z) {
    const double dx = x - mean.x, dy = y - mean.y, dz = z - mean.z;
    sums.xx += dx * dx;
    sums.yy += dy * dy;
    sums.xy += dx * dy;
    sums.xz += dx * dz;
    sums.yz += dy * dz;
  });
  return sums;
}

}  // namespace

Plane fit_plane(const HeightField& field) {
  const Means mean = means_of(field);
  const SecondMoments m = moments_about(mean, field);
  const double determinant = m.xx * m.yy - m.xy * m.xy;
  // Samples on one line leave rounding only; the narrowest diagonal strip of a 2^15-wide field leaves 1e-9.
  constexpr double rounding = 1e-12;
  require(determinant > rounding * m.xx * m.yy,
          "the measured samples lie on one line; a plane needs three that do not");
  const double slope_x = (m.xz * m.yy - m.yz * m.xy) / determinant;
  const double slope_y = (m.yz * m.xx - m.xz * m.xy) / determinant;
  return {Length::from_um(mean.z - slope_x * mean.x - slope_y * mean.y), slope_x, slope_y};
}

HeightField subtract_plane(const HeightField& field, const Plane& plane) {
  std::vector<float> levelled_um(field.grid().size());
  for (std::size_t row = 0; row < field.rows(); ++row) {
    const double y = centred_um(row, field.rows(), field.grid().pitch_y);
    for (std::size_t column = 0; column < field.columns(); ++column) {
      const double x = centred_um(column, field.columns(), field.grid().pitch_x);
      const double z = plane.offset.um() + plane.slope_x * x + plane.slope_y * y;
      levelled_um[row * field.columns() + column] = static_cast<float>(field.at(column, row) - z);
    }
  }
  const bool is_level = plane.slope_x == 0.0 && plane.slope_y == 0.0;
  return HeightField(field.grid(), is_level ? field.continuation() : Continuation::Mirrored, std::move(levelled_um),
                     field.datum() + plane.offset);
}

HeightField level(const HeightField& field) { return subtract_plane(field, fit_plane(field)); }

}  // namespace mezzotint
