#include "experiments/study/study.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <memory>
#include <numeric>
#include <utility>

#include <fmt/format.h>
#include <tbb/global_control.h>

#include "experiments/study/repeated_runs.h"
#include "experiments/study/study_methods.h"
#include "forward/ladder/ladder.h"

namespace mezzotint {

namespace {

// The reference has a seed of its own.
constexpr std::uint64_t reference_seed = 1000;
// A run is repeated until it has taken so long, at most so many times.
constexpr double seconds_of_runs = 0.1;
constexpr int most_runs = 5;

/// What runs are compared with.
struct Reference {
  MapEstimate map;
  double floor = 0.0;
};

// The noise of the corrected square where there is no difference: products of two halves' noise, of variance 4 σ⁴ each.
Reference reference_of(const Bsdf& bsdf) {
  const std::vector<double> areas = projected_solid_angles(bsdf.grid);
  double noise = 0.0, power = 0.0;
  for (std::size_t bin = 0; bin < areas.size(); ++bin) {
    noise += 4.0 * areas[bin] * areas[bin] * std::pow(bsdf.reflection.standard_error[bin], 4.0);
    power += areas[bin] * bsdf.reflection.mean[bin] * bsdf.reflection.mean[bin];
  }
  return {bsdf.reflection, std::sqrt(std::sqrt(noise) / power)};
}

/// Errors and times of the runs of one point.
class Runs {
public:
  Runs(const DirectionGrid& grid, const Reference& reference) : grid_(grid), reference_(reference) {}

  void add(const Bsdf& bsdf, double seconds) {
    seconds_.push_back(seconds);
    const DirectionMap& mean = bsdf.reflection.mean;
    const MapEstimate exact{mean, DirectionMap(mean.size(), 0.0), mean, mean};
    with_noise_.push_back(relative_l2(grid_, exact, reference_.map).corrected);
    without_.push_back(relative_l2(grid_, bsdf.reflection, reference_.map).corrected);
  }
  [[nodiscard]] bool enough() const {
    return std::accumulate(seconds_.begin(), seconds_.end(), 0.0) >= seconds_of_runs ||
           seconds_.size() >= static_cast<std::size_t>(most_runs);
  }
  [[nodiscard]] std::size_t count() const { return seconds_.size(); }

  void write(StudyPoint& point) const {
    const Estimate time = median_of(seconds_), error = root_mean_square(with_noise_), bias = root_mean_square(without_);
    point.runs = static_cast<int>(seconds_.size());
    point.seconds = time.value;
    point.seconds_error = time.standard_error;
    point.error = error.value;
    point.error_spread = error.standard_error;
    point.bias = bias.value;
    point.bias_error = bias.standard_error;
    point.floor = reference_.floor;
  }

private:
  // The runs share the reference, so that its part of the error does not average out.
  static Estimate root_mean_square(const std::vector<Estimate>& errors) {
    std::vector<double> squares;
    double shared = 0.0;
    for (const Estimate& error : errors) {
      squares.push_back(error.value * error.value);
      shared += error.standard_error / static_cast<double>(errors.size());
    }
    const double root = std::sqrt(mean_of(squares));
    const double scatter = root > 0.0 ? error_of_mean(squares) / (2.0 * root) : 0.0;
    return {root, std::hypot(scatter, shared)};
  }

  const DirectionGrid& grid_;
  const Reference& reference_;
  std::vector<double> seconds_;
  std::vector<Estimate> with_noise_, without_;
};

/// One relief, all directions of the light.
class ReliefStudy {
public:
  ReliefStudy(const StudyOptions& options, StudyRelief relief) : options_(options), relief_(std::move(relief)) {
    for (const std::size_t step : {1, 2, 4})
      tracers_[step] = std::make_unique<PathTracer>(step == 1 ? relief_.field : coarser(relief_.field, step));
  }

