#include "forward/scattering/bin_interval.h"

#include <algorithm>
#include <cmath>

namespace mezzotint {

namespace {

constexpr double tail = 0.025;

// P(a, x), regularised: by its series, or by the continued fraction of what is missing to 1 (Lentz's method).
double lower_gamma(double a, double x) {
  const double front = std::exp(a * std::log(x) - x - std::lgamma(a));
  if (x < a + 1.0) {
    double term = 1.0 / a, sum = term;
    for (int k = 1; term > 1e-16 * sum; ++k) sum += term *= x / (a + k);
    return front * sum;
  }
  constexpr double tiny = 1e-300;
  double b = x + 1.0 - a, c = 1.0 / tiny, d = 1.0 / b, fraction = d;
  for (int k = 1; k < 10000; ++k) {
    const double an = -k * (k - a);
    b += 2.0;
    d = 1.0 / std::max(tiny, an * d + b);
    c = std::max(tiny, b + an / c);
    fraction *= c * d;
    if (std::abs(c * d - 1.0) < 1e-15) break;
  }
  return 1.0 - front * fraction;
}

Interval garwood(double hits) {
  if (!(hits > 0.0)) return {0.0, -std::log(tail)};  // most bins of most maps: in closed form
  return {0.5 * chi_square_quantile(tail, 2.0 * hits), 0.5 * chi_square_quantile(1.0 - tail, 2.0 * (hits + 1.0))};
}

}  // namespace

double BinHits::effective() const {
  const double all = sum + 2.0 * negative;
  return squares > 0.0 ? all * all / squares : 0.0;
}

double chi_square_quantile(double p, double degrees) {
  const double a = 0.5 * degrees;
  double low = 0.0, high = std::max(1.0, 2.0 * a);
  while (lower_gamma(a, high) < p) high *= 2.0;
  // Newton's steps on log P over log x, where it is nearly straight toward 0; halved wherever they would leave.
  double x = std::min(0.5 * high, std::exp((std::log(p) + std::lgamma(a + 1.0)) / a));
  for (int step = 0; step < 100; ++step) {
    const double value = lower_gamma(a, x);
    (value < p ? low : high) = x;
    const double density = std::exp(a * std::log(x) - x - std::lgamma(a));  // dP/d(log x)
    double next = x * std::exp(std::log(p / value) * value / density);
    if (!(next > low && next < high)) next = 0.5 * (low + high);
    if (std::abs(next - x) <= 1e-12 * x) return 2.0 * next;
    x = next;
  }
  return 2.0 * x;
}

double student_95(std::uint32_t degrees) {
  const double z = 1.959963984540054, over = 1.0 / degrees, z2 = z * z;
  const double first = z * (z2 + 1.0) / 4.0;
  const double second = z * ((5.0 * z2 + 16.0) * z2 + 3.0) / 96.0;
  const double third = z * (((3.0 * z2 + 19.0) * z2 + 17.0) * z2 - 15.0) / 384.0;
  const double fourth = z * ((((79.0 * z2 + 776.0) * z2 + 1482.0) * z2 - 1920.0) * z2 - 945.0) / 92160.0;
  return z + over * (first + over * (second + over * (third + over * fourth)));
}

Interval few_hits_interval(const BinHits& hits, double largest_weight) {
  const double taken = hits.negative, given = hits.sum + taken, all = given + taken;
  const auto part = [&](double sum) {
    if (!(sum > 0.0)) return Interval{0.0, garwood(0.0).high * largest_weight};
    const double weight = hits.squares / all;  // of an effective hit, of either kind
    const Interval number = garwood(sum / weight);
    return Interval{weight * number.low, weight * number.high};
  };
  const Interval of_given = part(given);
  if (!(taken > 0.0)) return of_given;
  const Interval of_taken = part(taken);
  return {hits.sum - std::hypot(given - of_given.low, of_taken.high - taken),
          hits.sum + std::hypot(of_given.high - given, taken - of_taken.low)};
}

}  // namespace mezzotint
