// CPU time to an error of 1 %: the slides' plain method against PathTracer as it comes.
//
// Scene    a periodic relief of random waves (16 to 64 a side), RMS gradient 0.3 (--gradient), 1024² cells (--cells),
//          64² bins; index 1.5 and a mirror; light at 0, 30, 60 and 80° (--theta).
// Error    relative_rmse: the RMSE of the reflection over the disc (weighted by pixel ∩ disc) ÷ its mean, against
//          Embree's beam with another seed (--reference, log2 of its paths). The reference's own error is printed, and
//          its square is taken out of ours.
// Slides   one ray at a time through Embree, triangles, random positions, roulette at every interface, the weight that
//          conserves energy. Its error falls as 1/√N, so its time to 1 % follows from 8 runs together (--slides, log2
//          of all their paths): time · (error/1 %)².
// Ours     as it comes (or --splat, --beam): budgets of 2^11, 2^12, … paths, each with --repeats seeds: root mean
// square error and median time. The time
//          to 1 % lies between the budgets on either side of it (straight in logarithms).
// Coverage with --coverage (log2 of the paths of a run): how often the 95 % intervals hold the reference, over 200
// seeds,
//          in bins that ten paths or more reach; instead of all the above.
// Time     CPU time of one thread, with the splat and all that is done for one direction of the light. Pyramid and tree
//          are built before, and their time is printed apart.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <tbb/global_control.h>
#include <nlohmann/json.hpp>

#include "forward/base/error.h"
#include "forward/base/random.h"
#include "forward/scattering/path_tracing.h"

namespace {

using namespace mezzotint;

constexpr double goal = 0.01;
constexpr std::uint32_t slides_runs = 3;

struct Settings {
  std::size_t cells = 1024, bins = 64;
  double gradient = 0.3;
  std::vector<double> thetas_deg = {0.0, 30.0, 60.0, 80.0};
  std::vector<std::string> materials = {"dielectric", "mirror"};
  int slides_log2 = 24, reference_log2 = 26, repeats = 5, coverage_log2 = 0;
  ControlVariate by = ControlVariate::Automatic;
  std::filesystem::path cache, json;
};

double cpu_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

HeightField random_waves(std::size_t cells, double gradient) {
  constexpr double turn = 2.0 * std::numbers::pi;
  HeightField field({cells, cells, Length::from_um(1.0), Length::from_um(1.0)}, Continuation::Periodic);
  std::vector<double> z(cells * cells), sine(cells);
  const RandomStream random(1, RandomPurpose::Test);
  for (std::uint64_t k = 0; k < 64; ++k) {
    const auto u = random.uniform4(k);
    const double count = 16.0 * std::pow(4.0, u[1]);
    const auto x = std::lround(count * std::cos(turn * u[0])), y = std::lround(count * std::sin(turn * u[0]));
    const double amplitude = 1.0 / std::hypot(static_cast<double>(x), static_cast<double>(y));
    const auto side = static_cast<long>(cells);
    for (long place = 0; place < side; ++place)
      sine[static_cast<std::size_t>(place)] =
          amplitude * std::sin(turn * (static_cast<double>(place) / static_cast<double>(cells) + u[2]));
    for (long row = 0; row < side; ++row)
      for (long column = 0; column < side; ++column)
        z[static_cast<std::size_t>(row * side + column)] +=
            sine[static_cast<std::size_t>((((x * column + y * row) % side) + side) % side)];
  }
  double square = 0.0;
  for (std::size_t row = 0; row < cells; ++row) {
    for (std::size_t column = 0; column < cells; ++column) {
      const double here = z[row * cells + column];
      square += std::pow(z[row * cells + (column + 1) % cells] - here, 2) +
                std::pow(z[(row + 1) % cells * cells + column] - here, 2);
    }
  }
  const double scale = gradient / std::sqrt(square / static_cast<double>(cells * cells));
  for (std::size_t k = 0; k < z.size(); ++k) field.heights_um()[k] = static_cast<float>(scale * z[k]);
  return field;
}

PathTracingOptions base(const Settings& settings, double theta_deg, const std::string& material) {
  PathTracingOptions options;
  options.incidence = {Angle::from_degrees(theta_deg), Angle::from_degrees(25.0)};
  options.grid = {settings.bins, settings.bins};
  options.material = material == "mirror" ? Material{Mirror{}} : Material{Dielectric{1.5}};
  return options;
}

/// Mean square of a map's values over the disc.
double mean_square(const DirectionGrid& grid, const DirectionMap& map, const DirectionMap* minus = nullptr) {
  const auto areas = projected_solid_angles(grid);
  double sum = 0.0;
  for (std::size_t k = 0; k < map.size(); ++k)
    sum += areas[k] * std::pow(map[k] - (minus == nullptr ? 0.0 : (*minus)[k]), 2);
  return sum / std::numbers::pi;
}

struct Reference {
  DirectionGrid grid;
  DirectionMap map, standard_error;
  double mean = 0.0, own_error = 0.0;