  void add(double theta_deg, std::vector<StudyPoint>& points) {
    theta_deg_ = theta_deg;
    warm_up();
    PathTracingOptions tracing = base(options_.seed + reference_seed);
    tracing.samples = options_.reference_samples;
    reference_ = reference_of(tracers_.at(1)->trace(tracing));
    add_rungs(points);
    for (const PathMethod& method : path_methods()) {
      if (method.needs_splat && !splat_is_possible()) continue;
      for (const int bits : method.log2_samples) {
        const std::uint64_t samples = std::uint64_t{1} << bits;
        if (samples <= options_.most_samples) points.push_back(traced(method, samples));
      }
    }
  }

private:
  [[nodiscard]] PathTracingOptions base(std::uint64_t seed) const {
    PathTracingOptions tracing;
    tracing.incidence = {Angle::from_degrees(theta_deg_), Angle::from_degrees(25.0)};
    tracing.grid = {options_.resolution, options_.resolution};
    tracing.material = options_.material;
    tracing.seed = seed;
    return tracing;
  }

  [[nodiscard]] bool splat_is_possible() const {
    const auto* clear = std::get_if<Dielectric>(&options_.material);
    return relief_.field.periodic() && (clear == nullptr || clear->absorption_per_um == 0.0);
  }

  // Trees, pyramids and normals are built by the first run that needs them.
  void warm_up() {
    for (const auto& [step, tracer] : tracers_) {
      for (const TracerKind kind : {TracerKind::HeightField, TracerKind::Embree}) {
        if (kind == TracerKind::Embree && step > 1) continue;
        PathTracingOptions few = base(1);
        few.samples = 64;
        few.tracer = kind;
        few.control_variate = ControlVariate::Off;
        few.normals = step == 1 ? NormalKind::Interpolated : NormalKind::Geometric;
        (void)tracer->trace(few);
      }
    }
  }

  // Each run makes its own splat.
  void forget_splats() {
    if (!splat_is_possible()) return;
    PathTracingOptions other = base(1);
    other.grid = {8, 8};
    other.samples = 64;
    for (const auto& [step, tracer] : tracers_) {
      (void)tracer->splat(other);
      (void)tracer->trace(other);  // and its plan
    }
  }

  void measure(StudyPoint& point, const std::function<Bsdf(std::uint64_t)>& run) {
    const DirectionGrid grid{options_.resolution, options_.resolution};
    Runs runs(grid, reference_);
    while (!runs.enough()) {
      forget_splats();
      const double start = cpu_seconds();
      const Bsdf bsdf = run(options_.seed + runs.count());
      runs.add(bsdf, cpu_seconds() - start);
      if (point.tolerance) point.chosen = bsdf.provenance.at("model");
    }
    runs.write(point);
  }

  [[nodiscard]] StudyPoint named(const std::string& method, std::uint64_t samples = 0) const {
    return {{method, samples}, {relief_.family, relief_.gradient, theta_deg_}};
  }

  StudyPoint traced(const PathMethod& method, std::uint64_t samples) {
    StudyPoint point = named(method.name, samples);
    measure(point, [&](std::uint64_t seed) {
      PathTracingOptions tracing = base(seed);
      tracing.samples = samples;
      method.set(tracing);
      return tracers_.at(method.coarsening)->trace(tracing);
    });
    return point;
  }

  void add_rungs(std::vector<StudyPoint>& points) {
    const PathTracingOptions tracing = base(options_.seed);
    LadderOptions ladder{.incidence = tracing.incidence, .grid = tracing.grid, .material = tracing.material};
    points.push_back(named(moments_method));
    measure(points.back(), [&](std::uint64_t) { return bsdf_from_moments(relief_.field, ladder); });
    if (splat_is_possible()) {
      points.push_back(named(slopes_method));
      measure(points.back(), [&](std::uint64_t) { return tracers_.at(1)->splat(tracing); });
    }
    for (const double tolerance : options_.auto_tolerances) {
      points.push_back(named(auto_method));
      points.back().tolerance = ladder.tolerance = tolerance;
      measure(points.back(), [&](std::uint64_t seed) {
        ladder.seed = seed;
        return simulate_auto(relief_.field, *tracers_.at(1), ladder);
      });
    }
  }

