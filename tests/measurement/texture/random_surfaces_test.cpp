#include <array>
#include <cmath>
#include <numbers>
#include <numeric>

#include "forward/base/fft.h"
#include "measurement/texture/autocorrelation.h"
#include "measurement/texture/power_spectrum.h"
#include "tests/measurement/texture/sampled_surfaces.h"

// Gaussian random surfaces of a known spectrum: expected values, and whether standard errors are what draws scatter by.

namespace mezzotint::test {
namespace {

constexpr std::size_t side = 128;
constexpr double tau = 5.0;  // µm, samples of 1 µm: f_ACF = exp(−r²/τ²)
constexpr int draws = 48;
constexpr double area = side * side;

/// A periodic Gaussian surface of standard deviation 1 µm and autocorrelation exp(−r²/τ²): white noise, whose every
/// frequency is multiplied by the root of the spectrum π τ² exp(−π² τ² f²).
HeightField gaussian_surface(std::uint64_t seed) {
  RealFft2d fft(side, side);
  const HeightField noise = white_noise(micrometre_grid(side, side), seed);
  std::ranges::copy(noise.heights_um(), fft.real().begin());
  fft.forward();
  for (std::size_t ky = 0; ky < side; ++ky)
    for (std::size_t kx = 0; kx < fft.spectrum_columns(); ++kx) {
      const double fx = static_cast<double>(kx) / side, fy = static_cast<double>(std::min(ky, side - ky)) / side;
      fft.spectrum()[ky * fft.spectrum_columns() + kx] *=
          std::sqrt(pi) * tau * std::exp(-0.5 * pi * pi * tau * tau * (fx * fx + fy * fy));
    }
  fft.inverse();
  HeightField field(micrometre_grid(side, side), Continuation::Periodic);
  for (std::size_t i = 0; i < field.grid().size(); ++i) field.heights_um()[i] = static_cast<float>(fft.real()[i]);
  return field;
}

/// A parameter over independent draws, and the errors that were stated for it.
struct Draws {
  std::vector<double> values;
  double stated_variance = 0.0;

