#include "measurement/correction/plane.h"

#include <cmath>
#include <utility>

#include "forward/base/error.h"
#include "forward/surface/row_bands.h"
#include "measurement/correction/plane_rows.h"

namespace mezzotint {

namespace {

// Sums over the measured samples of places (from an origin, µm) and heights (above a reference).
struct Sums {
  double count = 0.0, x = 0.0, y = 0.0, z = 0.0, xx = 0.0, yy = 0.0, xy = 0.0, xz = 0.0, yz = 0.0;

  void add(const RowMoments& row, double at_y) {
    count += row.count;
    x += row.x;
    y += row.count * at_y;
    z += row.z;
    xx += row.xx;
    yy += row.count * at_y * at_y;
    xy += row.x * at_y;
    xz += row.xz;
    yz += row.z * at_y;
  }
  Sums& operator+=(const Sums& o) {
    count += o.count;
    x += o.x;
    y += o.y;
    z += o.z;
    xx += o.xx;
    yy += o.yy;
    xy += o.xy;
    xz += o.xz;
    yz += o.yz;
    return *this;
  }
  /// About their own means.
  [[nodiscard]] Sums central() const {
    Sums c;
    c.xx = xx - x * x / count;
    c.yy = yy - y * y / count;
    c.xy = xy - x * y / count;
    c.xz = xz - x * z / count;
    c.yz = yz - y * z / count;
    return c;
  }
};

struct Origin {
  double x = 0.0, y = 0.0, z = 0.0;  // x, y from the middle of the field
};

Sums sums_about(const HeightField& field, const Origin& origin) {
  const double pitch_x = field.grid().pitch_x.um();
  return sum_of_bands(field.rows(), Sums{}, [&](std::size_t first, std::size_t end) {
    Sums sums;
    for (std::size_t row = first; row < end; ++row) {
      const RowPlaces places{centred_um(0, field.columns(), field.grid().pitch_x) - origin.x, pitch_x};
      sums.add(row_moments(row_of(field, row), places, origin.z),
               centred_um(row, field.rows(), field.grid().pitch_y) - origin.y);
    }
    return sums;
  });
}

}  // namespace

Plane fit_plane(const HeightField& field) {
  const Sums about_middle = sums_about(field, {});
  const double n = about_middle.count;
  require(n >= 3.0, "a plane needs three measured samples at least");
  // Again about the means: samples far from the middle, or heights far from 0, would lose their digits otherwise.
  const Origin mean{about_middle.x / n, about_middle.y / n, about_middle.z / n};
  const Sums m = sums_about(field, mean).central();
  const double determinant = m.xx * m.yy - m.xy * m.xy;
  // Samples on one line leave rounding only; the narrowest diagonal strip of a 2^15-wide field leaves 1e-9.
  constexpr double rounding = 1e-12;
  require(determinant > rounding * m.xx * m.yy,
          "the measured samples lie on one line; a plane needs three that do not");
  const double slope_x = (m.xz * m.yy - m.yz * m.xy) / determinant;
  const double slope_y = (m.yz * m.xx - m.xz * m.xy) / determinant;
  return {Length::from_um(mean.z - slope_x * mean.x - slope_y * mean.y), slope_x, slope_y};
}

HeightField subtract_plane(HeightField field, const Plane& plane) {
  for_each_band(field.rows(), [&](std::size_t, std::size_t first, std::size_t end) {
    for (std::size_t row = first; row < end; ++row) subtract_line(row_of(field, row), line_of(plane, field, row));
  });
  const bool is_level = plane.slope_x == 0.0 && plane.slope_y == 0.0;
  field.set_frame(is_level ? field.continuation() : Continuation::Mirrored, field.datum() + plane.offset);
  return field;
}

HeightField level(HeightField field) {
  const Plane plane = fit_plane(field);
  return subtract_plane(std::move(field), plane);
}

}  // namespace mezzotint
