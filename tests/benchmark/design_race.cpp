// The inverse ladder against the plain loop: who finds the pattern behind a lobe in less time, and who nearer? Targets
// are traced lobes of patterns drawn at random (recovery_families.h); all answers are judged alike, printed on draws
// that neither target nor search has seen, with the printer's levels, and traced.
//
//   design_race FAMILIES FIRST COUNT ROWS.csv METHOD …   runs methods (race_methods.h) on targets FIRST …, adds rows
//   design_race table ROWS.csv …                         tables of all rows, with ratios of times
//   design_race figure FIGURE.svg ROWS.csv …             error against time
//
// METHODs in short: plain_1e5, plain_1e6 (BOBYQA and SBPLX × L2 and cube root × both starts), levels, algorithms,
// objectives (of the ladder). One thread, so that CPU time is one processor's; 20° of light along both axes, 48 × 48
// bins, index 1.5. The time is that of the search alone: verdict and intervals, which the plain loop has not, are
// apart.

#include <cstdio>
#include <cstdlib>
#include <map>
#include <string>
#include <vector>

#include <tbb/global_control.h>

#include "forward/base/error.h"
#include "forward/base/file_output.h"
#include "forward/base/freed_memory.h"
#include "inverse/design/printed_texture.h"
#include "inverse/verification/verification.h"
#include "race_methods.h"
#include "race_rows.h"

