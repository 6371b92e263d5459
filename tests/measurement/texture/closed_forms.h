#pragma once

#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "tests/measurement/texture/agreement.h"

/// Closed forms of areal parameters that follow from few facts of a surface. None of them shares code with the program.

namespace mezzotint::test {

/// Height parameters of a surface whose heights above its base have the moments E z, E z², E z³, E z⁴.
struct Moments {
  double first = 0.0, second = 0.0, third = 0.0, fourth = 0.0;

  [[nodiscard]] double sq() const { return std::sqrt(second - first * first); }
  [[nodiscard]] double ssk() const {
    return (third - 3.0 * first * second + 2.0 * std::pow(first, 3)) / std::pow(sq(), 3);
  }
  [[nodiscard]] double sku() const {
    return (fourth - 4.0 * first * third + 6.0 * first * first * second - 3.0 * std::pow(first, 4)) / std::pow(sq(), 4);
  }
};

/// A material ratio curve as a formula: the height that the share p of the surface reaches.
using Curve = std::function<double(double)>;

/// Functional parameters of a curve, by quadrature.
struct Functional {
  double Sk = 0.0, Spk = 0.0, Svk = 0.0, Smr1 = 0.0, Smr2 = 0.0;
  double Vmp = 0.0, Vmc = 0.0, Vvc = 0.0, Vvv = 0.0, Sxp = 0.0;
};

/// @param flattest  where the flattest 40 % of the curve begin
/// @param kink      where the curve has a kink, if it has one: it is integrated up to there, and from there
inline Functional functional_of(const Curve& z, double flattest, double kink = 0.0) {
  const auto integral = [kink](const auto& f, double a, double b) {
    if (!(kink > a && kink < b)) return test::integral(f, a, b);
    return test::integral(f, a, kink) + test::integral(f, kink, b);
  };
  // Line of least squares: slope 12 ∫ (p − middle) z / 0.4³, through the mean.
  const double middle = flattest + 0.2, end = flattest + 0.4;
  const double slope = 12.0 / 0.064 * integral([&](double p) { return (p - middle) * z(p); }, flattest, end);
  const double mean = integral(z, flattest, end) / 0.4, top = mean - slope * middle, bottom = top + slope;
  const auto material = [&](double p) { return integral(z, 0.0, p) - p * z(p); };
  const auto voids = [&](double p) { return (1.0 - p) * z(p) - integral(z, p, 1.0); };
  Functional f;
  f.Sk = -slope;
  f.Smr1 = root([&](double p) { return z(p) - top; }, 0.0, 1.0);
  f.Smr2 = root([&](double p) { return z(p) - bottom; }, 0.0, 1.0);
  // Where the line is beyond all heights, nothing stands out.
  f.Spk = z(0.0) > top ? 2.0 * (integral(z, 0.0, f.Smr1) / f.Smr1 - top) : 0.0;
  f.Svk = z(1.0) < bottom ? 2.0 * (bottom - integral(z, f.Smr2, 1.0) / (1.0 - f.Smr2)) : 0.0;
  f.Vmp = material(0.1);
  f.Vmc = material(0.8) - f.Vmp;
  f.Vvv = voids(0.8);
  f.Vvc = voids(0.1) - f.Vvv;
  f.Sxp = z(0.025) - z(0.5);
  return f;
}

/// The volumes and Sxp, which hang on no line; `each` makes what is asked of one.
template <class Each>
std::vector<Known> volumes(const Functional& f, const Each& each) {
  return {each("Vmp", f.Vmp), each("Vmc", f.Vmc), each("Vvc", f.Vvc), each("Vvv", f.Vvv), each("Sxp", f.Sxp)};
}

template <class Each>
std::vector<Known> line_parameters(const Functional& f, const Each& each) {
  return {each("Sk", f.Sk), each("Spk", f.Spk), each("Svk", f.Svk), each("Smr1", f.Smr1), each("Smr2", f.Smr2)};
}

inline std::vector<Known> operator+(std::vector<Known> a, const std::vector<Known>& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

}  // namespace mezzotint::test
