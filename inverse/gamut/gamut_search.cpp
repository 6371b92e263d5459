#include "inverse/gamut/gamut_search.h"

#include <algorithm>
#include <cmath>

#include "forward/base/random.h"
#include "inverse/search/minimize.h"

namespace mezzotint {

namespace {

constexpr std::size_t coarse_points = 160, local_searches = 3;
constexpr std::uint64_t coarse_seed = 5;
// A correction beyond these tells of a pattern that the process cannot show at all.
constexpr double least_correction = 0.05, largest_correction = 4.0;

// A point of the room, even in logarithms.
std::vector<double> coarse_point(const GamutKind& kind, std::uint64_t index) {
  const RandomStream stream(coarse_seed, RandomPurpose::SearchStart);
  std::vector<double> values(kind.free.size());
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double share = stream.uniform4(index, static_cast<std::uint32_t>(i / 4)).at(i % 4);
    values[i] = kind.free[i].low * std::pow(kind.free[i].high / kind.free[i].low, share);
  }
  return values;
}

std::vector<double> inside(const GamutKind& kind, std::vector<double> values) {
  for (std::size_t i = 0; i < values.size(); ++i)
    values[i] = std::clamp(values[i], kind.free[i].low, kind.free[i].high);
  return values;
}

SearchStep local_search(const SlopeModel& model, const SquaresFigure& figure, const std::vector<double>& start) {
  std::vector<Variable> variables;
  for (std::size_t i = 0; i < start.size(); ++i) {
    const GamutParameter& free = model.kind.free[i];
    variables.push_back({free.name, free.low, free.high, start[i], true});
  }
  const MinimizeOptions options{.max_evaluations = 220, .relative_tolerance = 1e-4};
  return minimize(
             variables, [&](const std::vector<double>& values) { return figure(model.squares(values)); }, options)
      .best;
}

double corrected(double printed, double closed) {
  return closed > 0.0 ? std::clamp(printed / closed, least_correction, largest_correction) : 1.0;
}

}  // namespace

AxisSquares SlopeModel::squares(const std::vector<double>& values) const {
  const AxisSquares closed = linear_print_slopes(pattern_of(kind, values, printer), printer);
  return {closed.u * correction.u, closed.v * correction.v};
}

std::vector<double> lowest_by_model(const SlopeModel& model, const SquaresFigure& figure,
                                    const std::vector<std::vector<double>>& hints) {
  std::vector<SearchStep> starts;
  const auto add = [&](std::vector<double> values) {
    const double at = figure(model.squares(values));
    starts.push_back({std::move(values), at});
  };
  for (std::uint64_t i = 0; i < coarse_points; ++i) add(coarse_point(model.kind, i));
  std::stable_sort(starts.begin(), starts.end(),
                   [](const SearchStep& a, const SearchStep& b) { return a.objective < b.objective; });
  starts.resize(local_searches);
  for (const auto& hint : hints) add(inside(model.kind, hint));
  SearchStep best = starts.front();
  for (const SearchStep& start : starts) {
    const SearchStep found = local_search(model, figure, start.values);
    if (found.objective < best.objective) best = found;
  }
  return best.values;
}

PrintedSearch lowest_by_print(const GamutKind& kind, const SlopePrint& print, const SquaresFigure& figure,
                              double good_enough, int most_prints) {
  SlopeModel model{kind, print.printer()};
  PrintedSearch search;
  std::vector<std::vector<double>> hints;
  while (search.prints < most_prints) {
    const std::vector<double> values = lowest_by_model(model, figure, hints);
    const Pattern pattern = pattern_of(kind, values, print.printer());
    PrintedPoint point{values, print.squares(pattern), 0.0};
    point.figure = figure(point.squares.mean);
    ++search.prints;
    const AxisSquares closed = linear_print_slopes(pattern, print.printer());
    model.correction = {corrected(point.squares.mean.u, closed.u), corrected(point.squares.mean.v, closed.v)};
    const double before = search.best.figure;
    const bool better = search.prints == 1 || point.figure < before;
    if (better) {
      search.best = point;
      search.correction = model.correction;
      hints.assign(1, values);
    }
    const bool settled = search.prints > 1 && std::abs(point.figure - before) < 0.02 * std::abs(before) + 1e-6;
    if (search.best.figure <= good_enough || settled) break;
  }
  return search;
}

}  // namespace mezzotint
