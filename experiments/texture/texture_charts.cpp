#include "experiments/texture/texture_charts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "experiments/report/charts.h"
#include "experiments/report/components.h"
#include "measurement/texture/bearing_curve.h"

namespace mezzotint {

namespace {

using nlohmann::json;

constexpr std::size_t histogram_bins = 96, ring_points = 160, angle_bins = 90, longest_map_side = 192;
constexpr double seen_share = 0.9998;  // of heights and slopes that a histogram shows

double normal_density(double x, double sigma) {
  return std::exp(-0.5 * x * x / (sigma * sigma)) / (sigma * std::sqrt(2.0 * std::numbers::pi));
}

/// Even bins from low to high; values beyond are counted in the whole, and not shown.
struct Bins {
  double low, high, total = 0.0;
  std::vector<double> count = std::vector<double>(histogram_bins, 0.0);

  [[nodiscard]] double width() const { return (high - low) / static_cast<double>(histogram_bins); }
  void add(double value) {
    total += 1.0;
    const double place = (value - low) / width();
    if (place >= 0.0 && place < static_cast<double>(histogram_bins)) count[static_cast<std::size_t>(place)] += 1.0;
  }
  [[nodiscard]] Histogram densities(const std::string& name) const {
    Histogram histogram{name, {}, {}};
    for (std::size_t k = 0; k <= histogram_bins; ++k) histogram.edges.push_back(low + width() * static_cast<double>(k));
    for (const double n : count) histogram.density.push_back(n / total / width());
    return histogram;
  }
  [[nodiscard]] Series normal(double middle, double sigma) const {
    Series series{.name = "normal distribution", .x = {}, .y = {}, .standard_error = {}, .target = true};
    if (!(sigma > 0.0)) return series;
    for (std::size_t k = 0; k <= 2 * histogram_bins; ++k) {
      series.x.push_back(low + 0.5 * width() * static_cast<double>(k));
      series.y.push_back(normal_density(series.x.back() - middle, sigma));
    }
    return series;
  }
};

// A flat surface has all its heights in one place; it is given some width.
Bins bins_between(double low, double high) {
  const double pad = high > low ? 0.02 * (high - low) : 0.5e-3;
  return {low - pad, high + pad};
}

/// Rings joined on a logarithmic axis, weighted by their own errors' number of frequencies: plain means of neighbours.
Series thinned(const RadialSpectrum& radial) {
  Series series{.name = "mean over all directions", .x = {}, .y = {}, .standard_error = {}, .target = false};
  const std::size_t count = radial.frequency_per_um.size();
  const double first = std::log(radial.frequency_per_um.front()), last = std::log(radial.frequency_per_um.back());
  for (std::size_t k = 0; k < count;) {
    const double step = (std::log(radial.frequency_per_um[k]) - first) / std::max(1e-12, last - first) * ring_points;
    double n = 0.0, f = 0.0, density = 0.0, square = 0.0;
    do {
      // A ring has as many frequencies as its radius.
      const double weight = radial.frequency_per_um[k];
      n += weight;
      f += weight * radial.frequency_per_um[k];
      density += weight * radial.density_um4[k];
      square += std::pow(weight * radial.standard_error_um4[k], 2);
      ++k;
    } while (k < count && (std::log(radial.frequency_per_um[k]) - first) / std::max(1e-12, last - first) * ring_points <
                              std::floor(step) + 1.0);
    series.x.push_back(f / n);
    series.y.push_back(density / n);
    series.standard_error.push_back(std::sqrt(square) / n);
  }
  return series;
}

/// The lowest and the highest of each of some hundred stretches, so that no peak is lost.
Series thinned(const std::string& name, const Profile& profile, double offset_um, bool dashed) {
  Series series{.name = name, .x = {}, .y = {}, .standard_error = {}, .target = dashed};
  constexpr std::size_t stretches = 600;
  const std::size_t count = profile.heights_um.size(), length = std::max<std::size_t>(1, count / stretches);
  const auto add = [&](std::size_t k) {
    series.x.push_back(profile.spacing.um() * static_cast<double>(k));
    series.y.push_back(profile.heights_um[k] - offset_um);
  };
  for (std::size_t begin = 0; begin < count; begin += length) {
    const std::size_t end = std::min(count, begin + length);
    std::size_t lowest = count, highest = count;
    for (std::size_t k = begin; k < end; ++k) {
      if (std::isnan(profile.heights_um[k])) continue;
      if (lowest == count || profile.heights_um[k] < profile.heights_um[lowest]) lowest = k;
      if (highest == count || profile.heights_um[k] > profile.heights_um[highest]) highest = k;
    }
    if (lowest == count) continue;
    add(std::min(lowest, highest));
    if (lowest != highest) add(std::max(lowest, highest));
  }
  return series;
}

}  // namespace

json height_histogram(const TextureFindings& found) {
  const BearingCurve curve(found.field);
  Bins bins = bins_between(curve.height_um(seen_share), curve.height_um(1.0 - seen_share));
  for (const float z : found.field.heights_um())
    if (!std::isnan(z)) bins.add(double{z});
  const double mean = curve.integral_um(0.0, 1.0);
  std::vector<Series> references;
  if (found.roughness.Sq.value > 0.0) references.push_back(bins.normal(mean, found.roughness.Sq.value));
  return slope_histogram(
      {.title = "Heights",
       .caption = fmt::format(
           "Dashed: a normal distribution of the same Sq. Skewness {:.3g} (normal: 0), kurtosis {:.3g} (normal: "
           "3).",
           found.roughness.Ssk.value, found.roughness.Sku.value),
       .span = Span::Half},
      bins.densities("heights"), references, "Height (µm)");
}

json radial_chart(const PowerSpectrum& spectrum, const std::string& remark) {
  return line_chart({.title = "Power spectral density",
                     .caption = "Areal density averaged over rings of equal frequency. " + remark,
                     .span = Span::Half},
                    {.x_title = "Spatial frequency (1/µm)", .y_title = "Density (µm⁴)", .log_x = true, .log_y = true},
                    {thinned(radial_spectrum(spectrum))});
}

json angular_chart(const PowerSpectrum& spectrum, const std::string& remark) {
  const AngularSpectrum angular = angular_spectrum(spectrum, {}, angle_bins);
  Series series{.name = "power", .x = {}, .y = {}, .standard_error = {}, .target = false};
  for (std::size_t k = 0; k <= angle_bins; ++k) {
    series.x.push_back(180.0 / angle_bins * static_cast<double>(k));
    series.y.push_back(100.0 * angular.share[k % angle_bins] / (180.0 / angle_bins));
  }
  Series even{.name = "no direction",
              .x = {0.0, 180.0},
              .y = {100.0 / 180.0, 100.0 / 180.0},
              .standard_error = {},
              .target = true};
  return line_chart({.title = "Power by direction",
                     .caption = "Of the wave vector, which is across the lay; counter-clockwise from x. " + remark,
                     .span = Span::Half},
                    {.x_title = "Direction (°)", .y_title = "Share of Sq² (% a degree)"}, {series, even});
}

// Blocks of frequencies about 0, so that it stays in the middle; what is left over at the ends is not shown.
json spectrum_map(const PowerSpectrum& spectrum) {
  const auto middle_x = static_cast<std::ptrdiff_t>(spectrum.columns / 2);
  const auto middle_y = static_cast<std::ptrdiff_t>(spectrum.rows / 2);
  const auto longest = static_cast<std::ptrdiff_t>(longest_map_side / 2);
  const auto step_of = [&](std::ptrdiff_t middle) {
    return std::max<std::ptrdiff_t>(1, (middle + longest - 1) / longest) | 1;
  };
  const std::ptrdiff_t sx = step_of(middle_x), sy = step_of(middle_y);
  const std::ptrdiff_t x = std::max<std::ptrdiff_t>(0, (middle_x - 1 - sx / 2) / sx),
                       y = std::max<std::ptrdiff_t>(0, (middle_y - 1 - sy / 2) / sy);
  const auto mean_around = [&](std::ptrdiff_t column, std::ptrdiff_t row) {
    double sum = 0.0;
    for (std::ptrdiff_t r = row - sy / 2; r <= row + sy / 2; ++r)
      for (std::ptrdiff_t c = column - sx / 2; c <= column + sx / 2; ++c)
        sum += spectrum.density_um4[static_cast<std::size_t>(r) * spectrum.columns + static_cast<std::size_t>(c)];
    return sum / static_cast<double>(sx * sy);
  };
  std::vector<double> density;
  for (std::ptrdiff_t row = -y; row <= y; ++row)
    for (std::ptrdiff_t column = -x; column <= x; ++column)
      density.push_back(mean_around(middle_x + column * sx, middle_y + row * sy));
  // Nine decades below the highest there is rounding of the float heights and little else.
  const double floor = 1e-9 * *std::ranges::max_element(density);
  PlaneMap map{.name = "S(f_x, f_y)",
               .columns = static_cast<std::size_t>(2 * x + 1),
               .rows = static_cast<std::size_t>(2 * y + 1)};
  const auto width = [](std::ptrdiff_t step, std::size_t count, Length pitch) {
    return static_cast<double>(step) / (static_cast<double>(count) * pitch.um());
  };
  map.step_x = width(sx, spectrum.columns, spectrum.pitch_x);
  map.step_y = width(sy, spectrum.rows, spectrum.pitch_y);
  for (const double value : density) map.values.push_back(static_cast<float>(std::log10(std::max(floor, value))));
  return plane_maps({.title = "Areal spectrum",
                     .caption = "log₁₀ of the density in µm⁴, by the frequency (in waves a µm), 0 in the middle.",
                     .span = Span::Half},
                    {map}, {.label = "log₁₀ S", .symbol = "log₁₀ S", .unit = "1", .step_unit = "1/um"});
}

json autocorrelation_map(const Autocorrelation& f) {
  double farthest = 0.0;
  std::vector<std::array<double, 2>> outline;
  for (const Decay& decay : decays_of(f)) {
    farthest = std::max(farthest, decay.length_um);
    outline.push_back(
        {decay.length_um * std::cos(decay.direction.radians()), decay.length_um * std::sin(decay.direction.radians())});
  }
  for (std::size_t k = 0, half = outline.size(); k < half; ++k) outline.push_back({-outline[k][0], -outline[k][1]});
  // Twice as far as it is above 0.2, if so much is known.
  const auto lags = [&](std::size_t most, Length pitch) {
    return std::clamp<std::ptrdiff_t>(static_cast<std::ptrdiff_t>(std::ceil(2.0 * farthest / pitch.um())), 4,
                                      static_cast<std::ptrdiff_t>(most));
  };
  const std::ptrdiff_t x = lags(f.lag_x, f.pitch_x), y = lags(f.lag_y, f.pitch_y);
  const std::ptrdiff_t step =
      std::max<std::ptrdiff_t>(1, 2 * std::max(x, y) / static_cast<std::ptrdiff_t>(longest_map_side));
  PlaneMap map{.name = "f_ACF",
               .step_x = f.pitch_x.um() * static_cast<double>(step),
               .step_y = f.pitch_y.um() * static_cast<double>(step),
               .outline = std::move(outline)};
  map.columns = static_cast<std::size_t>(2 * (x / step) + 1);
  map.rows = static_cast<std::size_t>(2 * (y / step) + 1);
  for (std::ptrdiff_t row = -(y / step); row <= y / step; ++row)
    for (std::ptrdiff_t column = -(x / step); column <= x / step; ++column)
      map.values.push_back(static_cast<float>(f.at(column * step, row * step)));
  return plane_maps(
      {.title = "Autocorrelation",
       .caption = "By the lag, from the middle. Sal is the shortest way from there to the line, Str that way "
                  "divided by the longest.",
       .span = Span::Half},
      {map}, {.label = "f_ACF", .symbol = "f", .unit = "1", .outline = "first falls to 0.2"});
}

std::vector<json> slope_charts(const TextureFindings& found) {
  const SlopeAxes& axes = found.normals.axes;
  const double c = std::cos(axes.rotation.radians()), s = std::sin(axes.rotation.radians());
  double mean_u = 0.0, mean_v = 0.0, count = 0.0;
  for_each_facet_slope(found.field, [&](double x, double y) {
    mean_u += c * x + s * y;
    mean_v += c * y - s * x;
    count += 1.0;
  });
  // Four and a half RMS slopes: of normal slopes 7 in a million lie beyond.
  const auto bins_of = [](double rms) { return bins_between(-4.5 * rms, 4.5 * rms); };
  Bins along_u = bins_of(axes.rms_major), along_v = bins_of(axes.rms_minor);
  for_each_facet_slope(found.field, [&](double x, double y) {
    along_u.add(c * x + s * y - mean_u / count);
    along_v.add(c * y - s * x - mean_v / count);
  });
  const auto chart = [&](const char* title, const Bins& bins, double rms, const Quantity& kurtosis, double degrees) {
    std::vector<Series> references;
    if (rms > 0.0) references.push_back(bins.normal(0.0, rms));
    return slope_histogram(
        {.title = title,
         .caption =
             fmt::format("Along {:.0f}° from x, about the mean. RMS {:.4g}, kurtosis {:.3g}. Dashed: normal, whose "
                         "lobe is Beckmann's with α = √2 · RMS = {:.4g}.",
                         degrees, rms, kurtosis.value, std::numbers::sqrt2 * rms),
         .span = Span::Third},
        bins.densities("slopes"), references, "Slope");
  };
  // Axes have no heads: from 0° up to 180°.
  const double degrees = axes.rotation.degrees() < 0.0 ? axes.rotation.degrees() + 180.0 : axes.rotation.degrees();
  return {chart("Steepest slopes", along_u, axes.rms_major, found.normals.kurtosis_major, degrees),
          chart("Gentlest slopes", along_v, axes.rms_minor, found.normals.kurtosis_minor,
                degrees < 90.0 ? degrees + 90.0 : degrees - 90.0)};
}

json profile_chart(const ProfileFindings& found) {
  std::vector<Series> lines = {thinned("profile", found.profile, 0.0, false)};
  if (found.mean) lines.push_back(thinned("mean line", *found.mean, 0.0, true));
  return line_chart({.title = "Profile",
                     .caption = found.mean ? "Roughness is what lies between the profile and its mean line."
                                           : "No lambda_c was asked for: the primary profile.",
                     .span = Span::TwoThirds},
                    {.x_title = "Way along the line (µm)", .y_title = "Height (µm)"}, lines);
}

}  // namespace mezzotint
