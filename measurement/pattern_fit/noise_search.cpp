#include "measurement/pattern_fit/noise_search.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include <fmt/format.h>

namespace mezzotint {

namespace {

constexpr int most_octaves = 8;
constexpr double rough = 1.0;  // gain of a round that ends the first fits

// Every so manieth block, so that about `count` are left.
std::vector<std::size_t> some_of(const FitView& view, std::size_t count) {
  std::vector<std::size_t> some;
  const std::size_t stride = std::max<std::size_t>(1, view.blocks().size() / count);
  for (std::size_t i = 0; i < view.blocks().size(); i += stride) some.push_back(i);
  return some;
}

// The least and the greatest mean density of twelve rings.
std::array<double, 2> range_of_rings(const SeenSpectrum& sample) {
  constexpr std::size_t rings = 12;
  std::array<double, rings> sum{}, count{};
  double highest = 0.0;
  for (const FrequencyBlock& block : sample.blocks)
    highest = std::max(highest, std::hypot(block.x_per_um, block.y_per_um));
  for (std::size_t i = 0; i < sample.blocks.size(); ++i) {
    const double f = std::hypot(sample.blocks[i].x_per_um, sample.blocks[i].y_per_um) / highest;
    const auto ring = std::min(static_cast<std::size_t>(f * rings), rings - 1);
    sum.at(ring) += sample.blocks[i].count * sample.density_um4[i];
    count.at(ring) += sample.blocks[i].count;
  }
  std::array<double, 2> range = {std::numeric_limits<double>::infinity(), 0.0};
  for (std::size_t ring = 0; ring < rings; ++ring) {
    if (count.at(ring) == 0.0) continue;
    range[0] = std::min(range[0], sum.at(ring) / count.at(ring));
    range[1] = std::max(range[1], sum.at(ring) / count.at(ring));
  }
  return range;
}

class Starts {
public:
  explicit Starts(const SeenSpectrum& sample) : sample_(sample) {
    const auto [least, most] = range_of_rings(sample_);
    // Only what stands a thousandth high is looked at.
    floor_ = std::max(least, 1e-3 * most);
    for (std::size_t i = 0; i < sample_.blocks.size(); ++i)
      power_ += sample_.blocks[i].count * std::max(0.0, sample_.density_um4[i] - least);
  }

