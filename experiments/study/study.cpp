#include "experiments/study/study.h"

#include <ctime>
#include <functional>
#include <optional>

#include <fmt/format.h>
#include <tbb/global_control.h>

#include "experiments/study/scene.h"
#include "forward/base/error.h"
#include "forward/ladder/ladder.h"
#include "forward/scattering/path_tracing.h"

namespace mezzotint {

namespace {

double cpu_seconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

struct Method {
  std::string name;
  std::vector<int> log2_samples;  ///< budgets
  std::function<void(PathTracingOptions&)> set;
  bool coarse = false;  ///< on every second sample
};

// The first is the slides' plain method, with the weight that conserves energy (with its own it converges to a wrong
// map).
std::vector<Method> path_methods() {
  using Options = PathTracingOptions;
  const std::vector<int> slow = {12, 14, 16, 18}, fast = {12, 14, 16, 18, 20};
  const auto beam = [](Options& o) { o.control_variate = ControlVariate::Off; };
  return {
      {"slides plain", slow,
       [=](Options& o) {
         beam(o);
         o.tracer = TracerKind::Embree;
         o.placement = Placement::Random;
         o.roulette_first = true;
       }},
      {"paths, Embree", slow,
       [=](Options& o) {
         beam(o);
         o.tracer = TracerKind::Embree;
       }},
      {"paths, random positions", fast,
       [=](Options& o) {
         beam(o);
         o.placement = Placement::Random;
       }},
      {"paths, lattice", fast,
       [=](Options& o) {
         beam(o);
         o.placement = Placement::Lattice;
       }},
      {"paths, strata", fast, beam},
      {"paths, strata, interpolated normals", slow,
       [=](Options& o) {
         beam(o);
         o.normals = NormalKind::Interpolated;
       }},
      {"paths, splat corrected", fast, [](Options& o) { o.control_variate = ControlVariate::On; }},
      {"paths, splat corrected, 2 bounces", fast,
       [](Options& o) {
         o.control_variate = ControlVariate::On;
         o.max_bounces = 2;
       }},
      {"paths, splat corrected, mesh halved", fast, [](Options& o) { o.control_variate = ControlVariate::On; }, true},
      {"single", fast,
       [](Options& o) {
         o.control_variate = ControlVariate::On;
         o.max_bounces = 1;
       }},
  };
}

/// One relief, all directions of the light.
class ReliefStudy {
public:
  ReliefStudy(const StudyOptions& options, StudyRelief relief)
      : options_(options),
        relief_(std::move(relief)),
        coarse_(coarser(relief_.field)),
        tracer_(relief_.field),
        coarse_tracer_(coarse_) {}

  void add(double theta_deg, std::vector<StudyPoint>& points) {
    theta_deg_ = theta_deg;
    PathTracingOptions tracing = base();
    warm_up();
    tracing.samples = std::uint64_t{1} << 22;
    tracing.seed = options_.seed + 1000;
    const Bsdf reference = tracer_.trace(tracing);
    reference_ = reference.reflection.mean;
    floor_ = relative_error(tracing.grid, reference.reflection);
    add_rungs(points);
    for (const Method& method : path_methods()) {
      for (const int bits : method.log2_samples) {
        PathTracingOptions wanted = base();
        wanted.samples = std::uint64_t{1} << bits;
        method.set(wanted);
        PathTracer& tracer = method.coarse ? coarse_tracer_ : tracer_;
        points.push_back(measure(method.name, wanted.samples, [&] { return tracer.trace(wanted); }));
      }
    }
  }

private:
  [[nodiscard]] PathTracingOptions base() const {
    PathTracingOptions tracing;
    tracing.incidence = {Angle::from_degrees(theta_deg_), Angle::from_degrees(25.0)};
    tracing.grid = {options_.resolution, options_.resolution};
    tracing.material = options_.material;
    tracing.seed = options_.seed;
    return tracing;
  }

