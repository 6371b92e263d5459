#include "inverse/free_form/free_form.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include "forward/base/error.h"
#include "forward/base/random.h"
#include "inverse/free_form/free_form_starts.h"
#include "inverse/objective/smooth_lobe.h"

namespace mezzotint {

namespace {

constexpr std::size_t subsamples = 3;  // points of the relief a pixel and axis; their places change with each epoch
constexpr std::size_t fresh_subsamples = 8;
constexpr double least_height_um = 0.05;  // nothing cures below the threshold, and nothing has a slope there
constexpr std::size_t finalists = 2;
// Draws of places and grounds: those to choose a finalist by, and those of the verdict, which nothing else meets.
constexpr std::uint64_t choice_draws = std::uint64_t{1} << 24, fresh_draws = std::uint64_t{1} << 25;
constexpr std::uint64_t seed_stride = std::uint64_t{1} << 32;

// Where the relief is sampled.
struct Places {
  std::size_t subsamples = 1;
  double x = 0.5, y = 0.5;
};

// The printer and the light at one set of places. A search meets the ground in the mean over all its draws, as scatter:
// with draws of it, it would learn them by heart.
class Bench {
public:
  Bench(const LobeTarget& goal, const PrinterProfile& printer, std::size_t pixels, Length wavelength,
        const Places& places)
      : goal_(goal), process_(pixels, pixels, printer, {places.subsamples, Surround::Repeat, places.x, places.y}) {
    const double ground = ground_rms_slope(printer, split_ground(printer, wavelength).geometric);
    for (const auto& incidence : goal.incidences) {
      lobes_.emplace_back(goal.grid, goal.material, incidence);
      // Near the mirror direction a slope moves light by 2·cosθ_i of it.
      const double bins = std::cos(incidence.theta.radians()) * ground * static_cast<double>(goal.grid.grid().width);
      variances_.push_back(bins * bins);
    }
  }

  /// Mean of a distance over the directions of the light, with its slope toward every gray value.
  double distance(LobeDistance kind, const GrayImage& gray, std::vector<float>& gray_slopes) const {
    const ReliefSlopes relief = process_.slopes(gray);
    ReliefSlopes toward{std::vector<float>(relief.x.size()), std::vector<float>(relief.x.size())};
    const double share = 1.0 / static_cast<double>(lobes_.size());
    double sum = 0.0;
    for (std::size_t light = 0; light < lobes_.size(); ++light) {
      const DirectionMap map = goal_.grid.scattered(lobes_[light].map(relief.x, relief.y), variances_[light]);
      const DistanceWithSlopes found = lobe_distance(kind, goal_.grid, map, goal_.maps[light]);
      const std::vector<double> back = goal_.grid.scattered_back(found.slopes, variances_[light]);
      lobes_[light].add_slope_derivatives(relief.x, relief.y, back, share, toward.x, toward.y);
      sum += share * found.value;
    }
    gray_slopes = process_.gray_slopes(gray, toward);
    return sum;
  }

private:
  const LobeTarget& goal_;
  PrintProcess process_;
  std::vector<SmoothLobe> lobes_;
  std::vector<double> variances_;
};

// A search in progress: wanted heights, and how it went.
struct Growth {
  std::string start;
  std::vector<double> wanted_um;
  std::vector<double> history;
  double last = 0.0;
};

class FreeFormSearch {
public:
  FreeFormSearch(const LobeTarget& goal, const PrinterProfile& printer, const FreeFormOptions& options,
                 const Progress& progress)
      : goal_(goal), printer_(printer), options_(options), progress_(progress) {}

