// Whether the gamut's verdicts are right: targets that were printed are never called out of reach, and targets that no
// print shows always are.
//
//   gamut_study [TARGETS] [SEED]     of each sort (default 40, 1)
//
// Reachable ones: parameters drawn evenly in logarithms within the bounds, in a random direction, printed by the whole
// process (with gray levels, ground noise as relief, facets of a mesh) on a patch of 256 pixels, four draws; a quarter
// each of S sinusoid, R ridges + sinusoid, N noise and C ridges + sinusoid + noise; every other one close to the
// border, with heights of 0.9 to 1 of what is reachable and lengths of 4 to 6 pixels. Unreachable ones: below the
// floor; beyond the ratio that the floor allows; steeper than anything that 300 random and 200 searched prints of the
// kind show, by 1.08 to 3; and slopes across ridges.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <numbers>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "forward/base/random.h"
#include "forward/process/printed_relief.h"
#include "inverse/gamut/gamut_map.h"
#include "inverse/search/minimize.h"

namespace {

using namespace mezzotint;

const std::vector<std::string> families = {"sinusoid", "ridges+sinusoid", "noise", "ridges+sinusoid+noise"};

double cpu_seconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

struct Draw {
  std::uint64_t seed, index;
  [[nodiscard]] double uniform(std::uint32_t number) const {
    return RandomStream(seed, RandomPurpose::GamutTarget).uniform4(index, number / 4).at(number % 4);
  }
};

std::vector<double> drawn_values(const GamutKind& kind, const Draw& draw) {
  std::vector<double> values;
  for (std::size_t i = 0; i < kind.free.size(); ++i) {
    // Heights from a sixth of what is reachable on: flatter ones are all ground.
    const double low = kind.free[i].name == "height_um" ? kind.free[i].high / 6.0 : kind.free[i].low;
    values.push_back(low * std::pow(kind.free[i].high / low, draw.uniform(static_cast<std::uint32_t>(i) + 4)));
  }
  return values;
}

// Steep prints, close to the border.
std::vector<double> steep_values(const GamutKind& kind, const Draw& draw) {
  std::vector<double> values = drawn_values(kind, draw);
  for (std::size_t i = 0; i < kind.free.size(); ++i) {
    const GamutParameter& free = kind.free[i];
    const double share = draw.uniform(static_cast<std::uint32_t>(i) + 40);
    if (free.name == "height_um") values[i] = free.high * (0.9 + 0.1 * share);
    if (free.name == "scale_um" || free.name == "wavelength_u_um" || free.name == "wavelength_um")
      values[i] = free.low * (1.0 + 0.5 * share);
  }
  return values;
}

// As the printer would: with gray levels and ground.
SlopeCovariance as_printed(const Pattern& pattern, const PrinterProfile& printer, std::uint64_t seed) {
  constexpr std::size_t pixels = 256, subsamples = 4, draws = 4;
  const Length pitch = printer.pixel_pitch;
  const auto octaves = split_ground(printer, Length::from_nm(550.0)).geometric;
  const PrintProcess process(pixels, pixels, printer, {subsamples, Surround::Mirror});
  SlopeCovariance mean;
  for (std::size_t k = 0; k < draws; ++k) {
    const PatternInstance instance = draw_instance(pattern, seed + k);
    HeightField heights = synthesize(instance.pattern, {pixels, pixels, pitch, pitch}, instance.origin);
    const double lift_um = std::max(0.0, (reachable_height(printer) - height_of(pattern)).um());
    for (float& z : heights.heights_um()) z += static_cast<float>(lift_um);
    HeightField relief = process.print(quantize(expose(heights, printer).image, printer));
    add_ground(relief, printer, octaves, seed + 100 + k);
    const SlopeCovariance one = slope_covariance(relief);
    mean.xx += one.xx / draws;
    mean.yy += one.yy / draws;
    mean.xy += one.xy / draws;
  }
  return mean;
}

Target target_of(const SlopeAxes& axes) { return {.kind = "drawn", .slopes = axes, .rotation_matters = true}; }
Target target_of(double alpha_x, double alpha_y, double turn) {
  return target_of({alpha_x / std::numbers::sqrt2, alpha_y / std::numbers::sqrt2, Angle::from_degrees(turn)});
}

struct Tally {
  int right = 0, all = 0, edge = 0;
  double slowest_s = 0.0, seconds = 0.0;
};

GamutVerdict timed(const Target& target, const PrinterProfile& printer, const std::string& kind, Tally& tally) {
  const double before = cpu_seconds();
  GamutVerdict verdict = judge(target, printer, kind);
  const double took = cpu_seconds() - before;
  tally.slowest_s = std::max(tally.slowest_s, took);
  tally.seconds += took;
  ++tally.all;
  if (verdict.place == GamutPlace::Edge) ++tally.edge;
  return verdict;
}

void say(const char* what, const std::string& kind, const GamutVerdict& v, bool right) {
  fmt::print("{:<8} {:<22} α {:.4f}, {:.4f}: {:<11} nearest {:.4f}, {:.4f} (distance {:.4f}, {} prints){}\n", what,
             kind, v.wanted.x, v.wanted.y, to_string(v.place), v.nearest.x, v.nearest.y, v.distance, v.prints,
             right ? "" : "  WRONG: " + v.why);
}

Tally reachable(const PrinterProfile& printer, int count, std::uint64_t seed) {
  Tally tally;
  for (int i = 0; i < count; ++i) {
    const std::string& family = families[static_cast<std::size_t>(i) % families.size()];
    const GamutKind kind = gamut_kind(family, printer);
    const Draw draw{seed, static_cast<std::uint64_t>(i)};
    const auto values = i / 4 % 2 == 0 ? drawn_values(kind, draw) : steep_values(kind, draw);
    const Pattern pattern =
        turned(pattern_of(kind, values, printer), Angle::from_degrees(180.0 * draw.uniform(0) - 90.0));
    const SlopeCovariance print = as_printed(pattern, printer, 7919 * (seed + draw.index));
    const GamutVerdict verdict = timed(target_of(principal_axes(print)), printer, family, tally);
    const bool right = verdict.place != GamutPlace::Outside;
    tally.right += right ? 1 : 0;
    say("reach", family, verdict, right);
  }
  return tally;
}

// The largest geometric mean of α's that many prints of a kind show, and its α's.
AlphaPair steepest_print(const GamutKind& kind, const PrinterProfile& printer, double ratio, const Draw& draw) {
  const SlopePrint print(printer, {96, 3, 1, draw.index + 1});
  AlphaPair best{1e-9, 1e-9};
  const auto shown = [&](const std::vector<double>& values) {
    const AxisSquares s = print.squares(pattern_of(kind, values, printer)).mean;
    const AlphaPair alpha{std::sqrt(2.0 * std::max(s.u, s.v)), std::sqrt(2.0 * std::max(0.0, std::min(s.u, s.v)))};
    // How far a target of this ratio would be reached on both axes.
    const double reach = std::min(alpha.x, alpha.y * ratio);
    if (reach > best.x) best = {reach, reach / ratio};
    return -reach;
  };
  std::vector<double> start;
  double least = 0.0;
  for (std::uint64_t k = 0; k < 300; ++k) {
    const std::vector<double> values = drawn_values(kind, {draw.seed + 1000 + k, draw.index});
    const double found = shown(with_heights(kind, values, 1.5));
    if (start.empty() || found < least) start = values, least = found;
  }
  std::vector<Variable> variables;
  for (std::size_t i = 0; i < start.size(); ++i)
    variables.push_back({kind.free[i].name, kind.free[i].low, kind.free[i].high, start[i], true});
  (void)minimize(variables, shown, {.algorithm = "LN_SBPLX", .max_evaluations = 200});
  return best;
}

Target unreachable_target(int sort, const GamutKind& kind, const PrinterProfile& printer, const Draw& draw) {
  const double floor = gamut_formula(printer, Length::from_nm(550.0)).floor_alpha;
  const double turn = 180.0 * draw.uniform(0) - 90.0, share = draw.uniform(1), other = draw.uniform(2);
  if (sort == 0) return target_of(floor * (0.3 + 0.6 * share), floor * (0.3 + 0.6 * share) * (0.6 + 0.4 * other), turn);
  if (sort == 1) return target_of(0.05 + 0.6 * share, floor * (0.3 + 0.6 * other), turn);
  if (sort == 3) return target_of(0.05 + 0.6 * share, std::max(1.2 * floor, (0.05 + 0.6 * share) * other), turn);
  const double ratio = std::pow(8.0, other);
  const AlphaPair steepest = steepest_print(kind, printer, ratio, draw);
  const double beyond = 1.08 * std::pow(3.0 / 1.08, share);
  return target_of(beyond * steepest.x, beyond * steepest.y, turn);
}

Tally unreachable(const PrinterProfile& printer, int count, std::uint64_t seed) {
  constexpr const char* sorts[] = {"floor", "ratio", "steep", "ridges"};
  Tally tally;
  for (int i = 0; i < count; ++i) {
    const int sort = i % 4;
    const std::string family = sort == 3 ? "ridges" : families[static_cast<std::size_t>(i / 4) % families.size()];
    const GamutKind kind = gamut_kind(family, printer);
    const Target target = unreachable_target(sort, kind, printer, {seed, 1'000'000 + static_cast<std::uint64_t>(i)});
    const GamutVerdict verdict = timed(target, printer, family, tally);
    const bool right = verdict.place == GamutPlace::Outside;
    tally.right += right ? 1 : 0;
    say(sorts[sort], family, verdict, right);
  }
  return tally;
}

void sum_up(const char* what, const Tally& tally) {
  fmt::print("{}: {} of {} right ({} on the edge); {:.0f} ms of CPU time each, at most {:.0f}\n", what, tally.right,
             tally.all, tally.edge, 1e3 * tally.seconds / tally.all, 1e3 * tally.slowest_s);
}

// How much a direction changes what a kind prints at its steepest, grid-aligned to 45°, by large raw patches.
void direction_influence(const PrinterProfile& printer) {
  const SlopePrint print(printer, {384, 3, 1, 3});
  for (const char* name : {"sinusoid", "noise", "ridges", "line_integral_convolution"}) {
    const GamutKind kind = gamut_kind(name, printer);
    for (const double pixels : {4.0, 5.0, 8.0}) {
      std::vector<double> values;
      for (const GamutParameter& free : kind.free) {
        const bool length = free.name != "height_um" && free.name != "stretch" && free.name != "skew";
        values.push_back(free.name == "height_um" ? free.high
                         : length                 ? pixels * printer.pixel_pitch.um() * 1.003
                         : free.name == "skew"    ? 0.5
                                                  : 1.0);
      }
      fmt::print("{:<26} {} pixels: α_x at", name, pixels);
      for (const double turn : {0.0, 7.0, 22.5, 45.0}) {
        const Pattern pattern = turned(pattern_of(kind, values, printer), Angle::from_degrees(turn));
        fmt::print(" {:g}° {:.4f}", turn, std::numbers::sqrt2 * principal_axes(print.raw(pattern, 0)).rms_major);
      }
      fmt::print("\n");
    }
  }
}

}  // namespace

int main(int count, char** arguments) {
  const int targets = count > 1 ? std::atoi(arguments[1]) : 40;
  const std::uint64_t seed = count > 2 ? std::strtoull(arguments[2], nullptr, 10) : 1;
  const PrinterProfile printer;
  direction_influence(printer);
  const Tally in = reachable(printer, targets, seed), out = unreachable(printer, targets, seed);
  sum_up("reachable", in);
  sum_up("unreachable", out);
  return in.right == in.all && out.right == out.all ? 0 : 1;
}