namespace {

using namespace mezzotint;
using namespace mezzotint::benchmark;

constexpr DirectionGrid bins{48, 48};
const std::vector<DirectionAngles> lights = {{20.0_deg, 0.0_deg}, {20.0_deg, 90.0_deg}};
constexpr std::uint64_t target_seed = 900001, judge_seed = 800001;
constexpr std::size_t seen_draws = 8;
constexpr std::uint64_t seen_paths = 1U << 19;

Verification seen(const Pattern& pattern, std::size_t pixels, const LobeTarget& goal, std::uint64_t first_seed) {
  const PrinterProfile printer;
  VerificationOptions options;
  options.draw.subsamples = 4;
  options.samples = seen_paths;
  for (std::uint64_t i = 0; i < seen_draws; ++i) options.seeds.push_back(first_seed + i);
  const GrayOfSeed gray = [&](std::uint64_t seed) {
    return expose(pixel_heights(draw_instance(pattern, seed), printer, pixels), printer).image;
  };
  return verify_design(gray, printer, goal, options);
}

// What the truth shows, on draws of its own. (The goal that it is judged by does not matter: a mirror's spot.)
LobeTarget shown_by(const Pattern& truth, std::size_t pixels) {
  LobeTarget goal{SmoothGrid(bins), Dielectric{1.5}, lights, {}};
  const DirectionMap even(48U * 48U, 1.0);
  goal.maps.assign(lights.size(), even);
  const Verification shown = seen(truth, pixels, goal, target_seed);
  for (std::size_t light = 0; light < lights.size(); ++light) goal.maps[light] = shown.traced.lobes[light].mean;
  return goal;
}

SlopeCovariance mean_covariance(const Verification& seen) { return mean_of(seen.slope_covariances).mean; }

std::vector<std::string> methods_of(const std::string& text) {
  std::vector<std::string> methods;
  if (text == "plain_1e5" || text == "plain_1e6") {
    for (const char* algorithm : {"LN_BOBYQA", "LN_SBPLX"})
      for (const char* objective : {"cube_root", "l2"})
        for (const char* start : {"centre", "closed"})
          methods.push_back("plain:algorithm=" + std::string(algorithm) + ":objective=" + objective +
                            ":rays=" + text.substr(6) + ":start=" + start);
    return methods;
  }
  if (text == "levels") {
    return {"moments", "ladder:corrections=0:evaluations=0", "ladder:corrections=1:evaluations=0",
            "ladder:corrections=1:evaluations=8", "ladder:corrections=1:evaluations=40"};
  }
  const std::string slopes_alone = "ladder:corrections=0:evaluations=0:";
  if (text == "algorithms") {
    for (const char* name : {"LN_BOBYQA", "LN_SBPLX", "LN_COBYLA", "LN_NELDERMEAD", "LD_LBFGS", "LD_SLSQP"})
      methods.push_back(slopes_alone + "algorithm=" + name);
    return methods;
  }
  if (text == "objectives") {
    for (const char* name : {"cube_root", "l2", "log", "sliced_wasserstein", "moments", "cube_root+moments"})
      methods.push_back(slopes_alone + "objective=" + name);
    return methods;
  }
  return {text};
}

void run_target(const Family& family, int target, const std::string& file, const std::vector<std::string>& methods) {
  const Pattern truth = truth_of(family, static_cast<std::uint64_t>(target));
  const std::size_t pixels = judged_pixels(family);
  const LobeTarget goal = shown_by(truth, pixels);
  const SlopeCovariance wanted = mean_covariance(seen(truth, pixels, goal, judge_seed));
  for (const std::string& text : methods) {
    const RaceResult found = race(race_method(text), family, goal, truth, static_cast<std::uint64_t>(target) + 1);
    const Verification judged = seen(found.pattern, pixels, goal, judge_seed);
    const Estimate cube_root = judged.traced.by(LobeDistance::CubeRoot).root;
    const Estimate l2 = judged.traced.by(LobeDistance::L2).root;
    const RaceRow row{std::string(1, family.letter),
                      target,
                      text,
                      found.evaluations,
                      found.cpu_seconds,
                      found.wall_seconds,
                      cube_root.value,
                      cube_root.standard_error,
                      l2.value,
                      l2.standard_error,
                      largest_error(mean_covariance(judged), wanted)};
    append_row(file, row);
    std::printf("%s%-2d %-72s %5.0f evaluations %8.2f s (wall %8.2f)  cube root %.4f  L2 %.4f  covariance %5.2f %%\n",
                row.family.c_str(), target, text.c_str(), row.evaluations, row.cpu_seconds, row.wall_seconds,
                row.cube_root, row.l2, 100.0 * row.covariance_error);
    std::fflush(stdout);
  }
}

std::vector<RaceRow> rows_of(int count, char** arguments, int first) {
  std::vector<RaceRow> rows;
  for (int i = first; i < count; ++i) {
    const std::vector<RaceRow> more = read_rows(arguments[i]);
    rows.insert(rows.end(), more.begin(), more.end());
  }
  return rows;
}

int run(int count, char** arguments) {
  const std::string what = count > 2 ? arguments[1] : "";
  if (what == "table") {
    std::fputs(race_table(rows_of(count, arguments, 2)).c_str(), stdout);
    return 0;
  }
  if (what == "figure" && count > 3) {
    write_file(arguments[2], race_figure(rows_of(count, arguments, 3)));
    return 0;
  }
  if (count < 6) {
    std::fputs(
        "design_race FAMILIES FIRST COUNT ROWS.csv METHOD …, table ROWS.csv …, or figure FIGURE.svg ROWS.csv …\n",
        stderr);
    return 2;
  }
  const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
  std::vector<std::string> methods;
  for (int i = 5; i < count; ++i)
    for (const std::string& method : methods_of(arguments[i])) methods.push_back(method);
  for (const std::string& method : methods) static_cast<void>(race_method(method));  // mistakes before time is spent
  const int first = std::atoi(arguments[2]), targets = std::atoi(arguments[3]);
  for (const Family& family : recovery_families()) {
    if (what.find(family.letter) == std::string::npos) continue;
    for (int target = first; target < first + targets; ++target) run_target(family, target, arguments[4], methods);
  }
  return 0;
}

}  // namespace

int main(int count, char** arguments) {
  keep_freed_memory();
  try {
    return run(count, arguments);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
