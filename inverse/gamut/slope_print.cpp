#include "inverse/gamut/slope_print.h"

#include <algorithm>
#include <cmath>

#include <tbb/parallel_for.h>

#include "forward/base/error.h"

namespace mezzotint {

namespace {

// Second moments about the mean of slopes at points.
SlopeCovariance covariance(const ReliefSlopes& slopes) {
  double x = 0.0, y = 0.0, xx = 0.0, yy = 0.0, xy = 0.0;
  for (std::size_t i = 0; i < slopes.x.size(); ++i) {
    const double sx = static_cast<double>(slopes.x[i]), sy = static_cast<double>(slopes.y[i]);
    x += sx;
    y += sy;
    xx += sx * sx;
    yy += sy * sy;
    xy += sx * sy;
  }
  const double n = static_cast<double>(slopes.x.size());
  return {xx / n - x * x / (n * n), yy / n - y * y / (n * n), xy / n - x * y / (n * n)};
}

// Lifted to the top of what a layer reaches: there gray levels are finest, and the dark threshold is far.
HeightField lifted_heights(const PatternInstance& instance, const PrinterProfile& printer, std::size_t pixels) {
  const Grid grid{pixels, pixels, printer.pixel_pitch, printer.pixel_pitch};
  HeightField heights = synthesize(instance.pattern, grid, instance.origin);
  const Length room = reachable_height(printer) - height_of(instance.pattern);
  const auto lift_um = static_cast<float>(std::max(0.0, room.um()));
  for (float& z : heights.heights_um()) z += lift_um;
  return heights;
}

// A square without a counterpart in the heights (across ridges) stands for itself.
double per_height(double printed, double unprinted, double expected) {
  return expected > 0.0 && unprinted > 0.0 ? printed * (expected / unprinted) : printed;
}

}  // namespace

SlopePrint::SlopePrint(const PrinterProfile& printer, const SlopePatch& patch)
    : printer_(printer),
      patch_(patch),
      process_(patch.pixels, patch.pixels, printer, {patch.subsamples, Surround::Mirror}) {
  require(patch.draws >= 1 && patch.draws <= 64, "the gamut prints 1 to 64 draws of every pattern");
  require(patch.pixels >= 16, "a patch of the gamut has at least 16 pixels a side");
}

SlopePrint::Draw SlopePrint::draw(const Pattern& pattern, std::size_t index) const {
  const HeightField heights =
      lifted_heights(draw_instance(pattern, patch_.seed * 1000 + index), printer_, patch_.pixels);
  return {covariance(process_.slopes(expose(heights, printer_).image)), slope_covariance(heights)};
}

SlopeCovariance SlopePrint::raw(const Pattern& pattern, std::size_t index) const {
  return draw(pattern, index).printed;
}

PrintedSquares SlopePrint::squares(const Pattern& pattern) const {
  const AxisSquares expected = pixel_difference_slopes(pattern, printer_);
  std::vector<AxisSquares> draws(patch_.draws);
  tbb::parallel_for(std::size_t{0}, patch_.draws, [&](std::size_t i) {
    const Draw one = draw(pattern, i);
    draws[i] = {per_height(one.printed.xx, one.unprinted.xx, expected.u),
                per_height(one.printed.yy, one.unprinted.yy, expected.v)};
  });
  const double n = static_cast<double>(patch_.draws);
  PrintedSquares result;
  for (const AxisSquares& one : draws) {
    result.mean.u += one.u / n;
    result.mean.v += one.v / n;
  }
  if (patch_.draws < 2) return result;
  double spread_u = 0.0, spread_v = 0.0;
  for (const AxisSquares& one : draws) {
    spread_u += (one.u - result.mean.u) * (one.u - result.mean.u);
    spread_v += (one.v - result.mean.v) * (one.v - result.mean.v);
  }
  result.standard_error = {std::sqrt(spread_u / (n * (n - 1.0))), std::sqrt(spread_v / (n * (n - 1.0)))};
  return result;
}

}  // namespace mezzotint
