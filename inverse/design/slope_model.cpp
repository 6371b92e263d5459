#include "inverse/design/slope_model.h"

#include <cmath>

#include <tbb/parallel_for.h>

#include "forward/base/error.h"

namespace mezzotint {

namespace {

const PatchOptions& checked(const PatchOptions& patch, const std::vector<std::uint64_t>& seeds) {
  require(patch.pixels >= 16 && patch.pixels <= 4096, "a patch has 16 to 4096 pixels a side");
  require(!seeds.empty(), "a search needs at least one draw of the pattern");
  return patch;
}

SlopeCovariance covariance_about_mean(const ReliefSlopes& slopes) {
  double x = 0.0, y = 0.0, xx = 0.0, yy = 0.0, xy = 0.0;
  for (std::size_t i = 0; i < slopes.x.size(); ++i) {
    const double p = slopes.x[i], q = slopes.y[i];
    x += p;
    y += q;
    xx += p * p;
    yy += q * q;
    xy += p * q;
  }
  const auto n = static_cast<double>(slopes.x.size());
  return {xx / n - x * x / (n * n), yy / n - y * y / (n * n), xy / n - x * y / (n * n)};
}

}  // namespace

SlopeModel::SlopeModel(const PrinterProfile& printer, const PatchOptions& patch, std::vector<std::uint64_t> seeds,
                       const std::optional<LobeTarget>& lobes)
    : printer_(printer),
      patch_(checked(patch, seeds)),
      seeds_(std::move(seeds)),
      process_(patch.pixels, patch.pixels, printer, {patch.subsamples, Surround::Mirror}),
      ground_rms_slope_(ground_rms_slope(printer, split_ground(printer, patch.wavelength).geometric)) {
  if (!lobes) return;
  grid_ = lobes->grid;
  for (const DirectionAngles& incidence : lobes->incidences) {
    lobes_.emplace_back(lobes->grid, lobes->material, incidence);
    // Near the mirror direction a slope moves light by 2·cosθ_i of it; a bin is 2/width wide.
    const double bins =
        std::cos(incidence.theta.radians()) * ground_rms_slope_ * static_cast<double>(lobes->grid.grid().width);
    variances_.push_back(bins * bins);
  }
}

double SlopeModel::samples() const {
  const auto side = static_cast<double>(patch_.pixels * patch_.subsamples);
  return side * side * static_cast<double>(seeds_.size());
}

ReliefSlopes SlopeModel::printed_slopes(const Pattern& pattern, std::uint64_t seed) const {
  return process_.slopes(expose(pixel_heights(draw_instance(pattern, seed), printer_, patch_.pixels), printer_).image);
}

SlopeModel::Shown SlopeModel::shown_by(const ReliefSlopes& slopes) const {
  Shown shown{covariance_about_mean(slopes), {}};
  shown.covariance.xx += ground_rms_slope_ * ground_rms_slope_;
  shown.covariance.yy += ground_rms_slope_ * ground_rms_slope_;
  for (std::size_t light = 0; light < lobes_.size(); ++light)
    shown.maps.push_back(grid_->scattered(lobes_[light].map(slopes.x, slopes.y), variances_[light]));
  return shown;
}

std::vector<SlopeModel::Shown> SlopeModel::draws(const Pattern& pattern) const {
  std::vector<Shown> draws(seeds_.size());
  tbb::parallel_for(std::size_t{0}, seeds_.size(),
                    [&](std::size_t i) { draws[i] = shown_by(printed_slopes(pattern, seeds_[i])); });
  return draws;
}

SlopeModel::Shown SlopeModel::shown(const Pattern& pattern) const { return mean_of(draws(pattern)); }

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
