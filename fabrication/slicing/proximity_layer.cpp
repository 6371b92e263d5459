#include "fabrication/slicing/proximity_layer.h"

#include <algorithm>
#include <cmath>

#include "forward/base/error.h"

namespace mezzotint {

namespace {

// Two samples a pixel and axis see its mean well enough under a blur; small tiles leave out what is uniform.
constexpr std::size_t samples = 2;
constexpr CorrectionOptions correction{.steps = 20, .tile_pixels = 64};

}  // namespace

ProximityFigures& ProximityFigures::operator+=(const ProximityFigures& other) {
  squares_before += other.squares_before;
  squares_after += other.squares_after;
  edge_pixels += other.edge_pixels;
  needs_more_light += other.needs_more_light;
  too_much_light += other.too_much_light;
  finer_than_blur += other.finer_than_blur;
  return *this;
}

ProximityLayer correct_layer(const std::vector<float>& coverage, const PixelWindow& window,
                             const PrinterProfile& profile, Length layer) {
  require(coverage.size() == window.columns * window.rows, "one coverage a pixel of the window is needed");
  require(profile.gray_levels <= 256, "a job holds 8 bits: at most 256 gray levels");
  PrinterProfile printer = profile;
  printer.layer = layer;
  HeightField wanted({window.columns, window.rows, printer.pixel_pitch, printer.pixel_pitch}, Continuation::Mirrored);
  ProximityLayer result;
  for (std::size_t i = 0; i < coverage.size(); ++i) {
    wanted.heights_um()[i] = static_cast<float>(static_cast<double>(coverage[i]) * layer.um());
    if (coverage[i] > 0.0F && coverage[i] < 1.0F) ++result.figures.edge_pixels;
  }
  const ProximityCorrection corrected =
      correct_proximity(wanted, printer, {.subsamples = samples, .surround = Surround::Dark}, correction);
  const auto pixels = static_cast<double>(coverage.size());
  result.figures.squares_before = pixels * std::pow(corrected.error_before.um(), 2.0);
  result.figures.squares_after = pixels * std::pow(corrected.error_after.um(), 2.0);
  const auto counts = corrected.counts();
  result.figures.needs_more_light = counts[1];
  result.figures.too_much_light = counts[2];
  result.figures.finer_than_blur = counts[3];
  result.levels.reserve(coverage.size());
  for (const float gray : corrected.image.values)
    result.levels.push_back(static_cast<std::uint8_t>(std::lround(255.0F * gray)));
  return result;
}

}  // namespace mezzotint
