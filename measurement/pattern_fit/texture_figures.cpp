#include "measurement/pattern_fit/texture_figures.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace mezzotint {

namespace {

constexpr std::size_t sectors = 8;
constexpr double least_share = 1e-4;  // of the variance, for a ring to be judged
constexpr double least_count = 24.0;  // frequencies in a ring
constexpr double ring_growth = 1.3;

struct Moments {
  double count = 0.0, sum = 0.0, square = 0.0, cube = 0.0, fourth = 0.0;

  void add(double value) {
    const double v2 = value * value;
    count += 1.0;
    sum += value;
    square += v2;
    cube += value * v2;
    fourth += v2 * v2;
  }
  [[nodiscard]] double mean_square() const { return square / count; }
  // About 0: levelled heights have no mean, and their differences next to none.
  [[nodiscard]] double skewness() const { return cube / count / std::pow(mean_square(), 1.5); }
  [[nodiscard]] double log_kurtosis() const { return std::log(fourth / count / (mean_square() * mean_square())); }
};

constexpr std::size_t parts_a_side = 4;

// Of heights (lag 0) or of differences over a lag: all, and those of each part.
struct FieldMoments {
  Moments all;
  std::array<Moments, parts_a_side * parts_a_side> parts;
};

FieldMoments moments_of(const HeightField& field, std::size_t lag_x, std::size_t lag_y) {
  FieldMoments result;
  const bool heights = lag_x == 0 && lag_y == 0;
  for (std::size_t row = 0; row + lag_y < field.rows(); ++row)
    for (std::size_t column = 0; column + lag_x < field.columns(); ++column) {
      const double value = field.at(column + lag_x, row + lag_y) - (heights ? 0.0 : double{field.at(column, row)});
      if (std::isnan(value)) continue;
      result.all.add(value);
      result.parts.at(parts_a_side * (parts_a_side * row / field.rows()) + parts_a_side * column / field.columns())
          .add(value);
    }
  return result;
}

// ln of the deviation of ln(mean square) over the parts that hold anything.
double unevenness(const FieldMoments& moments) {
  double count = 0.0, sum = 0.0, square = 0.0;
  for (const Moments& part : moments.parts) {
    if (part.count < 16.0 || !(part.square > 0.0)) continue;
    const double value = std::log(part.mean_square());
    count += 1.0;
    sum += value;
    square += value * value;
  }
  const double mean = sum / std::max(1.0, count);
  return 0.5 * std::log(std::max(1e-12, square / std::max(1.0, count) - mean * mean));
}

std::size_t lag(double cell_um, double pitch_um, std::size_t count) {
  return std::clamp<std::size_t>(static_cast<std::size_t>(std::lround(cell_um / 8.0 / pitch_um)), 1, count / 8);
}

}  // namespace

FigureTaker::FigureTaker(const FitView& view, const NoiseFit& fit, const std::vector<double>& density_um4,
                         const std::vector<std::size_t>& used)
    : view_(view), model_(fit.model), sector_(view.blocks().size(), sectors) {
  const double finest = cell_size_um(fit.numbers).along * std::exp(-fit.numbers.log_lacunarity * (model_.octaves - 1));
  lag_x_ = lag(finest, view.grid().pitch_x.um(), view.grid().columns);
  lag_y_ = lag(finest, view.grid().pitch_y.um(), view.grid().rows);
  std::vector<CellFrequency> places;
  for (const FrequencyBlock& block : view.blocks()) places.push_back(in_cells(fit.numbers, block));
  for (const std::size_t i : used) {
    const double turn = std::atan2(places[i].v, places[i].u) / std::numbers::pi + 1.0;  // opposite ones are one
    sector_[i] = static_cast<std::size_t>(std::floor((turn - std::floor(turn)) * sectors)) % sectors;
  }
  share_out_rings(places, density_um4, expected_density(model_, fit.numbers, view.blocks(), view.grid()));
}

