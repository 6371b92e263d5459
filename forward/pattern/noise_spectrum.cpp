#include "forward/pattern/noise_spectrum.h"

#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

#include "forward/pattern/noise_lattice.h"

namespace mezzotint {

namespace {

constexpr double pi = std::numbers::pi;
constexpr double highest = 12.0;
constexpr double per_cell = 64.0;  // entries of the table a unit of frequency

// 4! (2/x)⁴ J₄(x), 1 at 0.
double round_window(double x) {
  if (x < 0.05) return 1.0 - x * x / 20.0;
  return 384.0 * ::jn(4, x) / (x * x * x * x);
}

// The slice of the kernel at height z is (2R)⁶ (1 − r²/R²)³ with R² = ¼ − z²; its transform over the plane.
double slice(double f, double z) {
  const double square = 0.25 - z * z;
  return 16.0 * pi * square * square * square * square * round_window(2.0 * pi * std::sqrt(square) * f);
}

// ∫ |k̂(f, f_z)|² df_z = ∫ |slice|² dz. The integrand is even in z and flat at its ends: the trapezium converges fast.
double stationary(double f) {
  constexpr int steps = 128;
  double sum = 0.5 * slice(f, 0.0) * slice(f, 0.0);
  for (int i = 1; i < steps; ++i) {
    const double value = slice(f, 0.5 * i / steps);
    sum += value * value;
  }
  return sum / steps;
}

// k̂(f, 0) by the same rule.
double whole(double f) {
  constexpr int steps = 128;
  double sum = 0.5 * slice(f, 0.0);
  for (int i = 1; i < steps; ++i) sum += slice(f, 0.5 * i / steps);
  return sum / steps;
}

struct Entry {
  double free, bound;
};

std::vector<Entry> made_table() {
  const double scale = noise_normalisation() * noise_normalisation() * static_cast<double>(CellImpulses::count);
  std::vector<Entry> table(static_cast<std::size_t>(highest * per_cell) + 3);
  // Entry 0 is that of −1: both are even.
  for (std::size_t i = 0; i < table.size(); ++i) {
    const double f = std::abs(static_cast<double>(i) - 1.0) / per_cell, all = whole(f);
    table[i] = {scale * stationary(f) / 3.0, scale * all * all / 8.0};
  }
  return table;
}

double square_sinc(double f) {
  const double x = pi * f;
  if (std::abs(x) < 1e-4) return 1.0 - x * x / 3.0;
  const double sinc = std::sin(x) / x;
  return sinc * sinc;
}

double cubic(double a, double b, double c, double d, double t) {
  return b + 0.5 * t * (c - a + t * (2.0 * a - 5.0 * b + 4.0 * c - d + t * (3.0 * (b - c) + d - a)));
}

}  // namespace

double noise_spectral_density(double f_x, double f_y) {
  static const std::vector<Entry> table = made_table();
  const double square = f_x * f_x + f_y * f_y;
  if (!(square < highest * highest)) return 0.0;
  const double place = std::sqrt(square) * per_cell;
  const auto i = static_cast<std::size_t>(place);
  const double t = place - static_cast<double>(i);
  const Entry &a = table[i], &b = table[i + 1], &c = table[i + 2], &d = table[i + 3];
  const double free = cubic(a.free, b.free, c.free, d.free, t);
  if (square > 9.0) return free;  // the rest is below 1e-6 of it
  const double bound = cubic(a.bound, b.bound, c.bound, d.bound, t);
  return free - bound * square_sinc(f_x) * square_sinc(f_y);
}

}  // namespace mezzotint
