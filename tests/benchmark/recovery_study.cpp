// Can a search find again what was printed? Parameters are drawn by a seeded generator, printed and seen through their
// lobes; the search gets the lobes alone, with the kind of pattern and its bounds. Judged on draws that neither the
// target nor the search has seen: the slope covariance of what was found against that of the truth.
//
//   recovery_study [TARGETS [FAMILIES]]     default 40 SRNC
//
// "ok": both principal variances and, weighed by what a turn changes, the axis within 2 % (S, R) or 5 % (N, C).

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "forward/base/error.h"
#include "forward/base/freed_memory.h"
#include "inverse/design/design.h"
#include "measure.h"
#include "recovery_families.h"

namespace {

using namespace mezzotint;
using namespace mezzotint::benchmark;

constexpr DirectionGrid bins{48, 48};
const std::vector<DirectionAngles> lights = {{20.0_deg, 0.0_deg}, {20.0_deg, 90.0_deg}};
const Material material = Dielectric{1.5};

LobeTarget empty_target() { return {SmoothGrid(bins), material, lights, {}}; }

void study(const Family& family, int targets) {
  const PrinterProfile printer;
  const PatchOptions patch{.pixels = family.pixels, .subsamples = 3};
  const PatchOptions judging{.pixels = judged_pixels(family), .subsamples = 4};
  const SlopeModelOptions as_printed{
      .levels = GrayLevels::Quantized, .drawn_ground = true, .place_x = 0.3, .place_y = 0.6};
  std::vector<std::uint64_t> target_seeds, judge_seeds;
  for (std::uint64_t i = 0; i < 8; ++i) target_seeds.push_back(900001 + i), judge_seeds.push_back(800001 + i);
  const SlopeModel showing(printer, judging, target_seeds, empty_target(), as_printed);
  const SlopeModel judge(printer, judging, judge_seeds, {}, as_printed);

  std::vector<double> errors, costs, seconds, roots;
  int ok = 0;
  for (int k = 0; k < targets; ++k) {
    const Pattern truth = truth_of(family, static_cast<std::uint64_t>(k));
    LobeTarget lobes = empty_target();
    lobes.maps = showing.shown(truth).maps;
    DesignProblem problem;
    problem.target = beckmann_target({0.2, 0.1, {}});  // replaced by what the lobes imply
    problem.target.tolerance = family.tolerance;
    problem.pattern = family.pattern;
    problem.free = family.free;
    problem.printer = printer;
    problem.patch = patch;
    problem.search_draws = family.draws;
    problem.fresh_draws = 4;
    problem.traced = {.corrections = 0, .evaluations = 0};
    problem.traced_draws = 0;
    problem.lobes = lobes;
    problem.by_light = true;
    problem.search.seed = static_cast<std::uint64_t>(k + 1);
    problem.search.max_evaluations = 300;
    const double before = process_seconds();
    const Design design = find_design(problem);
    const double spent = process_seconds() - before;
    const SlopeCovariance found = judge.shown(design.pattern).covariance, wanted = judge.shown(truth).covariance;
    const double error = largest_error(found, wanted);
    ok += error <= family.tolerance ? 1 : 0;
    errors.push_back(error);
    costs.push_back(design.search.cost);
    seconds.push_back(spent);
    roots.push_back(design.fresh_lobe_error->value);
    if (std::getenv("STUDY_EACH") != nullptr) {
      const SlopeAxes axes = principal_axes(wanted);
      std::printf("  %c%-3d error %6.2f %%  cube root %.4f  cost %5.1f  %5.2f s  alpha %.3f %.3f  shape %d\n",
                  family.letter, k, 100.0 * error, roots.back(), costs.back(), spent, std::sqrt(2.0) * axes.rms_major,
                  std::sqrt(2.0) * axes.rms_minor, design.search.shape_fits);
    }
    std::fflush(stdout);
  }
  std::printf(
      "%c: %d of %d within %.0f %%; error median %.2f %%, worst %.2f %%; evaluations median %.0f, worst %.0f; cube "
      "root "
      "median %.4f, worst %.4f; CPU median %.2f s\n",
      family.letter, ok, targets, 100.0 * family.tolerance, 100.0 * median(errors), 100.0 * std::ranges::max(errors),
      median(costs), std::ranges::max(costs), median(roots), std::ranges::max(roots), median(seconds));
  std::fflush(stdout);
}

}  // namespace

int main(int count, char** arguments) {
  keep_freed_memory();
  const int targets = count > 1 ? std::atoi(arguments[1]) : 40;
  const std::string letters = count > 2 ? arguments[2] : "SRNC";
  for (const Family& family : recovery_families()) {
    if (letters.find(family.letter) != std::string::npos) study(family, targets);
  }
}
