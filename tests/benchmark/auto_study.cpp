// Does `auto` keep its tolerance, and is it worth its time? 60 scenes drawn at random from all families of reliefs,
// gradients, incidences and materials, at 5 % and at 1 %.
//
//   auto_study [SCENES [FIRST]]
//
// True error: relative_l2 of the reflection to a long run of `paths` on the same relief with another seed, corrected
// for the noise of both by independent halves. Time: CPU time of one thread, median of five where it is short.
// The criterion: within tolerance in 95 % of the scenes; time at most 1.5 times that of the cheapest rung that would
// have met it (median), and never above 4 times + 50 ms.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <functional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <tbb/global_control.h>

#include "experiments/study/scene.h"
#include "forward/base/random.h"
#include "forward/ladder/ladder.h"

namespace {

using namespace mezzotint;

struct Scene {
  StudyRelief relief;
  LadderOptions options;
};

const std::vector<Material>& materials() {
  static const std::vector<Material> list = {Dielectric{1.33}, Dielectric{1.5},     Dielectric{2.0},
                                             Mirror{},         Conductor{0.2, 3.0}, Dielectric{1.5, 0.02}};
  return list;
}

Scene draw_scene(std::uint64_t number) {
  const RandomStream random(2026, RandomPurpose::Test);
  const auto u = random.uniform4(number, 0), v = random.uniform4(number, 1);
  const auto& families = relief_families();
  const ReliefDraw draw{.cells = v[0] < 0.5 ? std::size_t{256} : std::size_t{512},
                        .seed = number,
                        .periods = std::round(8.0 + 16.0 * v[1]),
                        .skew = 0.05 + 0.4 * v[2]};
  const double gradient = 0.03 * std::pow(1.0 / 0.03, u[0]);
  Scene scene{make_study_relief(families[number % families.size()], gradient, draw), {}};
  scene.options.incidence = {Angle::from_degrees(85.0 * u[1]), Angle::from_degrees(360.0 * u[2])};
  scene.options.grid = {64, 64};
  scene.options.material = materials()[static_cast<std::size_t>(u[3] * static_cast<double>(materials().size()))];
  scene.options.seed = number + 1;
  return scene;
}

PathTracingOptions tracing_of(const LadderOptions& options) {
  return {.incidence = options.incidence,
          .grid = options.grid,
          .material = options.material,
          .samples = options.most_samples,
          .tolerance = options.tolerance,
          .seed = options.seed};
}

double cpu_seconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// A way to a map, and what it gave and took.
struct Candidate {
  std::string name;
  std::function<Bsdf()> run;
  Bsdf bsdf{};
  std::vector<double> times{};

