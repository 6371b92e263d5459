#pragma once

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

/// How well parameters agree with closed forms: what the tests of defined surfaces assert, and what
/// docs/accuracy-of-parameters.md shows.

namespace mezzotint::test {

inline constexpr double infinite = std::numeric_limits<double>::infinity();

/// A parameter that has a closed form, and what must hold of the value found.
struct Known {
  std::string parameter;
  double value = 0.0;             ///< in µm where it has a unit; infinite: it must grow without limit, by `order`
  double figures = 6.0;           ///< significant figures that must agree, at the finest spacing
  std::optional<double> order{};  ///< of the error in the spacing: measured by halving it twice
  std::string why{};              ///< where it is neither six figures nor a whole order
  double scale = 0.0;             ///< what figures are counted from; 0: the value itself
};

/// Six figures, of the value or of a scale where the value is 0.
inline Known exact(const std::string& parameter, double value, double scale = 0.0) {
  return {parameter, value, 6.0, {}, "", scale};
}
/// An error that falls by this order of the spacing: then the limit is right to far more figures than the value shows.
inline Known to_order(const std::string& parameter, double value, double order, const std::string& why = "") {
  return {parameter, value, 0.0, order, why, 0.0};
}
/// Fewer figures, for a reason.
inline Known to_figures(const std::string& parameter, double value, double figures, const std::string& why,
                        double scale = 0.0) {
  return {parameter, value, figures, {}, why, scale};
}

/// What was found for it.
struct Found {
  double value = 0.0, figures = 0.0;
  std::optional<double> order, earlier_order;
};

using Parameters = std::map<std::string, double>;

/// A surface (or a profile) that is defined by a formula.
struct DefinedSurface {
  std::string name, formula;
  std::function<Parameters(std::size_t)> at;  ///< the parameters with so many samples a side
  std::size_t samples = 64;                   ///< at first; the finest has four times as many
  std::vector<Known> known;
};

inline double figures_of(double found, double expected, double scale) {
  const double error = std::abs(found - expected) / (scale > 0.0 ? scale : std::abs(expected));
  return error > 0.0 ? std::min(16.0, -std::log10(error)) : 16.0;
}

inline Found compare(const Known& known, double coarse, double middle, double fine) {
  Found found{fine, figures_of(fine, known.value, known.scale), {}, {}};
  if (!known.order) return found;
  const auto error = [&](double value) { return std::isinf(known.value) ? value : std::abs(value - known.value); };
  found.earlier_order = std::log2(error(coarse) / error(middle));
  found.order = std::log2(error(middle) / error(fine));
  return found;
}

namespace detail {
// To the file that the environment variable MEZZOTINT_ACCURACY names; nowhere where it names none.
inline void append_row(const nlohmann::ordered_json& row) {
  const char* path = std::getenv("MEZZOTINT_ACCURACY");
  if (path != nullptr && *path != '\0') std::ofstream(path, std::ios::app) << row.dump() << '\n';
}
}  // namespace detail

/// A row of docs/accuracy-of-parameters.md.
inline void record(const DefinedSurface& surface, const Known& known, const Found& found) {
  nlohmann::ordered_json row = {{"surface", surface.name}, {"formula", surface.formula}, {"parameter", known.parameter},
                                {"expected", known.value}, {"found", found.value},       {"figures", found.figures},
                                {"why", known.why}};
  if (std::isinf(known.value)) row["expected"] = "∞";
  if (found.order) row["order"] = *found.order;
  detail::append_row(row);
}

/// Asserts all that is known of a surface.
inline void expect_agreement(const DefinedSurface& surface) {
  SCOPED_TRACE(surface.name);
  const bool halves = std::ranges::any_of(surface.known, [](const Known& known) { return known.order.has_value(); });
  const Parameters fine = surface.at(4 * surface.samples);
  const Parameters middle = halves ? surface.at(2 * surface.samples) : fine;
  const Parameters coarse = halves ? surface.at(surface.samples) : fine;
  for (const Known& known : surface.known) {
    const auto in = [&](const Parameters& parameters) { return parameters.at(known.parameter); };
    const Found found = compare(known, in(coarse), in(middle), in(fine));
    record(surface, known, found);
    if (!std::isinf(known.value)) {
      EXPECT_GE(found.figures, known.figures)
          << known.parameter << ": " << found.value << " instead of " << known.value;
    }
    if (!known.order) continue;
    // Of two halvings the second is nearer to the limit; a tenth of an order is what the next term leaves there.
    EXPECT_NEAR(*found.order, *known.order, 0.1) << known.parameter;
    EXPECT_NEAR(*found.earlier_order, *known.order, 0.25) << known.parameter;
  }
}

/// ∫ f from a to b by the substitution of Takahasi and Mori (tanh-sinh), to about 1e-14 also where f is singular at an
/// end: the references are continuous, and know nothing of samples.
template <class Function>
double integral(const Function& f, double a, double b) {
  constexpr double step = 1.0 / 64.0, pi = 3.14159265358979323846;
  double sum = 0.0;
  for (int k = -256; k <= 256; ++k) {
    const double t = step * k, u = 0.5 * pi * std::sinh(t);
    const double weight = 0.5 * pi * std::cosh(t) / (std::cosh(u) * std::cosh(u));
    // The distance to the nearer end, without cancellation.
    const double share = 1.0 / (1.0 + std::exp(2.0 * std::abs(u)));
    const double x = u < 0.0 ? a + (b - a) * share : b - (b - a) * share;
    if (weight > 1e-300 && x > a && x < b) sum += weight * f(x);
  }
  return 0.5 * (b - a) * step * sum;
}

/// The place between a and b where f, which is positive at a and negative at b, is 0.
template <class Function>
double root(const Function& f, double a, double b) {
  for (int i = 0; i < 100; ++i) {
    const double middle = 0.5 * (a + b);
    (f(middle) > 0.0 ? a : b) = middle;
  }
  return 0.5 * (a + b);
}

}  // namespace mezzotint::test
