#include "race_methods.h"

#include <chrono>
#include <cmath>
#include <set>
#include <sstream>

#include "forward/base/error.h"
#include "forward/scattering/path_tracing.h"
#include "inverse/design/design.h"
#include "inverse/design/moments_start.h"
#include "measure.h"

namespace mezzotint::benchmark {

namespace {

std::string word(const RaceMethod& method, const std::string& name, const std::string& otherwise) {
  const auto found = method.words.find(name);
  return found == method.words.end() ? otherwise : found->second;
}

double number(const RaceMethod& method, const std::string& name, double otherwise) {
  const auto found = method.words.find(name);
  return found == method.words.end() ? otherwise : std::stod(found->second);
}

MeasureSum objective_of(const RaceMethod& method, const std::string& otherwise) {
  MeasureSum sum;
  std::istringstream names(word(method, "objective", otherwise));
  for (std::string name; std::getline(names, name, '+');) sum.push_back({measure_named(name), 1.0});
  return sum;
}

// The target is set from the lobes by DesignGoal; any valid one does.
DesignGoal goal_of(const LobeTarget& lobes) { return {beckmann_target({0.2, 0.1, {}}), lobes, true}; }

std::vector<Variable> variables_of(const Family& family, const DesignGoal& goal, const PrinterProfile& printer,
                                   const PatchOptions& patch) {
  return design_variables(family.pattern, family.free, goal.target(), printer, patch.wavelength);
}

// ---- the plain loop

void to_the_centre(std::vector<Variable>& variables) {
  for (Variable& v : variables) v.start = v.logarithmic ? std::sqrt(v.low * v.high) : 0.5 * (v.low + v.high);
}

void to_the_closed_form(std::vector<Variable>& variables, const Family& family, const DesignGoal& goal,
                        const PrinterProfile& printer, const PatchOptions& patch) {
  const MomentsModel moments(family.pattern, variables, printer, patch.wavelength);
  if (!moments.exists()) return;
  std::vector<double> start;
  for (const Variable& variable : variables) start.push_back(variable.start);
  const std::vector<double> values = moments.solve(goal.target(), start);
  for (std::size_t i = 0; i < values.size(); ++i) variables[i].start = values[i];
}

PathTracingOptions tracing_of(const RaceMethod& method) {
  PathTracingOptions options;
  const std::string tracer = word(method, "tracer", "embree");
  if (tracer == "own") return options;
  require(tracer == "embree" || tracer == "roulette", "tracer: embree, roulette or own");
  options.tracer = TracerKind::Embree;
  options.placement = Placement::Random;
  options.control_variate = ControlVariate::Off;
  options.roulette_first = tracer == "roulette";
  return options;
}

RaceResult plain_loop(const RaceMethod& method, const Family& family, const LobeTarget& lobes, std::uint64_t seed) {
  const PrinterProfile printer;
  const PatchOptions patch{.pixels = family.pixels, .subsamples = 4};
  const DesignGoal goal = goal_of(lobes);
  std::vector<Variable> variables = variables_of(family, goal, printer, patch);
  if (word(method, "start", "centre") == "closed")
    to_the_closed_form(variables, family, goal, printer, patch);
  else
    to_the_centre(variables);
  const MeasureSum sum = objective_of(method, "cube_root");
  PathTracingOptions tracing = tracing_of(method);
  tracing.grid = lobes.grid.grid();
  tracing.material = lobes.material;
  tracing.samples =
      static_cast<std::uint64_t>(number(method, "rays", 1e5) / static_cast<double>(lobes.incidences.size()));
  const std::vector<GroundOctave> ground = split_ground(printer, patch.wavelength).geometric;

  std::uint64_t fresh = 700000 + 10000 * seed;
  const auto measure = [&](const std::vector<double>& values) {
    tracing.seed = ++fresh;
    const Pattern pattern = with_values(family.pattern, variables, values);
    const GrayImage gray = expose(pixel_heights(draw_instance(pattern, fresh), printer, patch.pixels), printer).image;
    HeightField relief = print_layer(gray, printer, {patch.subsamples, Surround::Mirror});
    add_ground(relief, printer, ground, fresh);
    PathTracer tracer(relief);
    SlopeModel::Shown shown;
    for (const DirectionAngles& incidence : lobes.incidences) {
      tracing.incidence = incidence;
      shown.maps.push_back(lobes.grid.softened(tracer.trace(tracing).reflection.mean));
    }
    return goal.distance(sum, shown);
  };
  MinimizeOptions options;
  options.algorithm = word(method, "algorithm", "LN_BOBYQA");
  options.max_evaluations = static_cast<int>(number(method, "cap", 200));
  options.seed = seed;
  const MinimizeResult found = minimize(variables, measure, options);
  return {with_values(family.pattern, variables, found.best.values), static_cast<double>(found.evaluations)};
}

// ---- the ladder

RaceResult ladder(const RaceMethod& method, const Family& family, const LobeTarget& lobes, std::uint64_t seed) {
  DesignProblem problem;
  problem.pattern = family.pattern;
  problem.free = family.free;
  problem.patch = {.pixels = static_cast<std::size_t>(number(method, "pixels", static_cast<double>(family.pixels))),
                   .subsamples = static_cast<std::size_t>(number(method, "subsamples", 3))};
  problem.search_draws = static_cast<std::size_t>(number(method, "draws", static_cast<double>(family.draws)));
  problem.search.seed = seed;
  const DesignGoal goal = goal_of(lobes);
  problem.target = goal.target();
  SearchPlan plan;
  plan.search = problem.search;
  plan.search.algorithm = word(method, "algorithm", plan.search.algorithm);
  plan.search.max_evaluations = static_cast<int>(number(method, "cap", 300));
  plan.objective = objective_of(method, method.name == "moments" ? "slope_covariance" : "");
  plan.seeds = search_seeds(problem);
  plan.coarse_draws = static_cast<std::size_t>(number(method, "coarse", static_cast<double>(plan.coarse_draws)));
  plan.scanned = static_cast<std::size_t>(number(method, "scanned", static_cast<double>(plan.scanned)));
  plan.starts = static_cast<std::size_t>(number(method, "starts", static_cast<double>(plan.starts)));
  TracedPlan traced;
  traced.corrections = static_cast<int>(number(method, "corrections", traced.corrections));
  traced.evaluations = static_cast<int>(number(method, "evaluations", traced.evaluations));
  traced.draws = static_cast<std::size_t>(number(method, "traced_draws", static_cast<double>(traced.draws)));
  traced.samples = std::uint64_t{1} << static_cast<int>(
                       number(method, "log2_paths", std::log2(static_cast<double>(traced.samples))));
  if (method.name == "moments") traced = {.corrections = 0, .evaluations = 0};
  const std::vector<Variable> variables = search_variables(problem);
  SearchOutcome found = search_pattern(goal, family.pattern, variables, problem.printer, problem.patch, plan, nullptr);
  polish_traced(goal, family.pattern, variables, problem.printer, problem.patch, plan, traced, nullptr, found);
  return {with_values(family.pattern, variables, found.values), found.cost};
}

const std::map<std::string, std::set<std::string>>& known_words() {
  static const std::map<std::string, std::set<std::string>> all = {
      {"plain", {"algorithm", "objective", "rays", "start", "tracer", "cap"}},
      {"ladder",
       {"algorithm", "objective", "cap", "scanned", "starts", "coarse", "draws", "pixels", "subsamples", "corrections",
        "evaluations", "traced_draws", "log2_paths"}},
      {"moments", {"draws", "pixels", "subsamples"}},
      {"truth", {}}};
  return all;
}

}  // namespace

RaceMethod race_method(const std::string& text) {
  std::istringstream parts(text);
  RaceMethod method;
  std::getline(parts, method.name, ':');
  const auto known = known_words().find(method.name);
  require(known != known_words().end(), method.name + ": a method is plain, ladder, moments or truth");
  for (std::string part; std::getline(parts, part, ':');) {
    const std::size_t equals = std::min(part.find('='), part.size());
    const std::string name = part.substr(0, equals);
    require(known->second.contains(name), method.name + " has no " + name);
    method.words[name] = part.substr(std::min(equals + 1, part.size()));
  }
  return method;
}

RaceResult race(const RaceMethod& method, const Family& family, const LobeTarget& goal, const Pattern& truth,
                std::uint64_t seed) {
  if (method.name == "truth") return {truth};
  const auto wall = std::chrono::steady_clock::now();
  const double cpu = process_seconds();
  RaceResult result =
      method.name == "plain" ? plain_loop(method, family, goal, seed) : ladder(method, family, goal, seed);
  result.cpu_seconds = process_seconds() - cpu;
  result.wall_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - wall).count();
  return result;
}

}  // namespace mezzotint::benchmark
