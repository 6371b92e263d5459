// How often the 95 % intervals of a texture fit hold the truth, how wide they are, and how often a true pattern is sent
// away: texture_fit_study noise|fbm|sinusoid|ridges|foreign [sets] [first set]

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <numbers>
#include <string>

#include "forward/base/error.h"
#include "forward/base/fft.h"
#include "forward/base/random.h"
#include "forward/pattern/pattern.h"
#include "forward/pattern/pattern_parameters.h"
#include "measurement/pattern_fit/pattern_fit.h"

using namespace mezzotint;

namespace {

struct Scene {
  Pattern pattern;
  Grid grid;
  double white_um = 0.0;
};

Length um(double value) { return Length::from_um(value); }

Grid square(double side_um) {
  const auto side = static_cast<std::size_t>(std::ceil(side_um));
  return {side, side, um(1.0), um(1.0)};
}

// 32 to 40 cells along the shorter side; every second one is stretched, and every second one seen through white noise.
Scene noise_scene(const std::array<double, 4>& a, const std::array<double, 4>& b) {
  const double scale = 6.0 + 3.0 * a[0], stretch = a[1] < 0.5 ? 1.0 : 1.2 + 2.0 * (a[1] - 0.5);
  const double height = 2.0 * std::pow(20.0, a[2]);
  return {Noise{um(scale), stretch, Angle::from_degrees(stretch > 1.0 ? 180.0 * a[3] - 90.0 : 0.0), um(height)},
          square((32.0 + 8.0 * b[0]) * scale * stretch), b[1] < 0.5 ? 0.0 : 0.05 * height * b[2]};
}

Scene fbm_scene(const std::array<double, 4>& a, const std::array<double, 4>& b) {
  const double scale = 12.0 + 4.0 * a[0], height = 2.0 * std::pow(20.0, a[2]);
  return {FractionalBrownianMotion{
              um(scale), 1.0, {}, um(height), 0.2 + 0.7 * a[1], 2.0, 2 + static_cast<int>(a[3] * 2.999)},
          square((32.0 + 2.0 * b[0]) * scale), b[1] < 0.5 ? 0.0 : 0.02 * height * b[2]};
}

// Through white noise of 1 to 5 % of the height, on 128² samples.
Scene line_scene(bool sinusoid, const std::array<double, 4>& a, const std::array<double, 4>& b) {
  const double height = 2.0 * std::pow(20.0, a[2]), white = (0.01 + 0.04 * b[0]) * height;
  if (sinusoid) {
    return {Sinusoid{um(8.0 + 16.0 * a[0]), um(8.0 + 16.0 * a[1]), Angle::from_degrees(88.0 * a[3] - 44.0), um(height)},
            square(128.0), white};
  }
  return {Ridges{um(8.0 + 16.0 * a[0]), Angle::from_degrees(178.0 * a[3] - 89.0), um(height), 0.1 + 0.8 * a[1]},
          square(128.0), white};
}

HeightField measured(const Scene& scene, std::uint64_t set) {
  const PatternInstance drawn = draw_instance(scene.pattern, set + 7000);
  HeightField field = synthesize(drawn.pattern, scene.grid, drawn.origin);
  const RandomStream random(set, RandomPurpose::Test);
  for (std::size_t i = 0; i < scene.grid.size(); ++i)
    field.heights_um()[i] += static_cast<float>(scene.white_um * random.normal4(i, 1)[0]);
  return field;
}

// A Gaussian field with the power spectral density S(f), f in cycles a sample.
template <typename Density>
HeightField gaussian_field(std::size_t side, std::uint64_t set, const Density& density) {
  RealFft2d fft(side, side);
  const RandomStream random(set, RandomPurpose::Test);
  for (std::size_t i = 0; i < side * side; ++i) fft.real()[i] = random.normal4(i, 2)[0];
  fft.forward();
  for (std::size_t ky = 0; ky < side; ++ky)
    for (std::size_t kx = 0; kx < fft.spectrum_columns(); ++kx) {
      const double y = static_cast<double>(std::min(ky, side - ky)) / static_cast<double>(side);
      fft.spectrum()[ky * fft.spectrum_columns() + kx] *=
          std::sqrt(density(std::hypot(static_cast<double>(kx) / static_cast<double>(side), y)));
    }
  fft.inverse();
  HeightField field(square(static_cast<double>(side)), Continuation::Mirrored);
  for (std::size_t i = 0; i < side * side; ++i) field.heights_um()[i] = static_cast<float>(fft.real()[i]);
  return field;
}

// What is no pattern of ours.
HeightField foreign(int kind, std::uint64_t set) {
  constexpr std::size_t side = 256;
  const auto band = [](double f) { return f > 0.03 && f < 0.08 ? 1.0 : 0.0; };
  switch (kind) {
    case 0:
      return gaussian_field(side, set, [](double f) { return std::exp(-f * f / (2.0 * 0.05 * 0.05)); });
    case 1:
      return gaussian_field(side, set, [](double f) { return std::pow(1.0 + f * f / (0.05 * 0.05), -1.5); });
    case 2:
      return gaussian_field(side, set, band);
    case 3:
      return gaussian_field(side, set, [](double) { return 1.0; });
    default:
      break;
  }
  HeightField field(square(side), Continuation::Mirrored);
  const RandomStream random(set, RandomPurpose::Test);
  for (std::size_t row = 0; row < side; ++row)  // blocks of 8 × 8 samples at random heights
    for (std::size_t column = 0; column < side; ++column)
      field.at(column, row) = static_cast<float>(random.uniform4(row / 8 * 1000 + column / 8)[0]);
  return field;
}

int study_foreign(int sets, int first) {
  const char* names[] = {"Gaussian correlation", "exponential correlation", "band of noise", "white noise", "blocks"};
  for (int kind = 0; kind < 5; ++kind) {
    int taken = 0;
    for (int set = first; set < first + sets; ++set) {
      const PatternFit fit = fit_pattern(foreign(kind, static_cast<std::uint64_t>(set)));
      if (fit.fits) ++taken;
      if (set == first) std::printf("%s: %s\n", names[kind], fit.verdict.c_str());
    }
    std::printf("%-24s taken for a pattern %d of %d\n", names[kind], taken, sets);
    std::fflush(stdout);
  }
  return 0;
}

struct Tally {
  int fitted = 0, covered = 0;
  double half_width = 0.0, widest = 0.0, square_off = 0.0;
};

}  // namespace

