#include "measurement/pattern_fit/noise_draws.h"

#include <algorithm>
#include <cmath>

#include <tbb/parallel_for.h>

#include "forward/base/random.h"

namespace mezzotint {

namespace {

constexpr std::size_t clean_draws = 8;
constexpr std::size_t at_once = 8;

std::uint64_t seed_of_draw(std::uint64_t seed, std::size_t draw) {
  const auto words = RandomStream(seed, RandomPurpose::TextureDraw).bits4(draw);
  return std::uint64_t{words[0]} << 32U | words[1];
}

void add_white_noise(HeightField& field, double rms_um, std::uint64_t seed) {
  const RandomStream random(seed, RandomPurpose::TextureDraw);
  const auto heights = field.heights_um();
  for (std::size_t i = 0; i < heights.size(); i += 4) {
    const auto normal = random.normal4(i);
    for (std::size_t j = i; j < std::min(i + 4, heights.size()); ++j)
      heights[j] += static_cast<float>(rms_um * normal[j - i]);
  }
}

// A draw as the view sees it.
HeightField drawn(const FitView& view, const NoiseFit& fit, double white_um4, std::uint64_t seed) {
  const Grid& grid = view.grid();
  HeightField field = synthesize(draw_instance(pattern_of(fit.model, fit.numbers), seed).pattern, grid);
  if (white_um4 > 0.0) add_white_noise(field, std::sqrt(white_um4 / (grid.pitch_x.um() * grid.pitch_y.um())), seed);
  return view.seen(field);
}

// What is left of the floor when that of clean draws is taken off, and its error.
void find_white_noise(const FitView& view, const NoiseFit& fit, const NoiseSearch& search, std::uint64_t seed,
                      NoiseDraws& result) {
  std::vector<double> floors(clean_draws);
  tbb::parallel_for(std::size_t{0}, clean_draws, [&](std::size_t i) {
    const HeightField field = drawn(view, fit, 0.0, seed_of_draw(seed, std::size_t{1} << 32U | i));
    floors[i] = step_towards(fit, spectrum_of(view, view.audible(field), search.used)).floor;
  });
  double mean = 0.0;
  for (const double floor : floors) mean += floor / clean_draws;
  result.white_um4 = std::max(0.0, fit.numbers.floor - mean);
}

}  // namespace

NoiseDraws draw_noise(const FitView& view, const NoiseFit& fit, const NoiseSearch& search, const FigureTaker& taker,
                      std::size_t draws, std::uint64_t seed, const Progress& progress) {
  NoiseDraws result;
  find_white_noise(view, fit, search, seed, result);
  result.numbers.resize(draws);
  result.figures.resize(draws);
  for (std::size_t done = 0; done < draws; done += at_once) {
    report(progress, "draws", static_cast<double>(done) / static_cast<double>(draws));
    tbb::parallel_for(done, std::min(done + at_once, draws), [&](std::size_t i) {
      const HeightField field = drawn(view, fit, result.white_um4, seed_of_draw(seed, i));
      const std::vector<double> density = view.audible(field);
      result.numbers[i] = step_towards(fit, spectrum_of(view, density, search.used));
      result.figures[i] = taker.figures(field, density, result.numbers[i]);
    });
  }
  double mean = 0.0, square = 0.0;
  for (const NoiseNumbers& numbers : result.numbers) mean += numbers.floor / static_cast<double>(draws);
  for (const NoiseNumbers& numbers : result.numbers) square += (numbers.floor - mean) * (numbers.floor - mean);
  result.white_error_um4 = std::sqrt(square / static_cast<double>(draws - 1));
  return result;
}

double probability_of_stretch(const NoiseFit& fit, const NoiseDraws& draws) {
  const auto n = static_cast<double>(draws.numbers.size());
  double c = 0.0, s = 0.0, cc = 0.0, ss = 0.0, cs = 0.0;
  for (const NoiseNumbers& drawn : draws.numbers) {
    c += drawn.stretch_cos / n;
    s += drawn.stretch_sin / n;
  }
  for (const NoiseNumbers& drawn : draws.numbers) {
    cc += (drawn.stretch_cos - c) * (drawn.stretch_cos - c) / (n - 1.0);
    ss += (drawn.stretch_sin - s) * (drawn.stretch_sin - s) / (n - 1.0);
    cs += (drawn.stretch_cos - c) * (drawn.stretch_sin - s) / (n - 1.0);
  }
  const double a = fit.numbers.stretch_cos, b = fit.numbers.stretch_sin;
  const double square = (a * a * ss - 2.0 * a * b * cs + b * b * cc) / (cc * ss - cs * cs) / (1.0 + 1.0 / n);
  // T² (n − 2)/(2 (n − 1)) is F with 2 and n − 2 degrees of freedom, whose tail is closed.
  return std::pow(1.0 + square / (n - 1.0), -0.5 * (n - 2.0));
}

}  // namespace mezzotint