  /// Square of relative_rmse, the reference's own share taken out.
  [[nodiscard]] double square_error(const DirectionMap& tried) const {
    return mean_square(grid, tried, &map) / (mean * mean) - own_error * own_error;
  }
};

Reference reference(PathTracer& tracer, const Settings& settings, PathTracingOptions options,
                    const std::filesystem::path& kept) {
  options.control_variate = ControlVariate::Off;
  options.tracer = TracerKind::Embree;
  options.samples = std::uint64_t{1} << settings.reference_log2;
  options.seed = 1001;
  const bool known = !settings.cache.empty() && std::filesystem::exists(kept);
  const Bsdf bsdf = known ? read_exr(kept) : tracer.trace(options);
  if (!known && !settings.cache.empty()) write_exr(bsdf, kept);
  Reference result{options.grid, bsdf.reflection.mean, bsdf.reflection.standard_error};
  result.mean = bsdf.energy.reflected.value / std::numbers::pi;
  result.own_error = std::sqrt(mean_square(options.grid, bsdf.reflection.standard_error)) / result.mean;
  return result;
}

struct Slides {
  double seconds = 0.0;  ///< to 1 %
  double error = 0.0, samples_per_second = 0.0;
};

Slides slides_plain(PathTracer& tracer, const Settings& settings, PathTracingOptions options, const Reference& truth) {
  options.control_variate = ControlVariate::Off;
  options.tracer = TracerKind::Embree;
  options.placement = Placement::Random;
  options.roulette_first = true;
  options.samples = (std::uint64_t{1} << settings.slides_log2) / slides_runs;
  DirectionMap mean(options.grid.size(), 0.0);
  std::vector<double> times;
  for (std::uint32_t run = 0; run < slides_runs; ++run) {
    options.seed = 2001 + run;
    const double start = cpu_seconds();
    const Bsdf bsdf = tracer.trace(options);
    times.push_back(cpu_seconds() - start);
    for (std::size_t k = 0; k < mean.size(); ++k) mean[k] += bsdf.reflection.mean[k] / slides_runs;
  }
  std::nth_element(times.begin(), times.begin() + slides_runs / 2, times.end());
  const double per_run = times[slides_runs / 2], square = truth.square_error(mean);
  return {slides_runs * per_run * square / (goal * goal), std::sqrt(square),
          static_cast<double>(options.samples) / per_run};
}

struct Budget {
  int log2_samples = 0;
  double error = 0.0, seconds = 0.0, stated_error = 0.0;
  Provenance provenance;
};

Budget try_budget(PathTracer& tracer, const Settings& settings, PathTracingOptions options, const Reference& truth) {
  double square = 0.0, stated = 0.0;
  std::vector<double> times;
  Budget budget;
  for (int repeat = 0; repeat < settings.repeats; ++repeat) {
    PathTracingOptions other = options;
    other.grid = {8, 8};
    other.samples = 64;
    (void)tracer.trace(other);  // so that nothing of the last run is kept
    options.seed = static_cast<std::uint64_t>(1 + repeat);
    const double start = cpu_seconds();
    const Bsdf bsdf = tracer.trace(options);
    times.push_back(cpu_seconds() - start);
    square += truth.square_error(bsdf.reflection.mean) / settings.repeats;
    stated += mean_square(options.grid, bsdf.reflection.standard_error) / (truth.mean * truth.mean) / settings.repeats;
    budget.provenance = bsdf.provenance;
  }
  std::nth_element(times.begin(), times.begin() + settings.repeats / 2, times.end());
  budget.error = std::sqrt(std::max(square, 1e-12));
  budget.stated_error = std::sqrt(stated);
  budget.seconds = times[static_cast<std::size_t>(settings.repeats) / 2];
  return budget;
}

std::vector<Budget> budgets_to_goal(PathTracer& tracer, const Settings& settings, PathTracingOptions options,
                                    const Reference& truth) {
  options.control_variate = settings.by;
  std::vector<Budget> budgets;
  for (int bits = 11; bits <= 27 && (budgets.empty() || budgets.back().error > goal); ++bits) {
    options.samples = std::uint64_t{1} << bits;
    budgets.push_back(try_budget(tracer, settings, options, truth));
    budgets.back().log2_samples = bits;
  }
  return budgets;
}

double seconds_to_goal(const std::vector<Budget>& budgets) {
  const Budget& last = budgets.back();
  if (budgets.size() == 1 || last.error > goal) return last.seconds;
  const Budget& before = budgets[budgets.size() - 2];
  const double part = std::log(before.error / goal) / std::log(before.error / last.error);
  return before.seconds * std::pow(last.seconds / before.seconds, part);
}

// 8 batches: 7 degrees of freedom. The reference's own error is added.
double covered_share(PathTracer& tracer, const Settings& settings, PathTracingOptions options, const Reference& truth) {
  constexpr double quantile = 2.365;
  constexpr std::uint64_t runs = 200;
  options.samples = std::uint64_t{1} << settings.coverage_log2;
  options.control_variate = settings.by;
  const auto areas = projected_solid_angles(options.grid);
  double within = 0.0, all = 0.0;
  for (std::uint64_t seed = 1; seed <= runs; ++seed) {
    options.seed = seed;
    const Bsdf bsdf = tracer.trace(options);
    for (std::size_t k = 0; k < areas.size(); ++k) {
      const double share = areas[k] * truth.map[k] / (std::numbers::pi * truth.mean);
      if (share * static_cast<double>(options.samples) < 10.0) continue;
      const double error = std::hypot(bsdf.reflection.standard_error[k], truth.standard_error[k]);
      within += std::abs(bsdf.reflection.mean[k] - truth.map[k]) <= quantile * error ? 1.0 : 0.0;
      all += 1.0;
    }
  }
  return within / all;
}

nlohmann::json measure(PathTracer& tracer, const Settings& settings, double theta_deg, const std::string& material) {
  const PathTracingOptions options = base(settings, theta_deg, material);
  const auto kept = settings.cache / fmt::format("reference_{}_{}_{}_{}_{}.exr", settings.cells, settings.gradient,
                                                 material, theta_deg, settings.reference_log2);
  const Reference truth = reference(tracer, settings, options, kept);
  if (settings.coverage_log2 > 0) {
    const double share = covered_share(tracer, settings, options, truth);
    fmt::print("{:>10} {:>4.0f}° 95 % intervals hold {:.2f} %\n", material, theta_deg, 100.0 * share);
    std::fflush(stdout);
    return {{"material", material}, {"theta_deg", theta_deg}, {"covered_share", share}};
  }
  const Slides slides = slides_plain(tracer, settings, options, truth);
  const std::vector<Budget> budgets = budgets_to_goal(tracer, settings, options, truth);
  const double ours = seconds_to_goal(budgets);
  fmt::print("{:>10} {:>4.0f}° {:>11.4g} {:>11.4g} {:>9.1f} {:>9.0f} {:>8.2g} {:>8}\n", material, theta_deg,
             slides.samples_per_second / 1e6, slides.seconds, 1e3 * ours, slides.seconds / ours, truth.own_error,
             budgets.back().provenance.at("control_variate") == "none" ? "beam" : "splat");
  std::fflush(stdout);
  nlohmann::json tried = nlohmann::json::array();
  for (const Budget& budget : budgets)
    tried.push_back({{"log2_samples", budget.log2_samples},
                     {"relative_rmse", budget.error},
                     {"stated_relative_rmse", budget.stated_error},
                     {"seconds", budget.seconds}});
  return {{"material", material},
          {"theta_deg", theta_deg},
          {"slides_samples_per_second", slides.samples_per_second},
          {"slides_relative_rmse", slides.error},
          {"slides_seconds_to_1_percent", slides.seconds},
          {"seconds_to_1_percent", ours},
          {"ratio", slides.seconds / ours},
          {"reference_relative_rmse", truth.own_error},
          {"budgets", tried},
          {"provenance", budgets.back().provenance}};
}

// Pyramid and tree, built by the first path that needs them.
nlohmann::json set_up(PathTracer& tracer, const Settings& settings) {
  nlohmann::json seconds;
  for (const TracerKind kind : {TracerKind::HeightField, TracerKind::Embree}) {
    PathTracingOptions few = base(settings, 30.0, "mirror");
    few.samples = 64;
    few.tracer = kind;
    few.control_variate = ControlVariate::Off;
    const double start = cpu_seconds();
    (void)tracer.trace(few);
    seconds[kind == TracerKind::Embree ? "embree_tree_seconds" : "pyramid_seconds"] = cpu_seconds() - start;
  }
  return seconds;
}

Settings parse(int count, char** words) {
  Settings settings;
  for (int k = 1; k < count; ++k) {
    const std::string word = words[k];
    if (word == "--beam" || word == "--splat") {
      settings.by = word == "--beam" ? ControlVariate::Off : ControlVariate::On;
      continue;
    }
    require(k + 1 < count, word + " needs a value");
    const std::string value = words[++k];
    if (word == "--cells")
      settings.cells = std::stoul(value);
    else if (word == "--bins")
      settings.bins = std::stoul(value);
    else if (word == "--gradient")
      settings.gradient = std::stod(value);
    else if (word == "--theta")
      settings.thetas_deg = {std::stod(value)};
    else if (word == "--material")
      settings.materials = {value};
    else if (word == "--slides")
      settings.slides_log2 = std::stoi(value);
    else if (word == "--reference")
      settings.reference_log2 = std::stoi(value);
    else if (word == "--repeats")
      settings.repeats = std::stoi(value);
    else if (word == "--coverage")
      settings.coverage_log2 = std::stoi(value);
    else if (word == "--cache")
      settings.cache = value;
    else if (word == "--json")
      settings.json = value;
    else
      require(false, "unknown option " + word);
  }
  return settings;
}

void run(const Settings& settings) {
  const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
  const HeightField field = random_waves(settings.cells, settings.gradient);
  PathTracer tracer(field);
  nlohmann::json report = {{"cells", settings.cells},       {"bins", settings.bins},
                           {"gradient", settings.gradient}, {"slides_log2_samples", settings.slides_log2},
                           {"repeats", settings.repeats},   {"set_up", set_up(tracer, settings)}};
  fmt::print("set up: {}\n", report["set_up"].dump());
  fmt::print("{:>10} {:>5} {:>11} {:>11} {:>9} {:>9} {:>8} {:>8}\n", "material", "theta", "slides M/s", "slides s",
             "ours ms", "ratio", "ref.", "by");
  for (const std::string& material : settings.materials)
    for (const double theta : settings.thetas_deg)
      report["cells_of_table"].push_back(measure(tracer, settings, theta, material));
  if (!settings.json.empty()) std::ofstream(settings.json) << report.dump(2) << '\n';
}

}  // namespace

int main(int count, char** words) {
  try {
    run(parse(count, words));
    return 0;
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 1;
  }
}
