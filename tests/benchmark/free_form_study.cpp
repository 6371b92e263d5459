// What freedom at every pixel is worth: a free form against a parametric search with a fixed, seeded budget, on lobes
// that patterns can hardly have; both verified alike: printed with the printer's gray levels on grounds that neither
// has met, and traced through their full geometry.
//
//   free_form_study [EVALUATIONS [LOBE [CORRECTIONS]]]
//
// EVALUATIONS of the parametric search, in all (default 1200; 0: none); traced CORRECTIONS of the free form.
//
// 48 × 48 bins, light from straight above, index 1.5; the wanted lobe has the light of a flat surface. 8 draws of 2^20
// paths. Seconds are of CPU time: half of them on two idle cores.

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <functional>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "forward/base/freed_memory.h"
#include "forward/pattern/pattern_parameters.h"
#include "inverse/design/design.h"
#include "inverse/free_form/free_form.h"
#include "inverse/verification/verification.h"

namespace {

using namespace mezzotint;

constexpr DirectionGrid bins{48, 48};
const DirectionAngles straight{};
const Material material = Dielectric{1.5};
constexpr std::size_t tile_pixels = 128;

double cpu_seconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

struct Wanted {
  std::string name;
  std::function<double(double, double)> lobe;
};

double bump(double x, double y, double sigma) { return std::exp(-0.5 * (x * x + y * y) / (sigma * sigma)); }

std::vector<Wanted> wanted_lobes() {
  return {{"square", [](double x, double y) { return std::abs(x) < 0.2 && std::abs(y) < 0.2 ? 1.0 : 0.0; }},
          {"two lobes", [](double x, double y) { return bump(x - 0.2, y, 0.05) + bump(x + 0.2, y, 0.05); }},
          {"tilt", [](double x, double y) { return bump(x - 0.12, y, 0.07); }},
          {"ring", [](double x, double y) { return bump(std::hypot(x, y) - 0.2, 0.0, 0.04); }},
          {"Beckmann .25/.10", [](double x, double y) { return std::exp(-x * x / 0.25 - y * y / 0.04); }}};
}

DirectionMap map_of(const Wanted& wanted) {
  DirectionMap map = average_over_bins(
      bins, [&](const Direction& d) { return wanted.lobe(d.x(), d.y()); }, 16);
  const std::vector<double> areas = projected_solid_angles(bins);
  double light = 0.0;
  for (std::size_t k = 0; k < map.size(); ++k) light += areas[k] * map[k];
  for (double& value : map) value *= reflectance(material, 1.0) / light;
  return map;
}

const std::vector<std::uint64_t> fresh_seeds = {900001, 900002, 900003, 900004, 900005, 900006, 900007, 900008};

struct Errors {
  double cube_root = 0.0, l2 = 0.0;
};

void print_verification(const std::string& name, const Verification& found, double seconds) {
  std::printf("  %-12s", name.c_str());
  for (const LobeDistance kind : {LobeDistance::CubeRoot, LobeDistance::L2, LobeDistance::Wasserstein}) {
    const JudgedDistance& judged = found.traced.by(kind);
    std::printf(" %s %.4f ±%.4f (floor %.4f, slopes %.4f)", std::string(name_of(kind)).c_str(), judged.root.value,
                judged.root.standard_error, judged.root_floor, found.by_slope.by(kind).root.value);
  }
  std::printf(" light %.4f of %.4f; %.1f s\n", found.energy.front().reflected.value, found.wanted_light.front(),
              seconds);
}

// Prints and traces.
Errors verified(const std::string& name, const GrayOfSeed& gray, Surround surround, const PrinterProfile& printer,
                const LobeTarget& goal) {
  const double before = cpu_seconds();
  const Verification found = verify_design(gray, printer, goal, {.draw = {.surround = surround}, .seeds = fresh_seeds});
  print_verification(name, found, cpu_seconds() - before);
  return {found.traced.by(LobeDistance::CubeRoot).root.value, found.traced.by(LobeDistance::L2).root.value};
}

// Families with the ranges that the printer can do; each gets an equal part of the budget.
struct Family {
  std::string name;
  Pattern pattern;
  std::vector<FreeParameter> free;
};

std::vector<Family> families() {
  const FreeParameter direction{"direction_deg", -180.0, 180.0, {}}, height{"height_um", 1.0, 17.8, 9.0};
  return {{"sinusoid",
           Sinusoid{},
           {height, direction, {"wavelength_u_um", 30.2, 400.0, {}}, {"wavelength_v_um", 30.2, 400.0, {}}}},
          {"ridges", Ridges{}, {height, direction, {"wavelength_um", 30.2, 400.0, {}}, {"skew", 0.05, 0.95, 0.4}}},
          {"noise", Noise{}, {height, direction, {"scale_um", 30.2, 400.0, {}}, {"stretch", 1.0, 8.0, 2.0}}}};
}

struct Parametric {
  std::string family;
  Errors errors;
};

// A global search, then a local one from where it ended, on the cube-root error of the printed lobe (without tracing).
Parametric best_pattern(const LobeTarget& goal, const DirectionMap& wanted, const PrinterProfile& printer, int budget) {
  Parametric best{"", {1e9, 1e9}};
  for (const Family& family : families()) {
    DesignProblem problem;
    problem.target = beckmann_target({0.2, 0.1, {}});  // for the start alone; what is lowered is the lobe
    problem.pattern = family.pattern;
    problem.free = family.free;
    problem.printer = printer;
    problem.patch = {.pixels = tile_pixels, .subsamples = 3};
    problem.search_draws = 2;
    problem.lobes = lobe_target(bins, material, {straight}, {wanted}, false);
    problem.by_light = true;
    problem.objective = {{Measure::CubeRoot, 1.0}};
    const int share = budget / static_cast<int>(families().size());
    problem.search = {.algorithm = "GN_CRS2_LM", .max_evaluations = 2 * share / 3, .seed = 1};
    const Design global = find_design(problem);
    for (FreeParameter& parameter : problem.free) parameter.start = get_parameter(global.pattern, parameter.name);
    problem.search = {.algorithm = "LN_BOBYQA", .max_evaluations = share / 3, .seed = 1};
    const Design local = find_design(problem);
    const Design& found = local.search.objective < global.search.objective ? local : global;
    const GrayOfSeed gray = [&](std::uint64_t seed) {
      return expose(pixel_heights(draw_instance(found.pattern, seed), printer, tile_pixels), printer).image;
    };
    const Errors errors = verified(family.name, gray, Surround::Mirror, printer, goal);
    if (errors.cube_root < best.errors.cube_root) best = {family.name, errors};
  }
  return best;
}

}  // namespace