  FreeForm run() {
    std::vector<Growth> growths;
    const Bench first = bench(0);
    const std::vector<StartShape> shapes = start_shapes(goal_, printer_, options_);
    planned_ = 3.0 * static_cast<double>(shapes.size()) * options_.start_evaluations +
               static_cast<double>(finalists) * options_.evaluations;
    for (const StartShape& shape : shapes) {
      Growth straight{shape.name, {shape.wanted.heights_um().begin(), shape.wanted.heights_um().end()}, {}, 0.0};
      Growth moved = straight;
      improve(moved, first, LobeDistance::Wasserstein, options_.start_evaluations);
      improve(moved, first, LobeDistance::CubeRoot, options_.start_evaluations);
      improve(straight, first, LobeDistance::CubeRoot, options_.start_evaluations);
      growths.push_back(moved.last < straight.last ? std::move(moved) : std::move(straight));
    }
    std::ranges::stable_sort(growths, {}, &Growth::last);
    growths.resize(finalists);
    std::vector<double> chosen_by;
    for (Growth& growth : growths) {
      refine(growth);
      const std::vector<FreshDistance> fresh = fresh_distance(growth, choice_draws);
      chosen_by.push_back(std::ranges::find(fresh, LobeDistance::CubeRoot, &FreshDistance::distance)->value);
    }
    return verdict(growths[static_cast<std::size_t>(std::ranges::min_element(chosen_by) - chosen_by.begin())]);
  }

private:
  [[nodiscard]] Places places(std::size_t samples, std::uint64_t epoch) const {
    const auto place = RandomStream(options_.seed, RandomPurpose::SamplePlace).uniform4(epoch);
    return {samples, place[0], place[1]};
  }
  [[nodiscard]] Bench bench(std::uint64_t epoch) const {
    return {goal_, printer_, options_.pixels, options_.wavelength, places(subsamples, epoch)};
  }

  [[nodiscard]] HeightField wanted_relief(const std::vector<double>& wanted_um) const {
    const Length pitch = printer_.pixel_pitch;
    return HeightField({options_.pixels, options_.pixels, pitch, pitch}, Continuation::Periodic,
                       {wanted_um.begin(), wanted_um.end()});
  }
  [[nodiscard]] GrayImage gray_of(const std::vector<double>& wanted_um) const {
    return expose(wanted_relief(wanted_um), printer_).image;
  }

  void improve(Growth& growth, const Bench& bench, LobeDistance kind, int evaluations) {
    const double top = reachable_height(printer_).um();
    std::vector<Variable> variables(growth.wanted_um.size());
    for (std::size_t i = 0; i < variables.size(); ++i)
      variables[i] = {"height_um", least_height_um, top, std::clamp(growth.wanted_um[i], least_height_um, top)};
    const auto objective = [&](const std::vector<double>& values, std::vector<double>& slopes) {
      const HeightField wanted = wanted_relief(values);
      std::vector<float> gray_slopes;
      const double value = bench.distance(kind, expose(wanted, printer_).image, gray_slopes);
      const std::vector<float> back = wanted_height_slopes(wanted, printer_, gray_slopes);
      std::ranges::copy(back, slopes.begin());
      return value;
    };
    const auto observer = [&](int, const SearchStep& step) {
      ++done_;
      if (kind == LobeDistance::CubeRoot) growth.history.push_back(step.objective);
      report(progress_, "free form", std::min(1.0, done_ / planned_),
             fmt::format("from {}: {} {:.2e}", growth.start, name_of(kind), step.objective));
    };
    const MinimizeResult found = minimize_with_slopes(variables, objective,
                                                      {.algorithm = options_.algorithm,
                                                       .max_evaluations = evaluations,
                                                       .relative_tolerance = 1e-6,
                                                       .seed = options_.seed},
                                                      observer);
    growth.wanted_um = found.best.values;
    growth.last = found.best.objective;
  }

  // Epoch after epoch, each with other places.
  void refine(Growth& growth) {
    int left = options_.evaluations;
    for (std::uint64_t epoch = 1; left > 0; ++epoch) {
      const int now = std::min(left, options_.evaluations_per_epoch);
      improve(growth, bench(epoch), LobeDistance::CubeRoot, now);
      left -= now;
    }
  }

