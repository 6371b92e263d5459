#include "forward/process/lorentzian_kernel.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <numeric>
#include <span>

namespace mezzotint {

namespace {

// How far from a sample, in pixels, the copies of a periodic plane count one by one. Smearing out those beyond a
// distance R is a midpoint rule with steps of the (longer) period n: it leaves n²·w/(19 R³) of the light wrong, nearly
// all of it alike for all pixels, which the sum sets right; a twentieth remains, 1e-6 at this R.
double near_reach(const WeightPlane& plane, double width) {
  const auto n = static_cast<double>(std::max(plane.columns, plane.rows));
  return 14.0 * std::cbrt(n * n * width);
}

// Copies on every side of an axis within that reach.
int copies(std::size_t period, double reach) {
  return std::max(1, static_cast<int>(std::ceil(reach / static_cast<double>(period) - 0.5)));
}

// The offset, in pixels, of entry `index` of a plane: 0, 1, …, then from the far end −1, −2, …
std::int64_t offset(std::size_t index, std::size_t count) {
  const auto i = static_cast<std::int64_t>(index), n = static_cast<std::int64_t>(count);
  return i <= (n - 1) / 2 ? i : i - n;
}

template <class Corner>
double rectangle(const Corner& corner, double left, double right, double low, double high) {
  return corner(right, high) - corner(left, high) - corner(right, low) + corner(left, low);
}

// Adds the pixels of one copy of the plane; neighbours share their corners.
template <class Corner>
void add_copy(const Corner& corner, std::span<double> weights, std::size_t columns, std::size_t rows, double x0,
              double y0) {
  const auto first_x = static_cast<double>(offset(columns / 2 + columns % 2, columns));
  const auto first_y = static_cast<double>(offset(rows / 2 + rows % 2, rows));
  std::vector<double> below(columns + 1), above(columns + 1);
  const auto fill = [&](std::vector<double>& line, double y) {
    for (std::size_t i = 0; i <= columns; ++i) line[i] = corner(x0 + first_x + static_cast<double>(i), y);
  };
  fill(below, y0 + first_y);
  for (std::size_t j = 0; j < rows; ++j) {
    fill(above, y0 + first_y + static_cast<double>(j + 1));
    const std::size_t row = (j + rows / 2 + rows % 2) % rows;
    for (std::size_t i = 0; i < columns; ++i) {
      const std::size_t column = (i + columns / 2 + columns % 2) % columns;
      weights[row * columns + column] += (above[i + 1] - above[i]) - (below[i + 1] - below[i]);
    }
    std::swap(below, above);
  }
}

// Light of all further copies of a pixel, each smeared over a plane around it: what a square around the pixel, as wide
// as the copies that were added, leaves of the whole.
template <class Corner>
void add_far_copies(const Corner& corner, double whole, std::span<double> weights, std::size_t columns,
                    std::size_t rows, double x0, double y0, double half_x, double half_y) {
  const double share = 1.0 / static_cast<double>(columns * rows);
  for (std::size_t row = 0; row < rows; ++row) {
    const double y = y0 + static_cast<double>(offset(row, rows)) + 0.5;
    for (std::size_t column = 0; column < columns; ++column) {
      const double x = x0 + static_cast<double>(offset(column, columns)) + 0.5;
      const double near = rectangle(corner, x - half_x, x + half_x, y - half_y, y + half_y);
      weights[row * columns + column] += share * (whole - near);
    }
  }
  const double missing = share * (whole - std::accumulate(weights.begin(), weights.end(), 0.0));
  for (double& weight : weights) weight += missing;
}

template <class Corner>
std::vector<double> weights_of(const Corner& corner, double whole, const WeightPlane& plane, int copies_x,
                               int copies_y) {
  const auto columns = static_cast<double>(plane.columns), rows = static_cast<double>(plane.rows);
  const double x0 = -plane.position_x, y0 = -plane.position_y;
  std::vector<double> weights(plane.columns * plane.rows, 0.0);
  for (int v = -copies_y; v <= copies_y; ++v) {
    for (int u = -copies_x; u <= copies_x; ++u)
      add_copy(corner, weights, plane.columns, plane.rows, x0 + u * columns, y0 + v * rows);
  }
  if (plane.periodic)
    add_far_copies(corner, whole, weights, plane.columns, plane.rows, x0, y0, (copies_x + 0.5) * columns,
                   (copies_y + 0.5) * rows);
  return weights;
}

}  // namespace

double LorentzianKernel::corner(LightPart part, double x, double y) const {
  const double w2 = width * width, xx = x * x + w2, yy = y * y + w2, r = std::sqrt(xx + y * y);
  constexpr double turn = 2.0 * std::numbers::pi;
  switch (part) {
    case LightPart::Value:
      return std::atan(x * y / (width * r)) / turn;
    case LightPart::WidthSlope:
      return -x * y * (r * r + w2) / (r * xx * yy) / turn;
    // Where the sample moves one way, the corner moves the other.
    case LightPart::SlopeX:
      return -width * y / (xx * r) / turn;
    case LightPart::SlopeY:
      break;
  }
  return -width * x / (yy * r) / turn;
}

std::vector<double> lorentzian_weights(const LorentzianKernel& kernel, LightPart part, const WeightPlane& plane) {
  const double reach = near_reach(plane, kernel.width);
  const int copies_x = plane.periodic ? copies(plane.columns, reach) : 0;
  const int copies_y = plane.periodic ? copies(plane.rows, reach) : 0;
  return weights_of([&](double x, double y) { return kernel.corner(part, x, y); }, part == LightPart::Value ? 1.0 : 0.0,
                    plane, copies_x, copies_y);
}

}  // namespace mezzotint