  const StudyOptions& options_;
  StudyRelief relief_;
  std::map<std::size_t, std::unique_ptr<PathTracer>> tracers_;  ///< by the mesh's coarsening
  double theta_deg_ = 0.0;
  Reference reference_;
};

/// The reliefs of a study, made one at a time.
struct ReliefMaker {
  std::string family;
  double gradient;
  std::function<StudyRelief()> make;
};

std::vector<ReliefMaker> reliefs_of(const StudyOptions& options) {
  std::vector<ReliefMaker> list;
  for (const std::string& family : options.families) {
    for (const double gradient : options.gradients) {
      list.push_back(
          {family, gradient, [=, &options] { return make_study_relief(family, gradient, {.cells = options.cells}); }});
    }
  }
  if (options.scan) list.push_back({options.scan->family, options.scan->gradient, [&] { return *options.scan; }});
  return list;
}

}  // namespace

std::vector<StudyScene> scenes_of(const StudyOptions& options) {
  std::vector<StudyScene> scenes;
  for (const ReliefMaker& relief : reliefs_of(options))
    for (const double theta : options.thetas_deg) scenes.push_back({relief.family, relief.gradient, theta});
  return scenes;
}

std::vector<StudyPoint> run_study(const StudyOptions& options, const Progress& progress) {
  const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
  std::vector<StudyPoint> points;
  const auto total = static_cast<double>(scenes_of(options).size());
  double done = 0.0;
  for (const ReliefMaker& relief : reliefs_of(options)) {
    ReliefStudy study(options, relief.make());
    for (const double theta : options.thetas_deg) {
      report(progress, "chart", done / total,
             fmt::format("{}, s = {:.3g}, {}°", relief.family, relief.gradient, theta));
      study.add(theta, points);
      done += 1.0;
    }
  }
  mark_pareto_front(points);
  return points;
}

void mark_pareto_front(std::vector<StudyPoint>& points) {
  for (StudyPoint& point : points) {
    // `auto` is drawn on the front, it is no part of it.
    point.on_front = point.method != auto_method && std::ranges::none_of(points, [&](const StudyPoint& other) {
                       return other.method != auto_method && point.scene == other.scene && beats(other, point);
                     });
  }
}

std::vector<ChartPoint> chart_points(const std::vector<StudyPoint>& points) { return {points.begin(), points.end()}; }

namespace {

nlohmann::json row_of(const StudyPoint& point) {
  nlohmann::json row = {{"relief", point.scene.relief},
                        {"rms_gradient", point.scene.gradient},
                        {"theta_deg", point.scene.theta_deg},
                        {"method", point.method},
                        {"samples", point.samples},
                        {"runs", point.runs},
                        {"seconds", point.seconds},
                        {"seconds_standard_error", point.seconds_error},
                        {"relative_l2", point.error},
                        {"relative_l2_standard_error", point.error_spread},
                        {"bias", point.bias},
                        {"bias_standard_error", point.bias_error},
                        {"smallest_error_told", point.floor},
                        {"on_front", point.on_front}};
  if (point.tolerance) row["tolerance"] = *point.tolerance;
  if (!point.chosen.empty()) row["chosen"] = point.chosen;
  return row;
}

}  // namespace

nlohmann::json to_json(const StudyOptions& options, const std::vector<StudyPoint>& points) {
  nlohmann::json rows = nlohmann::json::array();
  for (const StudyPoint& point : points) rows.push_back(row_of(point));
  return {{"cells", options.cells},
          {"resolution", options.resolution},
          {"material", to_string(options.material)},
          {"reference_samples", options.reference_samples},
          {"points", rows}};
}

}  // namespace mezzotint
