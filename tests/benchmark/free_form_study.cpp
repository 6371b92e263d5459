// What freedom at every pixel is worth: a free form against a parametric search with a fixed, seeded budget, on lobes
// that patterns can hardly have; both printed with the printer's gray levels on a ground that neither has met, and
// traced through their full geometry.
//
//   free_form_study [EVALUATIONS]     of the parametric search, in all (default 1200)
//
// Error: √(Σ a (∛f − ∛g)² / Σ a (∛g)²) of the traced map f to the wanted one g on 48 × 48 bins, and the same without
// the root. Light from straight above, index 1.5; the wanted lobe has the light of a flat surface.

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <functional>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "forward/pattern/pattern_parameters.h"
#include "forward/scattering/path_tracing.h"
#include "inverse/design/design.h"
#include "inverse/free_form/free_form.h"

namespace {

using namespace mezzotint;

constexpr DirectionGrid bins{48, 48};
const DirectionAngles straight{};
const Material material = Dielectric{1.5};
constexpr std::uint64_t ground_seed = 987654321;
constexpr std::size_t tile_pixels = 128, traced_subsamples = 6;

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

struct Errors {
  double cube_root = 0.0, l2 = 0.0;
};

Errors errors_of(const DirectionMap& found, const DirectionMap& wanted) {
  const std::vector<double> areas = projected_solid_angles(bins);
  double root = 0.0, root_whole = 0.0, plain = 0.0, plain_whole = 0.0;
  for (std::size_t k = 0; k < found.size(); ++k) {
    root += areas[k] * std::pow(std::cbrt(found[k]) - std::cbrt(wanted[k]), 2);
    root_whole += areas[k] * std::pow(std::cbrt(wanted[k]), 2);
    plain += areas[k] * std::pow(found[k] - wanted[k], 2);
    plain_whole += areas[k] * wanted[k] * wanted[k];
  }
  return {std::sqrt(root / root_whole), std::sqrt(plain / plain_whole)};
}

// Prints the gray image on fresh ground and traces it.
Errors traced(const GrayImage& gray, Surround surround, const PrinterProfile& printer, const DirectionMap& wanted) {
  HeightField relief = print_layer(quantize(gray, printer), printer, {traced_subsamples, surround});
  add_ground(relief, printer, split_ground(printer, 550.0_nm).geometric, ground_seed);
  const Bsdf bsdf = PathTracer(relief).trace({.grid = bins, .material = material, .samples = 1U << 22, .seed = 5});
  return errors_of(bsdf.reflection.mean, wanted);
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
Parametric best_pattern(const DirectionMap& wanted, const PrinterProfile& printer, int budget) {
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
    const HeightField heights = pixel_heights(draw_instance(found.pattern, found.print_seed), printer, tile_pixels);
    const Errors errors = traced(expose(heights, printer).image, Surround::Mirror, printer, wanted);
    std::printf("  %-10s %4d evaluations, traced: cube root %.3f, L2 %.3f\n", family.name.c_str(),
                static_cast<int>(global.search.cost + local.search.cost), errors.cube_root, errors.l2);
    if (errors.cube_root < best.errors.cube_root) best = {family.name, errors};
  }
  return best;
}

}  // namespace

int main(int count, char** arguments) {
  const int budget = count > 1 ? std::atoi(arguments[1]) : 1200;
  const PrinterProfile printer;
  for (const Wanted& wanted : wanted_lobes()) {
    const DirectionMap map = map_of(wanted);
    std::printf("%s\n", wanted.name.c_str());
    const double before = cpu_seconds();
    const FreeForm form =
        find_free_form(lobe_target(bins, material, {straight}, {map}, false), printer, {.pixels = tile_pixels});
    const double seconds = cpu_seconds() - before;
    const Errors free = traced(form.gray, Surround::Repeat, printer, map);
    std::printf("  %-10s %4d evaluations, traced: cube root %.3f, L2 %.3f  (from %s, %.1f s of CPU; searched %.3f)\n",
                "free form", form.evaluations, free.cube_root, free.l2, form.start.c_str(), seconds,
                std::sqrt(form.on_search_draws));
    const Parametric best = best_pattern(map, printer, budget);
    std::printf("  %s is the best pattern; a free form is better by %.2f (cube root), %.2f (L2)\n", best.family.c_str(),
                best.errors.cube_root / free.cube_root, best.errors.l2 / free.l2);
    std::fflush(stdout);
  }
}
