#include "measurement/correction/gaussian_filter.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include "forward/base/error.h"
#include "measurement/correction/gaussian_window.h"

namespace mezzotint {

namespace {

constexpr double reach_in_cutoffs = 1.2;

}  // namespace

GaussianWindow::GaussianWindow(std::size_t count, double cutoff_in_samples, bool periodic)
    : samples(count), reach(static_cast<std::size_t>(std::ceil(reach_in_cutoffs * cutoff_in_samples))) {
  if (!periodic) reach = std::min(reach, count);
  const double alpha = std::sqrt(std::numbers::ln2 / std::numbers::pi);
  double sum = 0.0;
  weights.resize(reach + 1);
  for (std::size_t i = 0; i <= reach; ++i) {
    const double x = static_cast<double>(i) / (alpha * cutoff_in_samples);
    weights[i] = std::exp(-std::numbers::pi * x * x);
    sum += (i == 0 ? 1.0 : 2.0) * weights[i];
  }
  for (double& weight : weights) weight /= sum;
}

std::vector<std::ptrdiff_t> places_around(std::size_t first, std::size_t tile, std::size_t samples, std::size_t reach,
                                          bool periodic) {
  const auto count = static_cast<std::ptrdiff_t>(samples);
  std::vector<std::ptrdiff_t> places(tile + 2 * reach);
  for (std::size_t k = 0; k < places.size(); ++k) {
    const std::ptrdiff_t at = static_cast<std::ptrdiff_t>(first + k) - static_cast<std::ptrdiff_t>(reach);
    if (periodic)
      places[k] = (at % count + count) % count;
    else
      places[k] = at >= 0 && at < count ? at : -1;
  }
  return places;
}

HeightField s_filter(const HeightField& field, Length cutoff) {
  require(std::isfinite(cutoff.um()) && cutoff.um() > 0.0, "a filter needs a positive cut-off wavelength");
  const Grid& grid = field.grid();
  const bool periodic = field.periodic();
  require(!periodic || (cutoff.um() <= grid.pitch_x.um() * static_cast<double>(grid.columns) &&
                        cutoff.um() <= grid.pitch_y.um() * static_cast<double>(grid.rows)),
          "the cut-off wavelength is longer than the period of the field");
  // Far beyond the field a cut-off changes nothing any more: a plane is left.
  const auto in_samples = [&](Length pitch, std::size_t count) {
    return std::min(cutoff / pitch, 100.0 * static_cast<double>(count));
  };
  const GaussianWindow x(grid.columns, in_samples(grid.pitch_x, grid.columns), periodic);
  const GaussianWindow y(grid.rows, in_samples(grid.pitch_y, grid.rows), periodic);
  return std::max(x.reach, y.reach) <= longest_direct_reach ? filter_directly(field, x, y) : filter_by_fft(field, x, y);
}

HeightField l_filter(const HeightField& field, Length cutoff) {
  HeightField result = s_filter(field, cutoff);
  const auto heights_um = field.heights_um();
  const auto smooth_um = result.heights_um();
  for (std::size_t i = 0; i < heights_um.size(); ++i) smooth_um[i] = heights_um[i] - smooth_um[i];
  return result;
}

namespace {

// Of a wave as long as the cut-off, by the weights at whole samples alone.
double passed_at_cutoff(double cutoff_in_samples) {
  const double alpha = std::sqrt(std::numbers::ln2 / std::numbers::pi);
  double passed = 1.0, sum = 1.0;
  for (int k = 1; k <= std::ceil(reach_in_cutoffs * cutoff_in_samples); ++k) {
    const double x = k / (alpha * cutoff_in_samples), weight = 2.0 * std::exp(-std::numbers::pi * x * x);
    passed += weight * std::cos(2.0 * std::numbers::pi * k / cutoff_in_samples);
    sum += weight;
  }
  return passed / sum;
}

}  // namespace

std::string filter_warning(const HeightField& field, Length cutoff) {
  const Grid& grid = field.grid();
  const double spacing = std::max(grid.pitch_x.um(), grid.pitch_y.um());
  const double side = std::min(static_cast<double>(grid.columns) * grid.pitch_x.um(),
                               static_cast<double>(grid.rows) * grid.pitch_y.um());
  if (cutoff.um() > side)
    return fmt::format(
        "the cut-off of {:.4g} um is longer than the field ({:.4g} um): waves so long are not in it, and a plane is "
        "nearly all that is smoother",
        cutoff.um(), side);
  constexpr double most = 0.55, far = 10.0;
  const double samples = cutoff.um() / spacing, passed = samples > far ? 0.5 : passed_at_cutoff(samples);
  if (passed < most) return "";
  return fmt::format(
      "the cut-off of {:.4g} um is {:.2g} spacings: {:.0f} % of a wave that long passes, where half should; a filter "
      "needs a cut-off of four spacings",
      cutoff.um(), samples, 100.0 * passed);
}

}  // namespace mezzotint