  // Trees, pyramids and normals are built by the first run that needs them; and the splat of another run is not kept.
  void warm_up() {
    for (PathTracer* tracer : {&tracer_, &coarse_tracer_}) {
      for (const TracerKind kind : {TracerKind::HeightField, TracerKind::Embree}) {
        PathTracingOptions few = base();
        few.samples = 64;
        few.tracer = kind;
        few.control_variate = ControlVariate::Off;
        few.normals = NormalKind::Interpolated;
        (void)tracer->trace(few);
      }
    }
  }

  void forget_splat() {
    PathTracingOptions other = base();
    other.grid = {8, 8};
    (void)tracer_.splat(other);
    (void)coarse_tracer_.splat(other);
  }

  StudyPoint measure(const std::string& method, std::uint64_t samples, const std::function<Bsdf()>& run) {
    forget_splat();
    const double start = cpu_seconds();
    const Bsdf bsdf = run();
    StudyPoint point{relief_.family, relief_.gradient, theta_deg_, method, samples, cpu_seconds() - start};
    point.error = relative_l2(bsdf.grid, bsdf.reflection.mean, reference_);
    point.floor = floor_;
    return point;
  }

  void add_rungs(std::vector<StudyPoint>& points) {
    const PathTracingOptions tracing = base();
    LadderOptions ladder{.incidence = tracing.incidence, .grid = tracing.grid, .material = tracing.material};
    ladder.tolerance = options_.auto_tolerance;
    ladder.seed = options_.seed;
    points.push_back(measure("moments", 0, [&] { return bsdf_from_moments(relief_.field, ladder); }));
    points.push_back(measure("slopes", 0, [&] { return tracer_.splat(tracing); }));
    points.push_back(measure("auto", 0, [&] { return simulate_auto(relief_.field, tracer_, ladder); }));
  }

  const StudyOptions& options_;
  StudyRelief relief_;
  HeightField coarse_;
  PathTracer tracer_, coarse_tracer_;
  double theta_deg_ = 0.0;
  DirectionMap reference_;
  double floor_ = 0.0;
};

bool same_scene(const StudyPoint& a, const StudyPoint& b) {
  return a.relief == b.relief && a.gradient == b.gradient && a.theta_deg == b.theta_deg;
}

}  // namespace

std::vector<StudyPoint> run_study(const StudyOptions& options, const Progress& progress) {
  const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
  std::vector<StudyPoint> points;
  const auto total =
      static_cast<double>(study_families().size() * options.gradients.size() * options.thetas_deg.size());
  double done = 0.0;
  for (const std::string& family : study_families()) {
    for (const double gradient : options.gradients) {
      ReliefStudy study(options, make_study_relief(family, gradient, options.cells));
      for (const double theta : options.thetas_deg) {
        report(progress, "chart", done / total, fmt::format("{}, s = {}, {}°", family, gradient, theta));
        study.add(theta, points);
        done += 1.0;
      }
    }
  }
  mark_pareto_front(points);
  return points;
}

void mark_pareto_front(std::vector<StudyPoint>& points) {
  for (StudyPoint& point : points) {
    // `auto` is drawn on the front, it is no part of it.
    point.on_front = point.method != "auto";
    for (const StudyPoint& other : points) {
      if (other.method == "auto" || !same_scene(point, other)) continue;
      const bool better = other.error < point.error && other.seconds <= point.seconds;
      if (better || (other.error == point.error && other.seconds < point.seconds)) point.on_front = false;
    }
  }
}

nlohmann::json to_json(const StudyOptions& options, const std::vector<StudyPoint>& points) {
  nlohmann::json rows = nlohmann::json::array();
  for (const StudyPoint& point : points) {
    rows.push_back({{"relief", point.relief},
                    {"rms_gradient", point.gradient},
                    {"theta_deg", point.theta_deg},
                    {"method", point.method},
                    {"samples", point.samples},
                    {"seconds", point.seconds},
                    {"relative_l2", point.error},
                    {"reference_error", point.floor},
                    {"on_front", point.on_front}});
  }
  return {{"cells", options.cells},
          {"resolution", options.resolution},
          {"material", to_string(options.material)},
          {"auto_tolerance", options.auto_tolerance},
          {"points", rows}};
}

}  // namespace mezzotint
