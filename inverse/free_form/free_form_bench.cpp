#include "inverse/free_form/free_form_bench.h"

#include <algorithm>
#include <cmath>

namespace mezzotint {

namespace {

// A goal's bins are hard ones, softened. Soft ones of its own width would spread light by another shape, which a cube
// root sees at the edge of a lobe; a third as wide, summed up and softened alike, are nearly as hard.
constexpr std::size_t finest = 3, most_bins = 512;
constexpr double softening = 1.0 / 6.0;  // what `softened` spreads, in squared bins

std::size_t finer_by(const DirectionGrid& grid) {
  return std::clamp(most_bins / std::max(grid.width, grid.height), std::size_t{1}, finest);
}
DirectionGrid finer(const DirectionGrid& grid) { return {grid.width * finer_by(grid), grid.height * finer_by(grid)}; }

// The bin of the coarse grid that holds each bin of the fine one.
template <class Use>
void for_each_fine(const DirectionGrid& coarse, const DirectionGrid& fine, const Use& use) {
  const std::size_t by = fine.width / coarse.width;
  for (std::size_t row = 0; row < fine.height; ++row) {
    for (std::size_t column = 0; column < fine.width; ++column)
      use(row * fine.width + column, row / by * coarse.width + column / by);
  }
}

double over(double value, double area) { return area > 0.0 ? value / area : 0.0; }

}  // namespace

WantedHeights wanted_range(const PrinterProfile& printer) {
  const double lowest = -2.0 * printer.cure.beta.um();
  const double dark = printer.cure.gamma < 0.0
                          ? printer.cure.alpha.um() + printer.cure.beta.um() * std::log(-printer.cure.gamma)
                          : lowest;
  return {std::max(lowest, dark), reachable_height(printer).um()};
}

GrayImage gray_of_heights(const std::vector<double>& heights_um, std::size_t pixels, const PrinterProfile& printer) {
  const CureCurve& curve = printer.cure;
  GrayImage gray{pixels, pixels, std::vector<float>(heights_um.size())};
  std::ranges::transform(heights_um, gray.values.begin(), [&curve](double height_um) {
    const double value = curve.gamma + std::exp((height_um - curve.alpha.um()) / curve.beta.um());
    return static_cast<float>(std::clamp(value, 0.0, 1.0));
  });
  return gray;
}

SmoothGrid model_bins(const LobeTarget& goal) { return SmoothGrid(finer(goal.grid.grid())); }

FreeFormBench::FreeFormBench(const LobeTarget& goal, const SmoothGrid& fine, const PrinterProfile& printer,
                             const FreeFormOptions& options, const Places& places)
    : goal_(goal),
      process_(options.pixels, options.pixels, printer, {places.subsamples, Surround::Repeat, places.x, places.y}),
      fine_(fine) {
  const double ground = ground_rms_slope(printer, split_ground(printer, options.wavelength).geometric);
  for (const auto& incidence : goal.incidences) {
    lobes_.emplace_back(fine_, goal.material, incidence);
    // Near the mirror direction a slope moves light by 2·cosθ_i of it.
    const double bins = std::cos(incidence.theta.radians()) * ground * static_cast<double>(fine_.grid().width);
    variances_.push_back(bins * bins);
  }
}

DirectionMap FreeFormBench::to_goal(const DirectionMap& fine, std::size_t light) const {
  const DirectionMap scattered = fine_.scattered(fine, variances_[light]);
  const std::vector<double>& areas = goal_.grid.areas();
  DirectionMap map(areas.size(), 0.0);
  for_each_fine(goal_.grid.grid(), fine_.grid(),
                [&](std::size_t from, std::size_t to) { map[to] += fine_.areas()[from] * scattered[from]; });
  for (std::size_t k = 0; k < map.size(); ++k) map[k] = over(map[k], areas[k]);
  return goal_.grid.scattered(map, softening);
}

std::vector<double> FreeFormBench::from_goal(std::vector<double> slopes, std::size_t light) const {
  slopes = goal_.grid.scattered_back(slopes, softening);
  std::vector<double> fine(fine_.grid().size());
  for_each_fine(goal_.grid.grid(), fine_.grid(), [&](std::size_t from, std::size_t to) {
    fine[from] = over(fine_.areas()[from] * slopes[to], goal_.grid.areas()[to]);
  });
  return fine_.scattered_back(fine, variances_[light]);
}

std::vector<DirectionMap> FreeFormBench::lobes(const GrayImage& gray) const {
  const ReliefSlopes relief = process_.slopes(gray);
  std::vector<DirectionMap> maps;
  for (std::size_t light = 0; light < lobes_.size(); ++light)
    maps.push_back(to_goal(lobes_[light].map(relief.x, relief.y), light));
  return maps;
}

double FreeFormBench::distance(const std::vector<WeightedDistance>& objective, const std::vector<DirectionMap>& beyond,
                               const GrayImage& gray, std::vector<float>& gray_slopes) const {
  const ReliefSlopes relief = process_.slopes(gray);
  ReliefSlopes toward{std::vector<float>(relief.x.size()), std::vector<float>(relief.x.size())};
  const double share = 1.0 / static_cast<double>(lobes_.size());
  double sum = 0.0;
  for (std::size_t light = 0; light < lobes_.size(); ++light) {
    DirectionMap map = to_goal(lobes_[light].map(relief.x, relief.y), light);
    std::vector<double> slopes(map.size(), 0.0);
    std::vector<char> dark(map.size(), 0);
    for (std::size_t k = 0; !beyond.empty() && k < map.size(); ++k) {
      map[k] += beyond[light][k];
      dark[k] = map[k] < 0.0;
      map[k] = std::max(0.0, map[k]);
    }
    for (const WeightedDistance& part : objective) {
      const DistanceWithSlopes found = lobe_distance(part.distance, goal_.grid, map, goal_.maps[light]);
      sum += share * part.weight * found.value;
      for (std::size_t k = 0; k < slopes.size(); ++k) slopes[k] += dark[k] != 0 ? 0.0 : part.weight * found.slopes[k];
    }
    lobes_[light].add_slope_derivatives(relief.x, relief.y, from_goal(std::move(slopes), light), share, toward.x,
                                        toward.y);
  }
  gray_slopes = process_.gray_slopes(gray, toward);
  return sum;
}

}  // namespace mezzotint