int main(int count, char** arguments) {
  const std::string kind = count > 1 ? arguments[1] : "noise";
  const int sets = count > 2 ? std::atoi(arguments[2]) : 20, first = count > 3 ? std::atoi(arguments[3]) : 0;
  if (kind == "foreign") return study_foreign(sets, first);
  std::map<std::string, Tally> tallies;
  std::map<std::string, int> rejected;
  int taken = 0, right_kind = 0;
  for (int set = first; set < first + sets; ++set) {
    const RandomStream random(static_cast<std::uint64_t>(set), RandomPurpose::Test);
    const auto a = random.uniform4(0), b = random.uniform4(1);
    const Scene scene = kind == "noise" ? noise_scene(a, b)
                        : kind == "fbm" ? fbm_scene(a, b)
                                        : line_scene(kind == "sinusoid", a, b);
    const PatternFit fit = fit_pattern(measured(scene, static_cast<std::uint64_t>(set)));
    if (fit.fits) ++taken;
    for (const FitTest& test : fit.tests)
      if (test.probability < 0.01 / static_cast<double>(fit.tests.size())) ++rejected[test.name];
    if (kind_name(fit.pattern) != kind) {
      std::printf("set %d: %s\n", set, fit.verdict.c_str());
      continue;
    }
    if (kind != "fbm" || get_parameter(fit.pattern, "octaves") == get_parameter(scene.pattern, "octaves")) ++right_kind;
    for (const FittedParameter& found : fit.parameters) {
      if (!found.low_95) continue;
      const double truth = get_parameter(scene.pattern, found.name);
      const bool angle = found.name == "direction_deg", ratio = angle || found.name == "hurst" || found.name == "skew";
      double off = found.quantity.value - truth;
      if (angle) off = std::remainder(off, 180.0);
      Tally& tally = tallies[found.name];
      const double half = 0.5 * (*found.high_95 - *found.low_95) / (ratio ? 1.0 : truth);
      ++tally.fitted;
      const double at = found.quantity.value - off;  // the truth, on the turn of the interval
      if (*found.low_95 <= at && at <= *found.high_95) ++tally.covered;
      tally.half_width += half;
      tally.widest = std::max(tally.widest, half);
      tally.square_off += std::pow(off / *found.quantity.standard_error, 2);
    }
  }
  std::printf("%s: %d sets, %d taken as fits, %d of the right kind (and octaves)\n", kind.c_str(), sets, taken,
              right_kind);
  for (const auto& [name, number] : rejected)
    std::printf("  %s: below its share of 1 %% in %d\n", name.c_str(), number);
  for (const auto& [name, t] : tallies)
    std::printf("  %-16s covered %3d of %3d, mean half-width %.3g, widest %.3g, RMS error / standard error %.2f\n",
                name.c_str(), t.covered, t.fitted, t.half_width / t.fitted, t.widest,
                std::sqrt(t.square_off / t.fitted));
  return 0;
}