  [[nodiscard]] double seconds() const {
    std::vector<double> sorted = times;
    std::sort(sorted.begin(), sorted.end());
    return sorted[sorted.size() / 2];
  }
};

// In turn, so that a machine that is busy for a while is so for all.
void measure(PathTracer& tracer, const LadderOptions& options, bool has_splat, std::vector<Candidate>& candidates) {
  for (int round = 0; round < 5; ++round) {
    for (Candidate& candidate : candidates) {
      if (round > 0 && candidate.times.front() > 0.3) continue;
      PathTracingOptions other = tracing_of(options);  // the splat of the run before is not kept
      other.grid = {8, 8};
      other.samples = 64;
      if (has_splat) (void)tracer.splat(other);
      (void)tracer.trace(other);  // nor its plan
      const double start = cpu_seconds();
      candidate.bsdf = candidate.run();
      candidate.times.push_back(cpu_seconds() - start);
    }
  }
}

// f is independent of the reference: their seeds differ.
double error_of(const Bsdf& f, const Bsdf& reference) {
  return relative_l2(f.grid, f.reflection, reference.reflection).corrected.value;
}
double error_with_own_noise(const Bsdf& f, const Bsdf& reference) {
  const double square = std::pow(relative_l2(f.grid, f.reflection.mean, reference.reflection.mean), 2.0) -
                        std::pow(relative_error(f.grid, reference.reflection), 2.0);
  return std::sqrt(std::max(0.0, square));
}

struct Result {
  bool met = false, met_with_noise = false;
  double ratio = 0.0, excess = 0.0;  ///< time over that of the cheapest; time − (4 × + 50 ms)
};

Result study(const Scene& scene, PathTracer& tracer, const Bsdf& reference, const LadderOptions& options) {
  const PathTracingOptions tracing = tracing_of(options);
  const HeightField& field = scene.relief.field;
  const auto* clear = std::get_if<Dielectric>(&options.material);
  const bool has_splat = field.periodic() && (clear == nullptr || clear->absorption_per_um == 0.0);
  std::vector<Candidate> candidates = {{"auto", [&] { return simulate_auto(field, tracer, options); }},
                                       {"moments", [&] { return bsdf_from_moments(field, options); }},
                                       {"paths", [&] { return tracer.trace(tracing); }}};
  if (has_splat) candidates.push_back({"slopes", [&] { return tracer.splat(tracing); }});
  measure(tracer, options, has_splat, candidates);
  const Candidate* cheapest = nullptr;
  std::string errors;
  for (std::size_t k = 1; k < candidates.size(); ++k) {
    const Candidate& rung = candidates[k];
    const double error = error_of(rung.bsdf, reference);
    errors += fmt::format(" {} {:.4f} in {:.2f} ms,", rung.name, error, 1e3 * rung.seconds());
    // `paths` always meets its tolerance: it runs until it does.
    const bool meets = rung.name == "paths" || error <= options.tolerance;
    if (meets && (cheapest == nullptr || rung.seconds() < cheapest->seconds())) cheapest = &rung;
  }
  const Candidate& chosen = candidates.front();
  const double error = error_of(chosen.bsdf, reference), noisy = error_with_own_noise(chosen.bsdf, reference);
  const Result result{error <= options.tolerance, noisy <= options.tolerance, chosen.seconds() / cheapest->seconds(),
                      chosen.seconds() - (4.0 * cheapest->seconds() + 0.05)};
  fmt::print(
      "  {:2.0f} %: {:7} error {:.4f} (with its noise {:.4f}) in {:.2f} ms, {:.2f} of {}'s;{} predicted {}{}{}\n",
      100.0 * options.tolerance, chosen.bsdf.provenance.at("model"), error, noisy, 1e3 * chosen.seconds(), result.ratio,
      cheapest->name, errors, chosen.bsdf.provenance.at("predicted_error"), result.met ? "" : " MISSED",
      result.excess > 0.0 ? " SLOW" : "");
  std::fflush(stdout);
  return result;
}

void summarise(double tolerance, const std::vector<Result>& results) {
  const auto count = [&](auto is) { return std::count_if(results.begin(), results.end(), is); };
  std::vector<double> ratios;
  double worst = -INFINITY;
  for (const Result& result : results) {
    ratios.push_back(result.ratio);
    worst = std::max(worst, result.excess);
  }
  std::sort(ratios.begin(), ratios.end());
  fmt::print(
      "tolerance {} %: {} of {} within ({} with their own noise); time over the cheapest rung's: median {:.2f}, worst "
      "{:.2f}; {} above 4 × + 50 ms (largest excess {:.1f} ms)\n",
      100.0 * tolerance, count([](const Result& r) { return r.met; }), results.size(),
      count([](const Result& r) { return r.met_with_noise; }), ratios[ratios.size() / 2], ratios.back(),
      count([](const Result& r) { return r.excess > 0.0; }), 1e3 * worst);
}

}  // namespace

int main(int count, char** words) {
  const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
  const std::uint64_t scenes = count > 1 ? std::strtoull(words[1], nullptr, 10) : 60;
  const std::uint64_t first = count > 2 ? std::strtoull(words[2], nullptr, 10) : 0;
  const std::vector<double> tolerances = {0.05, 0.01};
  std::vector<std::vector<Result>> results(tolerances.size());
  for (std::uint64_t number = first; number < first + scenes; ++number) {
    Scene scene = draw_scene(number);
    PathTracer tracer(scene.relief.field);
    PathTracingOptions precise = tracing_of(scene.options);
    precise.tolerance = 0.003;
    precise.samples = std::uint64_t{1} << 24;
    precise.seed += 1000000;
    const Bsdf reference = tracer.trace(precise);
    fmt::print("{:2} {} {}², s = {:.3f}, {:.1f}°, {}: reference ± {:.4f}\n", number, scene.relief.family,
               scene.relief.field.columns(), scene.relief.gradient, scene.options.incidence.theta.degrees(),
               to_string(scene.options.material), relative_error(reference.grid, reference.reflection));
    for (std::size_t k = 0; k < tolerances.size(); ++k) {
      LadderOptions options = scene.options;
      options.tolerance = tolerances[k];
      results[k].push_back(study(scene, tracer, reference, options));
    }
  }
  for (std::size_t k = 0; k < tolerances.size(); ++k) summarise(tolerances[k], results[k]);
}
