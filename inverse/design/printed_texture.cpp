#include "inverse/design/printed_texture.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <tbb/parallel_for.h>

#include "forward/base/error.h"

namespace mezzotint {

namespace {

double square(double value) { return value * value; }

Grid relief_grid(const PrinterProfile& printer, const PatchOptions& patch) {
  const Length pitch = printer.pixel_pitch / static_cast<double>(patch.subsamples);
  return {patch.pixels * patch.subsamples, patch.pixels * patch.subsamples, pitch, pitch};
}

SlopeCovariance sum_without(const std::vector<SlopeCovariance>& draws, std::size_t left_out) {
  SlopeCovariance sum;
  for (std::size_t i = 0; i < draws.size(); ++i) {
    if (i == left_out) continue;
    sum.xx += draws[i].xx;
    sum.yy += draws[i].yy;
    sum.xy += draws[i].xy;
  }
  return sum;
}

SlopeCovariance scaled(const SlopeCovariance& covariance, double factor) {
  return {covariance.xx * factor, covariance.yy * factor, covariance.xy * factor};
}

Grid pixel_grid(const PrinterProfile& printer, std::size_t pixels) {
  return {pixels, pixels, printer.pixel_pitch, printer.pixel_pitch};
}

// To the top of what one layer reaches, and by how much.
Length lift(HeightField& heights, const Pattern& pattern, const PrinterProfile& printer) {
  const Length lift = std::max(Length{}, reachable_height(printer) - height_of(pattern));
  for (float& z : heights.heights_um()) z += static_cast<float>(lift.um());
  return lift;
}

// Before anything of its size is allocated.
const PatchOptions& checked(const PatchOptions& patch) {
  require(patch.pixels >= 16 && patch.pixels <= 4096, "a patch has 16 to 4096 pixels a side");
  return patch;
}

}  // namespace

HeightField pixel_heights(const PatternInstance& instance, const PrinterProfile& printer, std::size_t pixels) {
  HeightField heights = synthesize(instance.pattern, pixel_grid(printer, pixels), instance.origin);
  lift(heights, instance.pattern, printer);
  return heights;
}

HeightDerivatives pixel_heights_with_derivatives(const PatternInstance& instance, const PrinterProfile& printer,
                                                 std::size_t pixels, std::span<const std::string> names) {
  HeightDerivatives result =
      synthesize_with_derivatives(instance.pattern, pixel_grid(printer, pixels), instance.origin, names);
  if (lift(result.heights, instance.pattern, printer) == Length{}) return result;
  // What the pattern grows by, it is lifted less.
  for (std::size_t k = 0; k < names.size(); ++k) {
    const auto less = static_cast<float>(result.of_height[k]);
    for (float& slope : result.toward[k]) slope -= less;
  }
  return result;
}

PrintedTexture::PrintedTexture(const PrinterProfile& printer, const PatchOptions& patch,
                               std::vector<std::uint64_t> seeds)
    : printer_(printer),
      patch_(checked(patch)),
      process_(patch.pixels, patch.pixels, printer, {patch.subsamples, Surround::Mirror}),
      seeds_(std::move(seeds)) {
  require(!seeds_.empty(), "a printed texture needs at least one seed");
  const auto octaves = split_ground(printer_, patch.wavelength).geometric;
  grounds_.assign(seeds_.size(), HeightField(relief_grid(printer_, patch_), Continuation::Mirrored));
  tbb::parallel_for(std::size_t{0}, seeds_.size(),
                    [&](std::size_t i) { add_ground(grounds_[i], printer_, octaves, seeds_[i]); });
}

HeightField PrintedTexture::print(const Pattern& pattern, std::size_t seed_index, GrayLevels levels) const {
  const PatternInstance instance = draw_instance(pattern, seeds_[seed_index]);
  const Exposure exposure = expose(pixel_heights(instance, printer_, patch_.pixels), printer_);
  const GrayImage gray = levels == GrayLevels::Quantized ? quantize(exposure.image, printer_) : exposure.image;
  HeightField relief = process_.print(gray);
  const auto ground = grounds_[seed_index].heights_um();
  std::ranges::transform(relief.heights_um(), ground, relief.heights_um().begin(), std::plus<float>());
  return relief;
}

std::vector<SlopeCovariance> PrintedTexture::slope_covariances(const Pattern& pattern, GrayLevels levels) const {
  std::vector<SlopeCovariance> draws(seeds_.size());
  tbb::parallel_for(std::size_t{0}, seeds_.size(),
                    [&](std::size_t i) { draws[i] = slope_covariance(print(pattern, i, levels)); });
  return draws;
}

MeanCovariance mean_of(const std::vector<SlopeCovariance>& draws) {
  require(!draws.empty(), "the mean of no draws");
  const auto n = static_cast<double>(draws.size());
  const SlopeCovariance mean = scaled(sum_without(draws, draws.size()), 1.0 / n);
  if (draws.size() == 1) {
    const double unknown = std::numeric_limits<double>::quiet_NaN();
    return {mean, {unknown, unknown, unknown}};
  }
  SlopeCovariance spread;
  for (const auto& draw : draws) {
    spread.xx += square(draw.xx - mean.xx);
    spread.yy += square(draw.yy - mean.yy);
    spread.xy += square(draw.xy - mean.xy);
  }
  const auto error = [&](double sum) { return std::sqrt(sum / (n * (n - 1.0))); };
  return {mean, {error(spread.xx), error(spread.yy), error(spread.xy)}};
}

SlopeAxesEstimate estimate_axes(const std::vector<SlopeCovariance>& draws) {
  const SlopeAxes axes = principal_axes(mean_of(draws).mean);
  if (draws.size() < 2) {
    const double unknown = std::numeric_limits<double>::quiet_NaN();
    return {axes, unknown, unknown, Angle::from_radians(unknown)};
  }
  const auto n = static_cast<double>(draws.size());
  double major = 0.0, minor = 0.0, rotation = 0.0;
  for (std::size_t i = 0; i < draws.size(); ++i) {
    const SlopeAxes without = principal_axes(scaled(sum_without(draws, i), 1.0 / (n - 1.0)));
    major += square(without.rms_major - axes.rms_major);
    minor += square(without.rms_minor - axes.rms_minor);
    rotation += square(axis_difference(without.rotation, axes.rotation).radians());
  }
  const auto error = [&](double sum) { return std::sqrt(sum * (n - 1.0) / n); };
  return {axes, error(major), error(minor), Angle::from_radians(error(rotation))};
}

}  // namespace mezzotint