  // All distances of a design as it is printed: the printer's gray levels, other places, real draws of the ground.
  [[nodiscard]] std::vector<FreshDistance> fresh_distance(const Growth& growth, std::uint64_t draws) const {
    const GrayImage gray = quantize(gray_of(growth.wanted_um), printer_);
    const Places seen = places(fresh_subsamples, draws);
    const PrintProcess process(options_.pixels, options_.pixels, printer_,
                               {seen.subsamples, Surround::Repeat, seen.x, seen.y});
    const ReliefSlopes printed = process.slopes(gray);
    std::vector<ReliefSlopes> reliefs(options_.fresh_draws);
    tbb::parallel_for(std::size_t{0}, reliefs.size(),
                      [&](std::size_t i) { reliefs[i] = on_ground(printed, seen, draws + i); });
    std::vector<FreshDistance> all;
    all.reserve(all_lobe_distances.size());
    for (const LobeDistance kind : all_lobe_distances) all.push_back({kind, 0.0});
    for (std::size_t light = 0; light < goal_.incidences.size(); ++light) {
      const DirectionMap map = mean_lobe(reliefs, light);
      for (FreshDistance& fresh : all) {
        fresh.value += lobe_distance(fresh.distance, goal_.grid, map, goal_.maps[light]).value /
                       static_cast<double>(goal_.incidences.size());
      }
    }
    return all;
  }

  [[nodiscard]] ReliefSlopes on_ground(const ReliefSlopes& printed, const Places& seen, std::uint64_t draw) const {
    const Length pitch = printer_.pixel_pitch / static_cast<double>(seen.subsamples);
    const std::size_t side = options_.pixels * seen.subsamples;
    ReliefSlopes relief =
        ground_slopes({side, side, pitch, pitch}, {pitch * seen.x, pitch * seen.y}, printer_,
                      split_ground(printer_, options_.wavelength).geometric, options_.seed * seed_stride + draw);
    std::ranges::transform(relief.x, printed.x, relief.x.begin(), std::plus<float>());
    std::ranges::transform(relief.y, printed.y, relief.y.begin(), std::plus<float>());
    return relief;
  }

  [[nodiscard]] DirectionMap mean_lobe(const std::vector<ReliefSlopes>& reliefs, std::size_t light) const {
    const SmoothLobe lobe(goal_.grid, goal_.material, goal_.incidences[light]);
    DirectionMap mean(goal_.grid.grid().size(), 0.0);
    for (const ReliefSlopes& relief : reliefs) {
      const DirectionMap map = lobe.map(relief.x, relief.y);
      for (std::size_t k = 0; k < mean.size(); ++k) mean[k] += map[k] / static_cast<double>(reliefs.size());
    }
    return mean;
  }

  [[nodiscard]] FreeForm verdict(const Growth& best) const {
    return {.gray = quantize(gray_of(best.wanted_um), printer_),
            .start = best.start,
            .history = best.history,
            .on_search_draws = best.last,
            .fresh = fresh_distance(best, fresh_draws),
            .evaluations = static_cast<int>(done_)};
  }

  const LobeTarget& goal_;
  const PrinterProfile& printer_;
  const FreeFormOptions& options_;
  const Progress& progress_;
  double planned_ = 1.0, done_ = 0.0;
};

void require_valid_options(const LobeTarget& goal, const FreeFormOptions& options) {
  require(!goal.incidences.empty() && goal.maps.size() == goal.incidences.size(),
          "a free form needs a lobe for each direction of the light, and at least one");
  require(options.pixels >= 16 && options.pixels <= 1024, "a free form has 16 to 1024 pixels a side");
  require(options.fresh_draws >= 1 && options.fresh_draws <= 64, "a verdict takes 1 to 64 fresh draws");
  require(options.start_evaluations >= 1 && options.evaluations >= 1 && options.evaluations_per_epoch >= 1,
          "a free form needs at least one evaluation from each start and in each epoch");
}

}  // namespace

FreeForm find_free_form(const LobeTarget& goal, const PrinterProfile& printer, const FreeFormOptions& options,
                        const Progress& progress) {
  require_valid_options(goal, options);
  return FreeFormSearch(goal, printer, options, progress).run();
}

}  // namespace mezzotint
