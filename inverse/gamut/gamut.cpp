#include "inverse/gamut/gamut.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include "forward/base/error.h"
#include "inverse/gamut/gamut_search.h"

namespace mezzotint {

namespace {

constexpr int most_prints = 8;
// The closed form is trusted where the target could be this much further out.
constexpr double far_inside = 1.3;
// Distances are of log variances; of α they are half.
constexpr double variance_of_alpha = 2.0;

double square(double value) { return value * value; }

/// A target, seen along its own axes, and the ground below every print.
struct Wanted {
  AlphaPair alpha;
  double floor_alpha = 0.0;
  double tolerance = 0.0;

  [[nodiscard]] double ground() const { return 0.5 * square(floor_alpha); }
  // What the pattern must show by itself, in mean squares; negative where the ground alone is too much.
  [[nodiscard]] AxisSquares pattern_squares() const {
    return {0.5 * square(alpha.x) - ground(), 0.5 * square(alpha.y) - ground()};
  }
};

// Steeper axis first.
AlphaPair printed_alphas(const AxisSquares& squares, double ground) {
  const double u = std::max(0.0, squares.u), v = std::max(0.0, squares.v);
  return {std::sqrt(2.0 * (std::max(u, v) + ground)), std::sqrt(2.0 * (std::min(u, v) + ground))};
}

Target target_of(const AlphaPair& alpha) {
  return {.kind = "gamut",
          .slopes = {alpha.x / std::numbers::sqrt2, alpha.y / std::numbers::sqrt2, {}},
          .rotation_matters = false};
}

SquaresFigure distance_to(const AlphaPair& alpha, double ground) {
  return [target = target_of(alpha), ground](const AxisSquares& squares) {
    return covariance_distance({squares.u + ground, squares.v + ground, 0.0}, target);
  };
}

// Largest relative error of an α.
double alpha_error(const AlphaPair& found, const AlphaPair& wanted) {
  return std::max(std::abs(std::log(found.x / wanted.x)), std::abs(std::log(found.y / wanted.y)));
}

bool model_reaches(const SlopeModel& model, const AxisSquares& squares, double ground, double tolerance) {
  const AlphaPair alpha = printed_alphas(squares, ground);
  const std::vector<double> values = lowest_by_model(model, distance_to(alpha, ground));
  return alpha_error(printed_alphas(model.squares(values), ground), alpha) <= tolerance;
}

// Whether the model reaches all that lies `factor` further out: steeper, longer and rounder.
bool model_reaches_around(const SlopeModel& model, const Wanted& wanted, double factor) {
  const AxisSquares s = wanted.pattern_squares();
  if (s.u <= 0.0 || s.v <= 0.0) return false;
  const double more = square(factor);
  const std::array<AxisSquares, 3> around = {AxisSquares{more * s.u, more * s.v}, AxisSquares{more * s.u, s.v / more},
                                             AxisSquares{more * s.u, std::min(more * more * s.v, more * s.u)}};
  return std::ranges::all_of(around, [&](const AxisSquares& squares) {
    return model_reaches(model, squares, wanted.ground(), 0.3 * wanted.tolerance);
  });
}

double relative_alpha_error(const PrintedSquares& squares, double ground) {
  const auto error = [ground](double mean, double standard_error) {
    return 0.5 * standard_error / std::max(mean + ground, 1e-12);
  };
  return std::max(error(squares.mean.u, squares.standard_error.u), error(squares.mean.v, squares.standard_error.v));
}

std::string floor_in_words(const Wanted& wanted) {
  const double floor = wanted.floor_alpha;
  if (wanted.alpha.x < floor * (1.0 - wanted.tolerance))
    return fmt::format(
        "smoother than the printer's own ground, whose slopes alone make α = {:.3g}; only a smoother ground helps",
        floor);
  return fmt::format(
      "the ratio {:.3g} is above α_x/floor = {:.3g}/{:.3g} = {:.3g}: α_y = {:.3g} lies below the ground's own {:.3g}",
      wanted.alpha.x / wanted.alpha.y, wanted.alpha.x, floor, wanted.alpha.x / floor, wanted.alpha.y, floor);
}

// The smallest α_y that the model prints at an α_x; none where it is not that steep.
std::optional<double> least_minor_alpha(const SlopeModel& model, const Wanted& wanted) {
  constexpr double weight = 400.0;
  const double major = square(wanted.alpha.x) / 2.0 - wanted.ground();
  if (major <= 0.0) return {};
  const std::vector<double> values = lowest_by_model(model, [&](const AxisSquares& squares) {
    const double u = std::max(squares.u, squares.v), v = std::min(squares.u, squares.v);
    return weight * square(0.5 * std::log(std::max(u, 1e-15) / major)) + 0.5 * std::log(v + wanted.ground() + 1e-15);
  });
  const AlphaPair found = printed_alphas(model.squares(values), wanted.ground());
  if (std::abs(std::log(found.x / wanted.alpha.x)) > wanted.tolerance) return {};
  return found.y;
}

std::string outside_in_words(const Wanted& wanted, const SlopeModel& model, const AlphaPair& nearest) {
  const GamutKind& kind = model.kind;
  const double tolerance = wanted.tolerance;
  if (std::holds_alternative<Ridges>(kind.pattern) && wanted.alpha.y > wanted.floor_alpha * (1.0 + tolerance))
    return fmt::format(
        "ridges have slopes along one axis only: across it there is the ground's {:.3g} alone, not {:.3g}",
        wanted.floor_alpha, wanted.alpha.y);
  const std::optional<double> least = least_minor_alpha(model, wanted);
  if (least && *least > wanted.alpha.y)
    return fmt::format(
        "{} within its longest length is not stretched enough: at α_x = {:.3g} its ratio reaches {:.3g}, not {:.3g}",
        kind.name, wanted.alpha.x, wanted.alpha.x / *least, wanted.alpha.x / wanted.alpha.y);
  if (nearest.x < wanted.alpha.x * (1.0 - tolerance) || nearest.y < wanted.alpha.y * (1.0 - tolerance))
    return fmt::format(
        "steeper than pixel, blur and the layer's height let through: the nearest print of {} has α {:.3g}, {:.3g}; "
        "less blur, smaller pixels or a thicker layer would help",
        kind.name, nearest.x, nearest.y);
  return fmt::format("{} has no such pair of slopes: the nearest print has α {:.3g}, {:.3g}", kind.name, nearest.x,
                     nearest.y);
}

void explain(GamutVerdict& verdict, const Wanted& wanted, const SlopeModel& model) {
  const GamutKind& kind = model.kind;
  if (verdict.place == GamutPlace::Outside)
    verdict.why = verdict.by_formula ? floor_in_words(wanted) : outside_in_words(wanted, model, verdict.nearest);
  else if (verdict.place == GamutPlace::Edge)
    verdict.why = fmt::format("within {:.2g} % of what {} reaches: the answer depends on the profile's last digits",
                              100.0 * wanted.tolerance, kind.name);
  else
    verdict.why = fmt::format("{} reaches it", kind.name);
}

// By a model alone; false where that is not sure.
bool is_far_inside(GamutVerdict& verdict, const Wanted& wanted, const GamutKind& kind, const PrinterProfile& printer) {
  const SlopeModel model{kind, printer};
  if (!model_reaches_around(model, wanted, far_inside)) return false;
  verdict.pattern = pattern_of(kind, lowest_by_model(model, distance_to(wanted.alpha, wanted.ground())), printer);
  verdict.nearest = wanted.alpha;
  return true;
}

GamutPlace place_of(const GamutVerdict& verdict, const Wanted& wanted, const GamutKind& kind,
                    const PrinterProfile& printer) {
  const double error = alpha_error(verdict.nearest, wanted.alpha);
  if (verdict.by_formula || error - 2.0 * verdict.nearest_error > wanted.tolerance) return GamutPlace::Outside;
  if (error > 0.5 * wanted.tolerance) return GamutPlace::Edge;
  const SlopeModel model{kind, printer, verdict.correction};
  return model_reaches_around(model, wanted, 1.0 + wanted.tolerance) ? GamutPlace::Inside : GamutPlace::Edge;
}

void judge_by_print(GamutVerdict& verdict, const Wanted& wanted, const GamutKind& kind, const PrinterProfile& printer,
                    const SlopePatch& patch) {
  const SlopePrint print(printer, patch);
  const double good_enough = square(0.2 * variance_of_alpha * wanted.tolerance);
  const PrintedSearch search =
      lowest_by_print(kind, print, distance_to(wanted.alpha, wanted.ground()), good_enough, most_prints);
  verdict.prints = search.prints;
  verdict.nearest = printed_alphas(search.best.squares.mean, wanted.ground());
  verdict.nearest_error = relative_alpha_error(search.best.squares, wanted.ground());
  verdict.distance = std::sqrt(std::max(0.0, search.best.figure));
  verdict.pattern = pattern_of(kind, search.best.values, printer);
  verdict.correction = search.correction;
  verdict.place = place_of(verdict, wanted, kind, printer);
}

// The pattern's steeper axis onto the target's.
Pattern directed(const Pattern& pattern, const PrinterProfile& printer, const Target& target) {
  const AxisSquares squares = linear_print_slopes(pattern, printer);
  const Angle own = squares.v > squares.u ? Angle::from_degrees(90.0) : Angle{};
  return turned(pattern, target.slopes.rotation - own);
}

std::vector<std::string> kinds_that_reach(const Target& target, const PrinterProfile& printer, const GamutKind& but,
                                          GamutOptions options) {
  options.ask_other_kinds = false;
  const auto& names = gamut_kind_names();
  std::vector<char> reached(names.size());
  tbb::parallel_for(std::size_t{0}, names.size(), [&](std::size_t i) {
    if (names[i] != but.name) reached[i] = judge(target, printer, names[i], options).place != GamutPlace::Outside;
  });
  std::vector<std::string> list;
  for (std::size_t i = 0; i < names.size(); ++i)
    if (reached[i] != 0) list.push_back(names[i]);
  return list;
}

}  // namespace

GamutVerdict judge(const Target& target, const PrinterProfile& printer, const GamutKind& kind,
                   const GamutOptions& options) {
  require(options.tolerance > 0.0 && options.tolerance < 0.5, "the gamut's tolerance lies between 0 and 0.5");
  const GamutFormula formula = gamut_formula(printer, options.wavelength, options.bounds);
  const Wanted wanted{alphas_of(target.slopes), formula.floor_alpha, options.tolerance};
  GamutVerdict verdict{.kind = kind.name, .wanted = wanted.alpha};
  verdict.by_formula = wanted.alpha.y < formula.floor_alpha * (1.0 - options.tolerance);
  if (verdict.by_formula || !is_far_inside(verdict, wanted, kind, printer))
    judge_by_print(verdict, wanted, kind, printer, options.patch);
  verdict.pattern = directed(verdict.pattern, printer, target);
  explain(verdict, wanted, {kind, printer, verdict.correction});
  if (options.ask_other_kinds && verdict.place == GamutPlace::Outside && !verdict.by_formula)
    verdict.other_kinds = kinds_that_reach(target, printer, kind, options);
  return verdict;
}

GamutVerdict judge(const Target& target, const PrinterProfile& printer, const std::string& kind,
                   const GamutOptions& options) {
  return judge(target, printer, gamut_kind(kind, printer, options.bounds), options);
}

}  // namespace mezzotint
