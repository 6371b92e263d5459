#include "inverse/design/slope_model.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include <tbb/parallel_for.h>

#include "forward/base/error.h"
#include "inverse/design/expected_covariance.h"

namespace mezzotint {

namespace {

const PatchOptions& checked(const PatchOptions& patch, const std::vector<std::uint64_t>& seeds) {
  require(patch.pixels >= 16 && patch.pixels <= 4096, "a patch has 16 to 4096 pixels a side");
  require(!seeds.empty(), "a search needs at least one draw of the pattern");
  return patch;
}

}  // namespace

SlopeModel::SlopeModel(const PrinterProfile& printer, const PatchOptions& patch, std::vector<std::uint64_t> seeds,
                       const std::optional<LobeTarget>& lobes, const SlopeModelOptions& options)
    : printer_(printer),
      patch_(checked(patch, seeds)),
      options_(options),
      seeds_(std::move(seeds)),
      process_(patch.pixels, patch.pixels, printer,
               {patch.subsamples, Surround::Mirror, options.place_x, options.place_y}),
      ground_(split_ground(printer, patch.wavelength).geometric),
      mean_ground_(options.drawn_ground ? 0.0 : ground_rms_slope(printer, ground_)) {
  if (!lobes) return;
  grid_ = lobes->grid;
  for (const DirectionAngles& incidence : lobes->incidences) {
    lobes_.emplace_back(lobes->grid, lobes->material, incidence);
    // Near the mirror direction a slope moves light by 2·cosθ_i of it; a bin is 2/width wide.
    const double bins =
        std::cos(incidence.theta.radians()) * mean_ground_ * static_cast<double>(lobes->grid.grid().width);
    variances_.push_back(bins * bins);
  }
}

double SlopeModel::samples() const {
  const auto side = static_cast<double>(patch_.pixels * patch_.subsamples);
  return side * side * static_cast<double>(seeds_.size());
}

ReliefSlopes SlopeModel::printed_slopes(const HeightField& heights, std::uint64_t seed) const {
  const GrayImage gray = expose(heights, printer_).image;
  ReliefSlopes slopes = process_.slopes(options_.levels == GrayLevels::Quantized ? quantize(gray, printer_) : gray);
  if (!options_.drawn_ground) return slopes;
  const Length pitch = printer_.pixel_pitch / static_cast<double>(patch_.subsamples);
  const std::size_t side = patch_.pixels * patch_.subsamples;
  const ReliefSlopes ground = ground_slopes(
      {side, side, pitch, pitch}, {pitch * options_.place_x, pitch * options_.place_y}, printer_, ground_, seed);
  std::ranges::transform(slopes.x, ground.x, slopes.x.begin(), std::plus<float>());
  std::ranges::transform(slopes.y, ground.y, slopes.y.begin(), std::plus<float>());
  return slopes;
}

SlopeModel::Shown SlopeModel::shown_by(const ReliefSlopes& slopes, const SlopeMoments& moments) const {
  Shown shown{moments.covariance, {}};
  shown.covariance.xx += mean_ground_ * mean_ground_;
  shown.covariance.yy += mean_ground_ * mean_ground_;
  for (std::size_t light = 0; light < lobes_.size(); ++light)
    shown.maps.push_back(grid_->scattered(lobes_[light].map(slopes.x, slopes.y), variances_[light]));
  return shown;
}

std::vector<SlopeModel::Shown> SlopeModel::draws(const Pattern& pattern) const {
  std::vector<Shown> draws(seeds_.size());
  tbb::parallel_for(std::size_t{0}, seeds_.size(), [&](std::size_t i) {
    const HeightField heights = pixel_heights(draw_instance(pattern, seeds_[i]), printer_, patch_.pixels);
    const ReliefSlopes slopes = printed_slopes(heights, seeds_[i]);
    draws[i] = shown_by(slopes, slope_moments(slopes));
  });
  return draws;
}

SlopeModel::Shown SlopeModel::shown(const Pattern& pattern) const {
  const auto before_printing =
      options_.to_expectation ? smooth_expectation(pattern, printer_.pixel_pitch) : std::nullopt;
  return before_printing ? expected(pattern, *before_printing) : mean_of(draws(pattern));
}

SlopeModel::Shown SlopeModel::expected(const Pattern& pattern, const SlopeCovariance& before_printing) const {
  std::vector<Shown> draws(seeds_.size()), unprinted(seeds_.size());
  tbb::parallel_for(std::size_t{0}, seeds_.size(), [&](std::size_t i) {
    const HeightField heights = pixel_heights(draw_instance(pattern, seeds_[i]), printer_, patch_.pixels);
    const ReliefSlopes slopes = printed_slopes(heights, seeds_[i]);
    draws[i] = shown_by(slopes, slope_moments(slopes));
    unprinted[i].covariance = point_slope_covariance(heights);
  });
  Shown mean = mean_of(draws);
  const double ground = mean_ground_ * mean_ground_;
  mean.to_all_draws = symmetric_factor(mean_of(unprinted).covariance, before_printing);
  mean.covariance =
      through(mean.to_all_draws, {mean.covariance.xx - ground, mean.covariance.yy - ground, mean.covariance.xy});
  mean.covariance.xx += ground;
  mean.covariance.yy += ground;
  return mean;
}

SlopeModel::Shown mean_of(const std::vector<SlopeModel::Shown>& draws) {
  require(!draws.empty(), "the mean of no draws");
  SlopeModel::Shown mean{{}, std::vector<DirectionMap>(draws.front().maps.size())};
  const double share = 1.0 / static_cast<double>(draws.size());
  for (const SlopeModel::Shown& draw : draws) {
    mean.covariance.xx += share * draw.covariance.xx;
    mean.covariance.yy += share * draw.covariance.yy;
    mean.covariance.xy += share * draw.covariance.xy;
    for (std::size_t light = 0; light < draw.maps.size(); ++light) {
      mean.maps[light].resize(draw.maps[light].size(), 0.0);
      for (std::size_t k = 0; k < draw.maps[light].size(); ++k) mean.maps[light][k] += share * draw.maps[light][k];
    }
  }
  return mean;
}

}  // namespace mezzotint
