#include "inverse/gamut/gamut_map.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "forward/base/error.h"
#include "forward/process/printed_relief.h"
#include "inverse/gamut/gamut_search.h"
#include "inverse/search/minimize.h"

namespace mezzotint {

namespace {

constexpr int first_prints = 4, last_prints = 24;
constexpr double least_height_share = 0.02;
// Half the range of α over all directions: 1.4 % for ridges of 4 pixels, 0.7 % for all else (study of the gamut).
constexpr double direction_influence = 0.015;

double square(double value) { return value * value; }

/// Which part of which map.
struct TaskPlace {
  std::size_t kind, blur, ray;
};

TaskPlace place_of(const GamutMapOptions& options, std::size_t index) {
  const std::size_t blurs = options.blur_factors.size();
  // Rays outermost: neighbours differ in kind, so that tasks of like cost are spread evenly.
  return {index / blurs % options.kinds.size(), index % blurs, index / blurs / options.kinds.size()};
}

void require_valid(const GamutMapOptions& options) {
  require(!options.kinds.empty() && !options.blur_factors.empty(), "a gamut needs a kind of pattern and a blur");
  require(options.rays >= 2 && options.rays <= 200 && options.edge_heights >= 2 && options.edge_heights <= 200,
          "a gamut's border has 2 to 200 rays and heights");
  for (const double factor : options.blur_factors)
    require(std::isfinite(factor) && factor >= 0.0 && factor <= 10.0, "factors of the blur lie between 0 and 10");
}

PrinterProfile blurred(PrinterProfile printer, double factor) {
  printer.spread.width = printer.spread.width * factor;
  return printer;
}

AxisSquares sorted(const AxisSquares& squares) {
  return {std::max(squares.u, squares.v), std::max(0.0, std::min(squares.u, squares.v))};
}

// The smaller, the steeper at a ratio of the two slopes.
SquaresFigure steep_at(double ratio) {
  constexpr double weight = 25.0, nothing = 1e-12;
  return [ratio](const AxisSquares& squares) {
    const AxisSquares s = sorted(squares);
    const double found = 0.5 * std::log((s.v + nothing) / (s.u + nothing));
    return -0.5 * std::log(s.u + nothing) + weight * square(found - std::log(ratio));
  };
}

SquaresFigure steep_whatever_ratio() {
  return [](const AxisSquares& squares) { return -0.5 * std::log(sorted(squares).u + 1e-12); };
}

SquaresFigure stretched() {
  return [](const AxisSquares& squares) {
    const AxisSquares s = sorted(squares);
    return 0.5 * std::log((s.v + 1e-9 * s.u + 1e-15) / (s.u + 1e-15));
  };
}

// From the most stretched print, or where the ground hides more stretch, to the round one.
double ratio_of(const GamutMapOptions& options, const SlopeModel& model, std::size_t ray, double ground) {
  constexpr double hidden = 0.3;
  const AxisSquares longest = sorted(model.squares(lowest_by_model(model, stretched())));
  const AxisSquares steepest = sorted(model.squares(lowest_by_model(model, steep_whatever_ratio())));
  const double least =
      std::max(std::sqrt(longest.v / longest.u), hidden * std::sqrt(std::max(ground, 1e-8) / steepest.u));
  const double share = static_cast<double>(ray) / static_cast<double>(options.rays - 1);
  return std::min(1.0, std::pow(least, 1.0 - share));
}

bool has_one_slope(const GamutKind& kind) { return std::holds_alternative<Ridges>(kind.pattern); }

// A last local search on prints. Returns by how much it lowered the figure.
double polish(PrintedPoint& point, const GamutKind& kind, const SlopePrint& print, const SquaresFigure& figure) {
  std::vector<Variable> variables;
  for (std::size_t i = 0; i < kind.free.size(); ++i)
    variables.push_back({kind.free[i].name, kind.free[i].low, kind.free[i].high, point.values[i], true});
  const double before = point.figure;
  double halfway = before;
  int count = 0;
  const Objective objective = [&](const std::vector<double>& values) {
    const PrintedSquares squares = print.squares(pattern_of(kind, values, print.printer()));
    const double found = figure(squares.mean);
    if (found < point.figure) point = {values, squares, found};
    if (++count == last_prints / 2) halfway = point.figure;
    return found;
  };
  const MinimizeResult result =
      minimize(variables, objective, {.max_evaluations = last_prints, .relative_tolerance = 1e-3});
  return result.evaluations <= last_prints / 2 ? 0.0 : halfway - point.figure;
}

AlphaPair alphas(const AxisSquares& squares, double ground) {
  const AxisSquares s = sorted(squares);
  return {std::sqrt(2.0 * (s.u + ground)), std::sqrt(2.0 * (s.v + ground))};
}

double tolerance_of(const PrintedSquares& squares, double ground, double gain) {
  const double u = 0.5 * squares.standard_error.u / std::max(squares.mean.u + ground, 1e-12);
  const double v = 0.5 * squares.standard_error.v / std::max(squares.mean.v + ground, 1e-12);
  return std::sqrt(square(std::max(u, v)) + square(gain) + square(direction_influence));
}

void append(std::vector<double>& row, const AlphaPair& alpha, double tolerance, const std::vector<double>& values) {
  row.insert(row.end(), {alpha.x, alpha.y, tolerance});
  row.insert(row.end(), values.begin(), values.end());
}

// The same lengths from flat to as high as they are.
void append_stretched(std::vector<double>& row, const GamutMapOptions& options, const PrintedPoint& end,
                      const GamutKind& kind, const SlopePrint& print, double ground) {
  for (std::size_t i = 0; i < options.edge_heights; ++i) {
    const double share = static_cast<double>(i) / static_cast<double>(options.edge_heights - 1);
    std::vector<double> values = with_heights(kind, end.values, std::pow(least_height_share, 1.0 - share));
    for (std::size_t k = 0; k < values.size(); ++k) values[k] = std::max(values[k], kind.free[k].low);
    const PrintedSquares squares = print.squares(pattern_of(kind, values, print.printer()));
    append(row, alphas(squares.mean, ground), tolerance_of(squares, ground, 0.0), values);
  }
}

BorderPoint read_point(const double*& at, std::size_t values) {
  BorderPoint point{{at[0], at[1]}, at[2], {at + 3, at + 3 + values}};
  at += 3 + values;
  return point;
}

}  // namespace

std::size_t gamut_task_count(const GamutMapOptions& options) {
  require_valid(options);
  return options.kinds.size() * options.blur_factors.size() * options.rays;
}

std::string gamut_task_name(const GamutMapOptions& options, std::size_t index) {
  const TaskPlace place = place_of(options, index);
  return fmt::format("{}, blur × {:g}, ratio {} of {}", options.kinds.at(place.kind),
                     options.blur_factors.at(place.blur), place.ray + 1, options.rays);
}

// Of ray 0 first the steepest point, then the stretched ones; of the others the steepest point alone.
std::vector<double> run_gamut_task(const GamutMapOptions& options, const PrinterProfile& printer, std::size_t index) {
  require(index < gamut_task_count(options), "a gamut has no task of that number");
  const TaskPlace place = place_of(options, index);
  const PrinterProfile profile = blurred(printer, options.blur_factors[place.blur]);
  const GamutKind kind = gamut_kind(options.kinds[place.kind], profile, options.bounds);
  if (has_one_slope(kind) && place.ray > 0) return {};
  const double ground = square(ground_rms_slope(profile, split_ground(profile, options.wavelength).geometric));
  const SlopeModel model{kind, profile};
  const SquaresFigure figure =
      has_one_slope(kind) ? steep_whatever_ratio() : steep_at(ratio_of(options, model, place.ray, ground));
  const SlopePrint print(profile, options.patch);
  PrintedSearch search = lowest_by_print(kind, print, figure, -INFINITY, first_prints);
  const double gain = polish(search.best, kind, print, figure);
  std::vector<double> row;
  append(row, alphas(search.best.squares.mean, ground), tolerance_of(search.best.squares, ground, gain),
         search.best.values);
  if (place.ray == 0) append_stretched(row, options, search.best, kind, print, ground);
  return row;
}

GamutMap assemble_gamut(const GamutMapOptions& options, const PrinterProfile& printer,
                        const std::vector<std::vector<double>>& results) {
  require(results.size() == gamut_task_count(options), "a gamut needs the results of all its tasks");
  GamutMap map{options, gamut_formula(printer, options.wavelength, options.bounds), {}};
  for (const std::string& kind : options.kinds)
    for (const double factor : options.blur_factors)
      map.regions.push_back({kind, factor, map.formula.floor_alpha, {}, {}});
  for (std::size_t index = 0; index < results.size(); ++index) {
    if (results[index].empty()) continue;
    const TaskPlace place = place_of(options, index);
    GamutRegion& region = map.regions[place.kind * options.blur_factors.size() + place.blur];
    const std::size_t values = gamut_kind(region.kind, printer, options.bounds).free.size();
    const std::size_t points = place.ray == 0 ? 1 + options.edge_heights : 1;
    require(results[index].size() == points * (3 + values), "a task of the gamut has another result than it should");
    const double* at = results[index].data();
    region.steepest.push_back(read_point(at, values));
    for (std::size_t i = 1; i < points; ++i) region.stretched.push_back(read_point(at, values));
  }
  return map;
}

std::vector<AlphaPair> GamutRegion::outline() const {
  std::vector<AlphaPair> line{{floor_alpha, floor_alpha}};
  for (const BorderPoint& point : stretched) line.push_back(point.alpha);
  for (const BorderPoint& point : steepest) line.push_back(point.alpha);
  line.push_back({floor_alpha, floor_alpha});
  return line;
}

double GamutRegion::largest_tolerance() const {
  double largest = 0.0;
  for (const BorderPoint& point : steepest) largest = std::max(largest, point.tolerance);
  for (const BorderPoint& point : stretched) largest = std::max(largest, point.tolerance);
  return largest;
}

}  // namespace mezzotint
