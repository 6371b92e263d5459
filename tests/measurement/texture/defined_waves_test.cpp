#include <cmath>
#include <numbers>

#include "tests/measurement/texture/sampled_surfaces.h"

// Waves with closed forms (the idea of Todhunter, Leach and Lawes 2020), each at three spacings.

namespace mezzotint::test {
namespace {

// √(1 + S² cos²) over a wave: (2/π) √(1 + S²) E(S²/(1 + S²)).
double excess_of_sine(double steepest) {
  const double square = steepest * steepest;
  return 2.0 / pi * std::sqrt(1.0 + square) * std::comp_ellint_2(std::sqrt(square / (1.0 + square))) - 1.0;
}

TEST(DefinedWaves, SineAlongX) {
  constexpr double a = 3.0, k = 2.0 * pi / side_um, s = a * k;
  expect_agreement(
      {"sine along x",
       "3 sin(2πx/64)",
       along_x([](double u) { return a * std::sin(2.0 * pi * u); }),
       64,
       {to_order("Sa", 2.0 * a / pi, 2), exact("Sq", a / std::numbers::sqrt2), exact("Sz", 2.0 * a), no_skewness,
        exact("Sku", 1.5), to_order("Sdq", s / std::numbers::sqrt2, 2), to_order("Sdr", excess_of_sine(s), 2),
        exact("Sal", std::acos(0.2) / k), exact("Std", 0.0, 180.0), exact("slope kurtosis", 1.5)}});
}

TEST(DefinedWaves, SineAskew) {
  constexpr double a = 2.0, k = 2.0 * pi * askew_waves / side_um, s = a * k;
  const Functional f = functional_of([](double p) { return a * std::cos(pi * p); }, 0.0);
  expect_agreement(
      {"sine askew", "2 sin(2π(3x + 4y)/64)", askew([](double u) { return a * std::sin(2.0 * pi * u); }), 64,
       std::vector<Known>{exact("Sa", 2.0 * a / pi), exact("Sq", a / std::numbers::sqrt2), exact("Sz", 2.0 * a),
                          no_skewness, exact("Sku", 1.5), to_order("Sdq", s / std::numbers::sqrt2, 2),
                          to_order("Sdr", excess_of_sine(s), 2), exact("Sal", std::acos(0.2) / k),
                          to_figures("Std", std::atan2(4.0, 3.0) * 180.0 / pi, 2.5, whole_degrees),
                          exact("slope kurtosis", 1.5), to_figures("Sk", f.Sk, 5, steps)} +
           volumes(f, exact_of)});
}

TEST(DefinedWaves, ProductOfSines) {
  constexpr double h = 8.0, k = 2.0 * pi / side_um;
  const double steep = h / 4.0 * std::sqrt(2.0) * k;
  // ∫∫ √(1 + (H k/2)² (c²s² + s²c²)), periodic and smooth: the trapezoid rule is exact to rounding.
  double excess = 0.0;
  constexpr int steps = 256;
  for (int i = 0; i < steps; ++i)
    for (int j = 0; j < steps; ++j) {
      const double x = 2.0 * pi * i / steps, y = 2.0 * pi * j / steps;
      const double gx = 0.5 * h * k * std::cos(x) * std::sin(y), gy = 0.5 * h * k * std::sin(x) * std::cos(y);
      excess += (std::sqrt(1.0 + gx * gx + gy * gy) - 1.0) / (steps * steps);
    }
  expect_agreement(
      {"product of sines",
       "4 sin(2πx/64) sin(2πy/64)",
       over_tile([](double u, double v) { return 0.5 * h * std::sin(2.0 * pi * u) * std::sin(2.0 * pi * v); }),
       64,
       {to_order("Sa", 2.0 * h / (pi * pi), 2), exact("Sq", h / 4.0), exact("Sz", h), no_skewness,
        exact("Sku", 9.0 / 4.0), to_order("Sdq", steep, 2), to_order("Sdr", excess, 2),
        exact("Sal", std::acos(0.2) / k),
        exact("Str", std::acos(0.2) / (std::numbers::sqrt2 * std::acos(std::sqrt(0.2))))}});
}

TEST(DefinedWaves, SumOfCosines) {
  constexpr double a = 1.5, k = 2.0 * pi / side_um;
  expect_agreement(
      {"sum of cosines",
       "1.5 (cos(2πx/64) + cos(2πy/64))",
       over_tile([](double u, double v) { return a * (std::cos(2.0 * pi * u) + std::cos(2.0 * pi * v)); }),
       64,
       {to_order("Sa", 8.0 * a / (pi * pi), 2), exact("Sq", a), exact("Sz", 4.0 * a), no_skewness,
        exact("Sku", 9.0 / 4.0), to_order("Sdq", a * k, 2),
        // (cos kx + cos ky)/2 is 0.2 first on the diagonal, at kt/√2 = acos 0.2, and last on an axis: cos kt = −0.6.
        exact("Sal", std::numbers::sqrt2 * std::acos(0.2) / k),
        exact("Str", std::numbers::sqrt2 * std::acos(0.2) / std::acos(-0.6))}});
}

double triangle(double height_um, double u) { return height_um * (std::abs(2.0 * u - 1.0) - 0.5); }

std::vector<Known> of_uniform_heights(double h) {
  const Functional f = functional_of([h](double p) { return h * (0.5 - p); }, 0.3);
  return std::vector<Known>{exact("Sa", h / 4.0), exact("Sq", h / std::sqrt(12.0)),
                            no_skewness,          exact("Sku", 9.0 / 5.0),
                            exact("Sk", h),       exact("Spk", 0.0, h),
                            exact("Svk", 0.0, h), exact("Smr1", 0.0, 1.0),
                            exact("Smr2", 1.0)} +
         volumes(f, exact_of);
}

TEST(DefinedWaves, TriangleWaveAlongX) {
  constexpr double h = 6.0, s = 2.0 * h / side_um;
  // 1 − 6 t² + 4 t³ of t = lag/(half a wave).
  const double sal = 0.5 * side_um * root([](double t) { return 0.8 - 6.0 * t * t + 4.0 * t * t * t; }, 0.0, 1.0);
  expect_agreement(
      {"triangle wave along x", "6 (|2 frac(x/64) − 1| − ½)", along_x([](double u) { return triangle(h, u); }), 64,
       std::vector<Known>{exact("Sa", h / 4.0), to_order("Sq", h / std::sqrt(12.0), 2), exact("Sz", h), no_skewness,
                          to_order("Sku", 9.0 / 5.0, 2), exact("Sdq", s), exact("Sdr", std::sqrt(1.0 + s * s) - 1.0),
                          exact("slope kurtosis", 1.0), to_order("Sal", sal, 2)}});
}

TEST(DefinedWaves, TriangleWaveAskew) {
  constexpr double h = 6.0, s = 2.0 * h * askew_waves / side_um;
  expect_agreement({"triangle wave askew", "6 (|2 frac((3x + 4y)/64) − 1| − ½)",
                    askew([](double u) { return triangle(h, u); }), 64,
                    of_uniform_heights(h) + std::vector<Known>{to_order("Sz", h, 2), to_order("Sdq", s, 1),
                                                               to_order("Sdr", std::sqrt(1.0 + s * s) - 1.0, 1),
                                                               to_order("slope kurtosis", 1.0, 1)}});
}

TEST(DefinedWaves, SawtoothAlongX) {
  constexpr double h = 4.0, s = h / side_um;
  const double sal = side_um * root([](double t) { return 0.8 - 6.0 * t * (1.0 - t); }, 0.0, 0.5);
  expect_agreement({"sawtooth along x",
                    "4 frac(x/64)",
                    along_x([](double u) { return h * u; }, 0.5),
                    64,
                    {exact("Sa", h / 4.0), to_order("Sq", h / std::sqrt(12.0), 2), no_skewness,
                     to_order("Sku", 9.0 / 5.0, 2), to_order("Sz", h, 1), to_order("Sdq", infinite, -0.5),
                     to_order("Sdr", std::sqrt(1.0 + s * s) - 1.0 + h / side_um, 1), to_order("Sal", sal, 2)}});
}

TEST(DefinedWaves, SquareWave) {
  constexpr double h = 2.0, d = 0.25, sigma = 0.4330127018922193;  // √(d (1 − d))
  expect_agreement({"square wave",
                    "2 where frac(x/64) < ¼, else 0",
                    along_x([](double u) { return u < d ? h : 0.0; }, 0.5),
                    64,
                    {exact("Sa", 2.0 * h * d * (1.0 - d)), exact("Sq", h * sigma), exact("Sz", h),
                     exact("Ssk", (1.0 - 2.0 * d) / sigma), exact("Sku", 1.0 / (d * (1.0 - d)) - 3.0),
                     to_order("Sdq", infinite, -0.5), to_order("Sdr", 2.0 * h / side_um, 1),
                     exact("Sal", 0.8 * d * (1.0 - d) * side_um), exact("Vmp", 0.0, h), exact("Vmc", d * h),
                     exact("Vvc", (1.0 - d) * h), exact("Vvv", 0.0, h), exact("Sxp", h)}});
}

TEST(DefinedWaves, GroovesInAPlateau) {
  // Half of it flat, half V grooves of depth D: heights 0, and even in [−D, 0].
  constexpr double depth = 3.0;
  const Moments m{-depth / 4.0, depth * depth / 6.0, -std::pow(depth, 3) / 8.0, std::pow(depth, 4) / 10.0};
  const auto groove = [](double u) { return u < 0.5 ? 0.0 : depth * (std::abs(4.0 * u - 3.0) - 1.0); };
  const Functional f = functional_of([](double p) { return p < 0.5 ? 0.0 : -depth * (2.0 * p - 1.0); }, 0.05, 0.5);
  const double s = 4.0 * depth * askew_waves / side_um;
  expect_agreement(
      {"V grooves in a plateau", "0, or −3 (1 − |4 frac((3x + 4y)/64) − 3|)", askew(groove), 64,
       std::vector<Known>{exact("Sa", 0.28125 * depth), exact("Sq", m.sq()), to_order("Sz", depth, 2),
                          exact("Ssk", m.ssk()), exact("Sku", m.sku()), to_order("Sdq", s / std::numbers::sqrt2, 1),
                          to_order("Sdr", 0.5 * (std::sqrt(1.0 + s * s) - 1.0), 1), exact("Sk", 0.0, depth),
                          exact("Spk", 0.0, depth), to_order("Svk", depth, 2), to_order("Smr2", 0.5, 2)} +
           volumes(f, [](const char* name, double value) {
             return name == std::string("Sxp") ? Known{name, value, 0.0, 2, "", depth} : exact(name, value, depth);
           })});
}

}  // namespace
}  // namespace mezzotint::test