  // The likeliest of a table; the height is that which has the power that was seen.
  [[nodiscard]] NoiseNumbers best(const NoiseModel& model, const std::vector<NoiseNumbers>& shapes) const {
    NoiseNumbers best;
    double highest = -std::numeric_limits<double>::infinity();
    for (NoiseNumbers numbers : shapes) {
      numbers.floor = 0.0;
      numbers.log_height = 0.0;
      std::vector<double> expected = expected_density(model, numbers, sample_.blocks, sample_.grid);
      double power = 0.0;
      for (std::size_t i = 0; i < expected.size(); ++i) power += sample_.blocks[i].count * expected[i];
      if (!(power > 0.0)) continue;
      double likelihood = 0.0;
      for (std::size_t i = 0; i < expected.size(); ++i) {
        const double density = expected[i] * power_ / power + floor_;
        likelihood -= sample_.blocks[i].count * (std::log(density) + (sample_.density_um4[i] + floor_) / density);
      }
      if (likelihood <= highest) continue;
      highest = likelihood;
      best = numbers;
      best.log_height = 0.5 * std::log(power_ / power);
      best.floor = floor_;
    }
    return best;
  }

private:
  const SeenSpectrum& sample_;
  double floor_ = 0.0, power_ = 0.0;
};

std::vector<double> scales_um(const Grid& grid) {
  const ScaleBounds bounds = scale_bounds(grid);
  std::vector<double> scales;
  for (double scale = 1.1 * bounds.least_um; scale < bounds.most_um; scale *= 1.2) scales.push_back(scale);
  return scales;
}

std::vector<NoiseNumbers> noise_shapes(const Grid& grid) {
  std::vector<NoiseNumbers> shapes;
  for (const double scale : scales_um(grid)) {
    shapes.push_back({.log_scale = std::log(scale)});
    for (const double log_stretch : {0.7, 1.5, 2.3})
      for (int k = 0; k < 8; ++k) {
        const double twice = 0.25 * std::numbers::pi * k;
        shapes.push_back({.log_scale = std::log(scale),
                          .stretch_cos = log_stretch * std::cos(twice),
                          .stretch_sin = log_stretch * std::sin(twice)});
      }
  }
  return shapes;
}

std::vector<NoiseNumbers> fbm_shapes(const Grid& grid, const NoiseNumbers& noise) {
  std::vector<NoiseNumbers> shapes;
  for (const double scale : scales_um(grid))
    for (const double hurst : {0.15, 0.4, 0.65, 0.9})
      for (const double share : {0.0, 1.0}) {
        shapes.push_back({.log_scale = std::log(scale),
                          .stretch_cos = share * noise.stretch_cos,
                          .stretch_sin = share * noise.stretch_sin,
                          .hurst = hurst});
      }
  return shapes;
}

// Blocks where the pattern stands over a ten-thousandth of its highest density, or ten times over the floor.
std::vector<std::size_t> blocks_within(const NoiseFit& fit, const FitView& view) {
  const std::vector<double> expected = expected_density(fit.model, fit.numbers, view.blocks(), view.grid());
  const double highest = *std::max_element(expected.begin(), expected.end()), floor = fit.numbers.floor;
  std::vector<std::size_t> within;
  for (std::size_t i = 0; i < expected.size(); ++i) {
    if (expected[i] - floor >= std::min(1e-4 * highest, 10.0 * floor)) within.push_back(i);
  }
  return within;
}

void sort_by_likelihood(NoiseSearch& search) {
  std::ranges::sort(search.fits, [&search](const NoiseFit& a, const NoiseFit& b) {
    return penalised(a, search.seen) > penalised(b, search.seen);
  });
}

// Octave by octave, until two in a row bring nothing.
std::vector<NoiseFit> first_round(const SeenSpectrum& sample, const WantedNoise& wanted, const Progress& progress) {
  const Starts starts(sample);
  std::vector<NoiseFit> fits = {maximise({}, starts.best({}, noise_shapes(sample.grid)), sample, rough)};
  const std::vector<NoiseNumbers> shapes = fbm_shapes(sample.grid, fits.front().numbers);
  double best = wanted.noise ? penalised(fits.front(), sample) : -std::numeric_limits<double>::infinity();
  int in_vain = 0;
  for (int octaves = 2; wanted.fbm && octaves <= most_octaves && in_vain < 2; ++octaves) {
    report(progress, "fit", 0.1 * octaves, fmt::format("fbm of {} octaves", octaves));
    const NoiseModel model{.octaves = octaves};
    fits.push_back(maximise(model, starts.best(model, shapes), sample, rough));
    in_vain = penalised(fits.back(), sample) > best ? 0 : in_vain + 1;
    best = std::max(best, penalised(fits.back(), sample));
  }
  if (!wanted.noise) fits.erase(fits.begin());
  return fits;
}

void try_other_lacunarity(NoiseSearch& search) {
  NoiseModel free = search.fits.front().model;
  if (free.octaves == 1) return;
  free.free_lacunarity = true;
  NoiseFit fit = maximise(free, search.fits.front().numbers, search.seen);
  if (penalised(fit, search.seen) > penalised(search.fits.front(), search.seen))
    search.fits.insert(search.fits.begin(), std::move(fit));
}

// Twice the gain of the likelihood that stretch must bring: 1 % of patterns without it would, were they Gaussian.
constexpr double least_gain_of_stretch = 9.21;

void try_without_stretch(NoiseSearch& search) {
  const NoiseFit& best = search.fits.front();
  NoiseFit round = without_stretch(best, search.seen);
  if (2.0 * (best.log_likelihood - round.log_likelihood) < least_gain_of_stretch)
    search.fits.front() = std::move(round);
}

}  // namespace

SeenSpectrum spectrum_of(const FitView& view, const std::vector<double>& density_um4,
                         const std::vector<std::size_t>& used) {
  SeenSpectrum seen{view.grid(), {}, {}};
  for (const std::size_t i : used) {
    seen.blocks.push_back(view.blocks()[i]);
    seen.density_um4.push_back(density_um4[i]);
  }
  return seen;
}

NoiseFit without_stretch(const NoiseFit& fit, const SeenSpectrum& seen) {
  NoiseModel round = fit.model;
  round.stretched = false;
  NoiseNumbers start = fit.numbers;
  start.stretch_cos = start.stretch_sin = 0.0;
  return maximise(round, start, seen);
}

double penalised(const NoiseFit& fit, const SeenSpectrum& seen) {
  double frequencies = 0.0;
  for (const FrequencyBlock& block : seen.blocks) frequencies += block.count;
  return fit.log_likelihood - 0.5 * static_cast<double>(fit.model.size()) *
                                  std::log(std::max(2.0, FitView::independent_share * frequencies));
}

NoiseSearch search_noise(const FitView& view, const std::vector<double>& density_um4, const WantedNoise& wanted,
                         const Progress& progress) {
  NoiseSearch search{some_of(view, 2500), {}, {}};
  search.seen = spectrum_of(view, density_um4, search.used);
  search.fits = first_round(search.seen, wanted, progress);
  sort_by_likelihood(search);
  search.used = blocks_within(search.fits.front(), view);
  search.seen = spectrum_of(view, density_um4, search.used);
  if (search.fits.size() > 3) search.fits.resize(3);
  for (NoiseFit& fit : search.fits) fit = maximise(fit.model, fit.numbers, search.seen);
  sort_by_likelihood(search);
  try_other_lacunarity(search);
  try_without_stretch(search);
  return search;
}

}  // namespace mezzotint