  void add(const Quantity& q) {
    values.push_back(q.value);
    stated_variance += std::pow(*q.standard_error, 2) / draws;
  }
  void add(double value) { values.push_back(value); }
  [[nodiscard]] double mean() const {
    return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
  }
  [[nodiscard]] double variance() const {
    double sum = 0.0;
    for (const double value : values) sum += std::pow(value - mean(), 2);
    return sum / static_cast<double>(values.size() - 1);
  }
  [[nodiscard]] double error_of_mean() const { return std::sqrt(variance() / static_cast<double>(values.size())); }
};

void record(const char* name, const Draws& found, std::optional<double> expected, const char* why = "") {
  nlohmann::ordered_json row = {
      {"draws", draws}, {"parameter", name}, {"found", found.mean()}, {"error", found.error_of_mean()}, {"why", why}};
  if (expected) row["expected"] = *expected;
  if (found.stated_variance > 0.0) row["stated"] = std::sqrt(found.stated_variance / found.variance());
  detail::append_row(row);
}

void expect_mean(const char* name, const Draws& found, double expected) {
  record(name, found, expected);
  // The seeds are fixed; with others, ten such comparisons would fail once in 1600 runs.
  EXPECT_NEAR(found.mean(), expected, 4.0 * found.error_of_mean()) << name;
}

// An estimator that is known to be off by chance: by no more than that.
void expect_bias(const char* name, const Draws& found, double expected, double low, double high, const char* why) {
  record(name, found, expected, why);
  EXPECT_GT(found.mean() / expected, low) << name;
  EXPECT_LT(found.mean() / expected, high) << name;
}

// The stated error against the scatter of the draws: a variance of 48 draws is known to 20 %, an error to 10 %; four of
// these. Blocks that know of their neighbours state a little too little.
void expect_honest(const char* name, const Draws& found, double least = 0.6, double most = 1.4) {
  const double ratio = std::sqrt(found.stated_variance / found.variance());
  EXPECT_GT(ratio, least) << name;
  EXPECT_LT(ratio, most) << name;
}

constexpr double mean_variance = pi * tau * tau / area;  // of the mean height of a patch
const double step_correlation = std::exp(-1.0 / (tau * tau));
const double chord_variance = 2.0 * (1.0 - step_correlation);  // of facet slopes along an axis

TEST(RandomSurfaces, HaveTheHeightsOfTheirSpectrum) {
  Draws variance, sq, sa, ssk, fourth, sku, sk, vmp, sxp, sal, correlation;
  for (std::uint64_t i = 0; i < draws; ++i) {
    const HeightField field = gaussian_surface(4000 + i);
    const AreaRoughness r = area_roughness(field);
    const FunctionalParameters f = functional_parameters(field);
    const double s = r.Sq.value;
    sq.add(r.Sq);
    sa.add(r.Sa);
    ssk.add(r.Ssk);
    sku.add(r.Sku);
    sk.add(f.Sk);
    vmp.add(f.Vmp);
    sxp.add(f.Sxp);
    sal.add(spatial_parameters(field).Sal);
    variance.add(s * s);
    fourth.add(r.Sku.value * std::pow(s, 4));
    correlation.add(autocorrelation(field).at(4, 3) * s * s);
  }
  // Heights are about the mean of the patch, so that their variance is smaller by that of the mean.
  const double left = 1.0 - mean_variance;
  expect_mean("Sq²", variance, left);
  expect_mean("Sa", sa, std::sqrt(2.0 / pi * left));
  expect_mean("Ssk", ssk, 0.0);
  expect_mean("Sku Sq⁴", fourth, 3.0 * left * left);
  expect_mean("f_ACF(4, 3) Sq²", correlation, std::exp(-25.0 / (tau * tau)) - mean_variance);
  expect_bias("Sk", sk, 2.57398, 0.96, 1.04, "the flattest of many noisy stretches");
  expect_bias("Vmp", vmp, 0.0473432, 0.97, 1.03, "not linear in the heights' shares");
  expect_bias("Sxp", sxp, 1.95996, 0.97, 1.03, "not linear in the heights' shares");
  expect_bias("Sal", sal, tau * std::sqrt(std::log(5.0)), 0.85, 1.0, "the shortest of many noisy directions");
  expect_honest("Sq", sq);
  expect_honest("Sa", sa);
  expect_honest("Ssk", ssk);
  expect_honest("Sku", sku);
  expect_honest("Sk", sk);
  expect_honest("Vmp", vmp);
  expect_honest("Sxp", sxp);
  expect_honest("Sal", sal, 0.5, 1.6);
}

// The share of facets, with Gaussian slopes, whose normal lies in a bin: over 8 × 8 places of it.
double share_of(const DirectionGrid& grid, std::size_t bin, double variance, double covariance) {
  const double determinant = variance * variance - covariance * covariance, fine = 8.0;
  const double width = 2.0 / static_cast<double>(grid.width), height = 2.0 / static_cast<double>(grid.height);
  double sum = 0.0;
  for (double i = 0.5; i < fine; ++i)
    for (double j = 0.5; j < fine; ++j) {
      const double x = (static_cast<double>(bin % grid.width) + i / fine) * width - 1.0;
      const double y = (static_cast<double>(bin / grid.width) + j / fine) * height - 1.0, z2 = 1.0 - x * x - y * y;
      if (z2 <= 0.0) continue;
      const double power = (variance * (x * x + y * y) - 2.0 * covariance * x * y) / z2 / determinant;
      sum += std::exp(-0.5 * power) / (z2 * z2) / (2.0 * pi * std::sqrt(determinant));
    }
  return sum * width * height / (fine * fine);
}

TEST(RandomSurfaces, HaveTheSlopesOfTheirSpectrum) {
  Draws square, sdq, sdr, kurtosis;
  const DirectionGrid grid{32, 32};
  const std::vector<double> areas = projected_solid_angles(grid);
  std::vector<Draws> bins(grid.size());
  for (std::uint64_t i = 0; i < draws; ++i) {
    const HeightField field = gaussian_surface(4000 + i);
    const AreaRoughness r = area_roughness(field);
    const NormalDistribution d = normal_distribution(field, grid);
    sdq.add(r.Sdq);
    sdr.add(r.Sdr);
    square.add(r.Sdq.value * r.Sdq.value);
    kurtosis.add(d.kurtosis_major);
    for (std::size_t k = 0; k < grid.size(); ++k) bins[k].add(d.distribution[k] * areas[k]);
  }
  // The chords of the facets: E (z(x + 1) − z(x))² = 2 (1 − ρ(1)) along each axis.
  expect_mean("Sdq²", square, 2.0 * chord_variance);
  // E √(1 + r²) − 1 over Gaussian slopes of that variance.
  const double sigma = std::sqrt(chord_variance), t = 1.0 / (std::numbers::sqrt2 * sigma);
  expect_mean("Sdr", sdr, std::sqrt(pi / 2.0) * sigma * std::exp(t * t) * std::erfc(t));
  expect_bias("slope kurtosis", kurtosis, 3.0, 0.97, 1.03, "along the steeper of two nearly equal axes");
  expect_honest("Sdq", sdq);
  expect_honest("Sdr", sdr);
  expect_honest("slope kurtosis", kurtosis);
  // Both edges of a facet share a corner, so that its two slopes are a little correlated.
  double chi = 0.0, counted = 0.0;
  for (std::size_t k = 0; k < grid.size(); ++k) {
    const double expected = share_of(grid, k, chord_variance, -std::pow(1.0 - step_correlation, 2));
    if (expected < 1e-3) continue;  // 33 facets a draw and more
    chi += std::pow((bins[k].mean() - expected) / bins[k].error_of_mean(), 2);
    counted += 1.0;
  }
  EXPECT_GT(counted, 50.0);
  // A t distribution of 47 degrees of freedom has a mean square of 47/45. Bins of a draw are correlated by its
  // variance: they count as a fifth of their number perhaps, ± √(2/(counted/5)), three of these.
  EXPECT_NEAR(chi / counted, 47.0 / 45.0, 3.0 * std::sqrt(10.0 / counted));
}

TEST(RandomSurfaces, HaveTheirSpectrum) {
  PowerSpectrum expected = power_spectrum(gaussian_surface(1));
  for (std::size_t row = 0; row < side; ++row)
    for (std::size_t column = 0; column < side; ++column) {
      const double f = std::hypot(expected.frequency_x_per_um(column), expected.frequency_y_per_um(row));
      expected.density_um4[row * side + column] = pi * tau * tau * std::exp(-std::pow(pi * tau * f, 2));
    }
  const RadialSpectrum rings = radial_spectrum(expected);
  std::vector<Draws> found(rings.density_um4.size());
  for (std::uint64_t i = 0; i < draws; ++i) {
    const RadialSpectrum radial = radial_spectrum(power_spectrum(gaussian_surface(4000 + i)));
    for (std::size_t k = 0; k < found.size(); ++k)
      found[k].add({radial.density_um4[k], "µm⁴", radial.standard_error_um4[k]});
  }
  // Up to where float heights of 1 µm leave the spectrum unharmed (1e-14 µm⁴).
  double chi = 0.0, honest = 0.0, counted = 0.0;
  for (std::size_t k = 2; k < found.size() && rings.density_um4[k] > 1e-9; ++k) {
    chi += std::pow((found[k].mean() - rings.density_um4[k]) / found[k].error_of_mean(), 2);
    honest += found[k].stated_variance / found[k].variance();
    counted += 1.0;
  }
  EXPECT_GT(counted, 25.0);
  EXPECT_NEAR(chi / counted, 47.0 / 45.0, 4.0 * std::sqrt(2.0 / counted));
  // Within a ring the density falls, which counts as scatter: the stated error is the larger one.
  EXPECT_GT(honest / counted, 0.9);
  EXPECT_LT(honest / counted, 1.6);
}

}  // namespace
}  // namespace mezzotint::test
