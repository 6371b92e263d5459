#include <cmath>
#include <numbers>

#include "measurement/correction/plane.h"
#include "tests/measurement/texture/sampled_surfaces.h"

// Bodies, planes, given distributions of heights and patches with closed forms, each at three spacings.

namespace mezzotint::test {
namespace {

const char* const ties = "aligned with the samples, heights come in rows: the curve is a staircase of n/2 steps";
const char* const half_cells = "n samples of a patch have n − 1 cells: half a cell at each end has no slope";
const char* const ends = "the ends of the patch: the error falls with its length";

/// Bodies that cover a share of the tile, with E zⁿ of the bodies alone.
Moments moments_of(double share, const std::function<double(int)>& power) {
  return {share * power(1), share * power(2), share * power(3), share * power(4)};
}

std::vector<Known> heights_of(const Moments& m, double figures, const std::string& why) {
  return {to_figures("Sq", m.sq(), figures, why), to_figures("Ssk", m.ssk(), figures, why),
          to_figures("Sku", m.sku(), figures, why)};
}

constexpr double radius = 0.4;  // of the tile's side
constexpr double cover = pi * radius * radius;
constexpr double radius_um = radius * side_um;

TEST(DefinedBodies, Paraboloids) {
  constexpr double h = 10.0, a = 2.0 * h / radius_um;  // steepest slope, at the rim
  const Moments m = moments_of(cover, [](int n) { return std::pow(h, n) / (n + 1); });
  const Functional f = functional_of([](double p) { return h * std::max(0.0, 1.0 - p / cover); }, 0.55, cover);
  expect_agreement(
      {"paraboloids", "10 (1 − r²/25.6²)",
       over_tile([](double u, double v) { return h * std::max(0.0, 1.0 - (u * u + v * v) / (radius * radius)); }, 0.13,
                 0.29),
       64,
       heights_of(m, 5, rim) +
           std::vector<Known>{
               to_order("Sz", h, 2), to_figures("Sdq", a * std::sqrt(0.5 * cover), 2, rim),
               to_figures("Sdr", cover * ((std::pow(1.0 + a * a, 1.5) - 1.0) / (1.5 * a * a) - 1.0), 2, rim)} +
           volumes(f, figures_of_each(3.5, rim))});
}

TEST(DefinedBodies, SphereCaps) {
  // Of a sphere of radius ρ, as high as h over a circle of radius_um.
  constexpr double h = 8.0, rho = (radius_um * radius_um + h * h) / (2.0 * h);
  const auto power = [](int n) {
    return integral([n](double z) { return n * std::pow(z, n - 1) * (rho * rho - std::pow(z + rho - h, 2)); }, 0.0, h) /
           (radius_um * radius_um);
  };
  const double ratio = rho * rho / (radius_um * radius_um);
  const double mean_square = cover * (ratio * std::log(ratio / (ratio - 1.0)) - 1.0);
  expect_agreement(
      {"sphere caps", "√(ρ² − r²) − ρ + 8, ρ = 44.96",
       over_tile(
           [](double u, double v) {
             const double square = side_um * side_um * (u * u + v * v);
             return std::max(0.0, std::sqrt(std::max(0.0, rho * rho - square)) - rho + h);
           },
           0.13, 0.29),
       64,
       heights_of(moments_of(cover, power), 5, rim) +
           std::vector<Known>{to_order("Sz", h, 2), to_figures("Sdq", std::sqrt(mean_square), 2, rim),
                              to_figures("Sdr", cover * (2.0 * rho * h / (radius_um * radius_um) - 1.0), 2, rim)}});
}

TEST(DefinedBodies, Cones) {
  constexpr double h = 10.0, s = h / radius_um;
  const Moments m = moments_of(cover, [](int n) { return 2.0 * std::pow(h, n) / ((n + 1) * (n + 2)); });
  expect_agreement(
      {"cones", "10 (1 − r/25.6)",
       over_tile([](double u, double v) { return h * std::max(0.0, 1.0 - std::hypot(u, v) / radius); }, 0.13, 0.29), 64,
       heights_of(m, 5, rim) +
           std::vector<Known>{to_order("Sz", h, 1), to_figures("Sdq", s * std::sqrt(cover), 2.5, rim),
                              to_figures("Sdr", cover * (std::sqrt(1.0 + s * s) - 1.0), 2.5, rim)}});
}

TEST(DefinedBodies, EllipsoidDimples) {
  // Half-axes 25.6 and 19.2 µm, upright at the rim: the slope has no mean square.
  constexpr double depth = 5.0, share = 0.75 * cover;
  const Moments m = moments_of(share, [](int n) { return std::pow(-depth, n) * 2.0 / (n + 2); });
  expect_agreement({"ellipsoid dimples", "−5 √(1 − x²/25.6² − y²/19.2²)",
                    over_tile(
                        [](double u, double v) {
                          const double q = (u * u + v * v / 0.5625) / (radius * radius);
                          return -depth * std::sqrt(std::max(0.0, 1.0 - q));
                        },
                        0.13, 0.29),
                    64, heights_of(m, 5, rim) + std::vector<Known>{to_order("Sz", depth, 2)}});
}

TEST(DefinedBodies, Pyramids) {
  constexpr double h = 12.0, s = 2.0 * h / side_um;
  const Moments m = moments_of(1.0, [](int n) { return 2.0 * std::pow(h, n) / ((n + 1) * (n + 2)); });
  const Functional f = functional_of([](double p) { return h * (1.0 - std::sqrt(p)); }, 0.6);
  const auto roughly = [](const char* name, double value) {
    return to_figures(name, value, 1.0, ties, value == 0.0 ? h : 0.0);
  };
  expect_agreement({"pyramids", "12 (1 − max(|x|, |y|)/32)",
                    over_tile([](double u, double v) { return h * (1.0 - 2.0 * std::max(std::abs(u), std::abs(v))); }),
                    64,
                    std::vector<Known>{to_order("Sa", h * 16.0 / 81.0, 2), to_order("Sq", m.sq(), 2),
                                       to_order("Ssk", m.ssk(), 2), to_order("Sku", m.sku(), 2), exact("Sz", h),
                                       exact("Sdq", s), to_order("Sdr", std::sqrt(1.0 + s * s) - 1.0, 1)} +
                        volumes(f, roughly) + line_parameters(f, roughly)});
}

TEST(DefinedBodies, PlaneAndWhatLevellingLeaves) {
  const auto raw = [](std::size_t n) {
    const double pitch_um = side_um / static_cast<double>(n);
    const Length pitch = Length::from_um(pitch_um);
    const HeightField field =
        field_of(Grid{n, n, pitch, pitch}, [&](double c, double r) { return pitch_um * (0.5 * c - 0.25 * r); });
    Parameters p = parameters_of(field);
    const AreaRoughness levelled = area_roughness(level(field));
    p["Sq levelled"] = levelled.Sq.value;
    p["Sdr levelled"] = levelled.Sdr.value;
    return p;
  };
  // Heights x/2 − y/4 over the square: Var = (0.25 + 0.0625) L²/12.
  expect_agreement(
      {"tilted plane",
       "x/2 − y/4",
       raw,
       32,
       {to_order("Sq", side_um * std::sqrt(0.3125 / 12.0), 2), exact("Sdq", std::sqrt(0.3125)),
        exact("Sdr", std::sqrt(1.3125) - 1.0), exact("Sq levelled", 0.0, side_um), exact("Sdr levelled", 0.0, 1.0)}});
}

// Heights whose shares are exactly those of a distribution, in no order.
std::function<Parameters(std::size_t)> shuffled(const Curve& z) {
  return [=](std::size_t n) {
    HeightField field(micrometre_grid(n, n), Continuation::Mirrored);
    const std::size_t count = n * n;
    for (std::size_t k = 0; k < count; ++k)
      field.heights_um()[k * 7919 % count] =
          static_cast<float>(z((static_cast<double>(k) + 0.5) / static_cast<double>(count)));
    return parameters_of(field);
  };
}

TEST(DefinedBodies, ExponentialHeights) {
  const Curve z = [](double p) { return -std::log(p); };
  const Functional f = functional_of(z, 0.6);
  expect_agreement(
      {"exponential heights", "shares e^−z, in no order", shuffled(z), 64,
       std::vector<Known>{to_figures("Sa", 2.0 / std::numbers::e, 4.5, tail), to_figures("Sq", 1.0, 4, tail),
                          to_figures("Ssk", 2.0, 2.5, tail), to_figures("Sku", 9.0, 2, tail)} +
           volumes(f, figures_of_each(4, tail)) + line_parameters(f, figures_of_each(4, tail))});
}

TEST(DefinedBodies, GaussianHeights) {
  const Curve z = [](double above) {
    return root([above](double x) { return 0.5 * std::erfc(x / std::numbers::sqrt2) - above; }, -40.0, 40.0);
  };
  const Functional f = functional_of(z, 0.3);
  expect_agreement({"Gaussian heights", "shares of the normal distribution, in no order", shuffled(z), 64,
                    std::vector<Known>{to_figures("Sa", std::sqrt(2.0 / pi), 5, tail), to_figures("Sq", 1.0, 4.5, tail),
                                       no_skewness, to_figures("Sku", 3.0, 3, tail)} +
                        volumes(f, figures_of_each(4, tail)) + line_parameters(f, figures_of_each(4, tail))});
}

TEST(DefinedBodies, Chirp) {
  // From 2 to 8 waves over a patch, a whole number of turns in all: the phase is 2π (2u + 3u²).
  constexpr double a = 1.5;
  const auto slope = [](double u) {
    return a * std::cos(2.0 * pi * (2.0 * u + 3.0 * u * u)) * 2.0 * pi * (2.0 + 6.0 * u) / side_um;
  };
  const auto mean = [](const auto& f) {
    double sum = 0.0;  // Gauss by pieces would do as well; 64 pieces of tanh-sinh are far beyond what is needed
    for (int k = 0; k < 16; ++k) sum += integral(f, k / 16.0, (k + 1) / 16.0);
    return sum;
  };
  const auto z = [](double u) { return a * std::sin(2.0 * pi * (2.0 * u + 3.0 * u * u)); };
  const double first = mean(z), second = mean([&](double u) { return z(u) * z(u); });
  const auto patch = [=](std::size_t n) {
    // Samples in the middles of their cells, so that they are a midpoint rule.
    const Grid grid{n, 16, Length::from_um(side_um / static_cast<double>(n)), Length::from_um(1.0)};
    return parameters_of(field_of(grid, [&](double c, double) { return z((c + 0.5) / static_cast<double>(n)); }));
  };
  expect_agreement(
      {"chirp",
       "1.5 sin(2π(2u + 3u²)), u = x/64",
       patch,
       128,
       {to_order("Sq", std::sqrt(second - first * first), 2),
        to_figures("Sdq", std::sqrt(mean([&](double u) { return slope(u) * slope(u); })), 2.5, half_cells),
        to_figures("Sdr", mean([&](double u) { return std::hypot(1.0, slope(u)) - 1.0; }), 2.5, half_cells)}});
}

TEST(DefinedBodies, TruncatedSine) {
  // 2.3 waves on a patch: what a sum over whole waves does not know.
  constexpr double a = 2.0, waves = 2.3, k = 2.0 * pi * waves;
  const double mean = a * (1.0 - std::cos(k)) / k, square = a * a * (0.5 - std::sin(2.0 * k) / (4.0 * k));
  const double slopes = std::pow(a * k / side_um, 2) * (0.5 + std::sin(2.0 * k) / (4.0 * k));
  const auto patch = [=](std::size_t n) {
    const Grid grid{n, 16, Length::from_um(side_um / static_cast<double>(n)), Length::from_um(1.0)};
    return parameters_of(
        field_of(grid, [&](double c, double) { return a * std::sin(k * (c + 0.5) / static_cast<double>(n)); }));
  };
  expect_agreement(
      {"sine cut off",
       "2 sin(2π · 2.3 x/64), 0 < x < 64",
       patch,
       64,
       {to_order("Sq", std::sqrt(square - mean * mean), 2), to_figures("Sdq", std::sqrt(slopes), 3, half_cells)}});
}

TEST(DefinedBodies, IncommensurateSines) {
  // Two waves whose ratio is the golden one never meet again: variances add, on a patch up to its ends.
  constexpr double golden = 1.618033988749895;
  const auto patch = [](std::size_t n) {
    const Grid grid = micrometre_grid(n, 16);
    return parameters_of(field_of(grid, [&](double c, double) {
      return std::sin(2.0 * pi * (c + 0.5) / 16.0) + 0.5 * std::sin(2.0 * pi * golden * (c + 0.5) / 16.0);
    }));
  };
  expect_agreement({"incommensurate sines",
                    "sin(2πx/16) + ½ sin(2π · 1.618… x/16), longer and longer",
                    patch,
                    1024,
                    {to_figures("Sq", std::sqrt(0.625), 3, ends),
                     to_figures("Sku", (3.0 / 8.0 * (1.0 + 0.0625) + 6.0 * 0.25 * 0.25) / 0.390625, 4, ends)}});
}

}  // namespace
}  // namespace mezzotint::test