int main(int count, char** arguments) {
  keep_freed_memory();
  const int budget = count > 1 ? std::atoi(arguments[1]) : 1200;
  const PrinterProfile printer;
  for (const Wanted& wanted : wanted_lobes()) {
    if (count > 2 && wanted.name != arguments[2]) continue;
    const DirectionMap map = map_of(wanted);
    const LobeTarget goal = lobe_target(bins, material, {straight}, {map}, false);
    std::printf("%s\n", wanted.name.c_str());
    const double before = cpu_seconds();
    FreeFormOptions options{.pixels = tile_pixels};
    if (count > 3) options.traced_corrections = std::atoi(arguments[3]);
    const FreeForm form = find_free_form(goal, printer, options);
    std::printf("  %d evaluations, %.1f s of CPU, from %s; root of the objective %.4f on its own samples\n",
                form.evaluations, cpu_seconds() - before, form.start.c_str(), std::sqrt(form.on_search_draws));
    for (const std::string& warning : form.warnings) std::printf("  %s\n", warning.c_str());
    const GrayOfSeed gray = [&](std::uint64_t) { return form.gray; };
    const Errors free = verified("free form", gray, Surround::Repeat, printer, goal);
    if (budget > 0) {
      const Parametric best = best_pattern(goal, map, printer, budget);
      std::printf("  %s is the best pattern; a free form is better by %.2f (cube root), %.2f (L2)\n",
                  best.family.c_str(), best.errors.cube_root / free.cube_root, best.errors.l2 / free.l2);
    }
    std::fflush(stdout);
  }
}