// From the middle outwards; a ring is closed when it is wide and full enough.
void FigureTaker::share_out_rings(const std::vector<CellFrequency>& places, const std::vector<double>& density_um4,
                                  const std::vector<double>& expected) {
  std::vector<std::size_t> order(places.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  const auto radius = [&places](std::size_t i) { return std::hypot(places[i].u, places[i].v); };
  std::ranges::sort(order, [&](std::size_t a, std::size_t b) { return radius(a) < radius(b); });
  double total = 0.0;
  for (std::size_t i = 0; i < places.size(); ++i) total += view_.blocks()[i].count * density_um4[i];
  ring_.assign(places.size(), places.size());
  for (std::size_t first = 0; first < order.size();) {
    double count = 0.0, seen = 0.0, fitted = 0.0;
    std::size_t last = first;
    while (last < order.size() && (count < least_count || radius(order[last]) < ring_growth * radius(order[first]))) {
      const double n = view_.blocks()[order[last]].count;
      count += n;
      seen += n * density_um4[order[last]];
      fitted += n * expected[order[last++]];
    }
    if (std::max(seen, fitted) >= least_share * total && count >= least_count) {
      for (std::size_t i = first; i < last; ++i) ring_[order[i]] = rings_;
      ++rings_;
    }
    first = last;
  }
}

TextureFigures FigureTaker::figures(const HeightField& field, const std::vector<double>& density_um4,
                                    const NoiseNumbers& numbers) const {
  const std::vector<double> expected = expected_density(model_, numbers, view_.blocks(), view_.grid());
  std::vector<double> seen(rings_), fitted(rings_), ratio(sectors), count(sectors);
  for (std::size_t i = 0; i < expected.size(); ++i) {
    const double n = view_.blocks()[i].count, s = std::max(expected[i], 1e-300);
    if (ring_[i] < rings_) {
      seen[ring_[i]] += n * density_um4[i];
      fitted[ring_[i]] += n * s;
    }
    if (sector_[i] < sectors) {
      ratio[sector_[i]] += n * density_um4[i] / s;
      count[sector_[i]] += n;
    }
  }
  TextureFigures result;
  for (std::size_t k = 0; k < rings_; ++k) result.spectrum.push_back(std::log(seen[k] / fitted[k]));
  for (std::size_t k = 0; k < sectors; ++k) {
    if (count[k] >= least_count) result.directions.push_back(std::log(ratio[k] / count[k]));
  }
  const FieldMoments z = moments_of(field, 0, 0), x = moments_of(field, lag_x_, 0), y = moments_of(field, 0, lag_y_);
  for (const FieldMoments* moments : {&z, &x, &y}) {
    result.shape.push_back(moments->all.skewness());
    result.shape.push_back(moments->all.log_kurtosis());
  }
  result.evenness = {unevenness(z), unevenness(x), unevenness(y)};
  return result;
}

namespace {

// Σ over figures of ((value − mean)/deviation)² among the draws, of which one may be left out.
double distance(const std::vector<double>& value, const std::vector<std::vector<double>>& drawn, std::size_t without) {
  double total = 0.0;
  for (std::size_t k = 0; k < value.size(); ++k) {
    double count = 0.0, sum = 0.0, square = 0.0;
    for (std::size_t b = 0; b < drawn.size(); ++b) {
      if (b == without) continue;
      count += 1.0;
      sum += drawn[b][k];
      square += drawn[b][k] * drawn[b][k];
    }
    const double mean = sum / count;
    const double variance = std::max(1e-24, (square - count * mean * mean) / (count - 1.0));
    total += (value[k] - mean) * (value[k] - mean) / (variance * (1.0 + 1.0 / count));
  }
  return total;
}

}  // namespace

double probability_among(const std::vector<double>& seen, const std::vector<std::vector<double>>& drawn) {
  const auto n = static_cast<double>(drawn.size());
  double sum = 0.0, square = 0.0;
  for (std::size_t b = 0; b < drawn.size(); ++b) {
    const double own = distance(drawn[b], drawn, b);
    sum += own;
    square += own * own;
  }
  const double mean = sum / n, variance = std::max(1e-24, (square - n * mean * mean) / (n - 1.0));
  // Few draws may look less scattered than they are: no less is believed than what Fisher's F for as many independent
  // figures would scatter.
  const auto figures = static_cast<double>(seen.size());
  const double shape = std::min(mean * mean / variance, 0.5 * figures * (n - 6.0) / (n + figures - 4.0));
  // Wilson and Hilferty 1931: the cube root of a gamma variable is nearly normal.
  const double root = std::cbrt(distance(seen, drawn, drawn.size()) / mean);
  return 0.5 * std::erfc((root - 1.0 + 1.0 / (9.0 * shape)) * 3.0 * std::sqrt(shape) / std::numbers::sqrt2);
}

}  // namespace mezzotint
