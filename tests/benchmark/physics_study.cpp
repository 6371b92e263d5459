// Long studies of the forward model's physics, printed as tables: `physics_study NAME`, see `studies` below. What they
// showed stands in docs/physics.md; small versions are tests.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <functional>
#include <map>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "forward/scattering/path_tracing.h"
#include "tests/forward/scattering/coverage.h"
#include "tests/forward/scattering/gaussian_relief.h"
#include "tests/reference/smith_bsdf.h"

namespace mezzotint {
namespace {

DirectionAngles at(double theta_deg, double phi_deg) {
  return {Angle::from_degrees(theta_deg), Angle::from_degrees(phi_deg)};
}

void furnace_row(PathTracer& tracer, double gradient, const PathTracingOptions& options) {
  const Bsdf bsdf = tracer.trace(options);
  const EnergyAudit& energy = bsdf.energy;
  const double audit = energy.reflected.value + energy.transmitted.value + energy.absorbed.value +
                       energy.left_sideways.value + energy.cut_off.value;
  fmt::print("{:12} {:14} {:12} {:4} {:4}  {:12.4g} {:12.4g} {:>9} {:>9} {:>12}\n", bsdf.provenance.at("tracer"),
             bsdf.provenance.at("material"), bsdf.provenance.at("normals"), gradient,
             std::round(options.incidence.theta.degrees()), 1.0 - energy.reflected.value - energy.transmitted.value,
             1.0 - audit, bsdf.provenance.at("leaked_share"), bsdf.provenance.at("normal_fallback_share"),
             bsdf.provenance.at("interactions_per_path"));
  std::fflush(stdout);
}

// White furnace: nothing is lost between mirrors, nor in a clear medium, and the audit sums to 1. 2^20 paths each.
void furnace() {
  fmt::print("{:12} {:14} {:12} {:>4} {:>4}  {:>12} {:>12} {:>9} {:>9} {:>12}\n", "tracer", "material", "normals", "s",
             "deg", "lost", "1 - audit", "leaked", "fallback", "interactions");
  for (const double gradient : {0.05, 0.1, 0.3, 0.5, 0.8, 1.0}) {
    PathTracer tracer(test::gaussian_relief(512, gradient, 8.0));
    for (const Material& material : {Material{Mirror{}}, Material{Dielectric{1.5}}}) {
      for (const TracerKind kind : {TracerKind::HeightField, TracerKind::Embree}) {
        for (const NormalKind normals : {NormalKind::Geometric, NormalKind::Interpolated}) {
          for (const double theta : {0.0, 30.0, 60.0, 80.0, 85.0, 89.0}) {
            PathTracingOptions options;
            options.incidence = at(theta, 20.0);
            options.material = material;
            options.normals = normals;
            options.tracer = kind;
            options.max_bounces = 1024;
            options.control_variate = ControlVariate::Off;
            furnace_row(tracer, gradient, options);
          }
        }
      }
    }
  }
}

// Bins between which light is to go both ways: all of the first with all of the second. Chosen so that a Beckmann lobe
// of α = 0.3 sends 9e-4 of the light or more from one to the other.
struct Cluster {
  std::vector<DirectionAngles> first, second;
};
const std::vector<Cluster> clusters = {
    {{at(4, 10), at(12, 90), at(16, 210), at(9, 300)},
     {at(22, 190), at(26, 280), at(20, 40), at(14, 150), at(30, 250)}},
    {{at(38, 20), at(45, 45), at(32, 0)}, {at(42, 200), at(36, 225), at(48, 190), at(30, 240), at(52, 215)}},
    {{at(58, 100), at(66, 120), at(72, 90)}, {at(62, 280), at(55, 295), at(68, 275), at(74, 285), at(48, 270)}}};

std::vector<Bsdf> traces_from(PathTracer& tracer, const std::vector<DirectionAngles>& lights, std::uint64_t seed) {
  std::vector<Bsdf> traces;
  for (const DirectionAngles& light : lights) {
    PathTracingOptions options;
    options.incidence = light;
    options.spread_incidence_over_bin = true;
    options.grid = {32, 32};
    options.material = Mirror{};
    options.samples = std::uint64_t{1} << 26;
    options.batches = 256;  // so that the variance of a difference over its error is 1.004, not the 1.4 of 8 batches
    options.max_bounces = 1024;
    options.seed = seed++;
    traces.push_back(tracer.trace(options));
  }
  return traces;
}

// Probability that a χ² of an even number of degrees of freedom exceeds x.
double tail_probability(double x, int degrees) {
  double term = 1.0, sum = 1.0;
  for (int k = 1; k < degrees / 2; ++k) sum += term *= 0.5 * x / k;
  return sum * std::exp(-0.5 * x);
}

Estimate value_toward(const Bsdf& bsdf, const DirectionAngles& viewer) {
  const Direction direction = to_direction(viewer);
  const std::size_t bin = bsdf.grid.bin_of(direction.x(), direction.y());
  return {bsdf.reflection.mean[bin], bsdf.reflection.standard_error[bin]};
}

void reciprocity_of(std::uint64_t seed) {
  PathTracer tracer(test::gaussian_relief(256, 0.3, 8.0, seed));
  double sum = 0.0, worst_error = 0.0, worst_excess = 0.0;
  int pairs = 0;
  for (std::size_t c = 0; c < clusters.size(); ++c) {
    const auto& [first, second] = clusters[c];
    const std::vector<Bsdf> there = traces_from(tracer, first, 1000 * seed + 100 * c);
    const std::vector<Bsdf> back = traces_from(tracer, second, 1000 * seed + 100 * c + 50);
    for (std::size_t a = 0; a < first.size(); ++a) {
      for (std::size_t b = 0; b < second.size(); ++b, ++pairs) {
        const Estimate ab = value_toward(there[a], second[b]), ba = value_toward(back[b], first[a]);
        const double excess = (ab.value - ba.value) / std::hypot(ab.standard_error, ba.standard_error);
        sum += excess * excess;
        worst_excess = std::max(worst_excess, std::abs(excess));
        worst_error = std::max({worst_error, ab.standard_error / ab.value, ba.standard_error / ba.value});
      }
    }
  }
  fmt::print(
      "seed {}: chi^2 = {:.1f} of {} pairs, p = {:.3f}; largest error {:.2g} of a value, furthest pair {:.1f} "
      "errors\n",
      seed, sum, pairs, tail_probability(sum, pairs), worst_error, worst_excess);
  std::fflush(stdout);
}

// Reciprocity between 50 pairs of bins of a mirror, s = 0.3, light spread over its own bin.
void reciprocity() {
  for (const std::uint64_t seed : {1, 2, 3, 4}) reciprocity_of(seed);
}

void coverage_of(const char* name, double gradient, double theta_deg, const Material& material,
                 ControlVariate variate) {
  PathTracer tracer(test::gaussian_relief(256, gradient, 8.0));
  PathTracingOptions options;
  options.grid = {32, 32};
  options.incidence = at(theta_deg, 20.0);
  options.material = material;
  options.samples = std::uint64_t{1} << 15;
  options.control_variate = variate;
  const test::Coverage coverage = test::coverage_of(tracer, options, 200, 1U << 9);
  for (std::size_t c = 0; c < coverage.edges.size(); ++c) {
    if (coverage.intervals[c] == 0.0) continue;
    fmt::print(
        "{:28} s = {} {:3.0f} deg  from {:5} hits: {:4.0f} bins, covered {:.4f}, above {:.4f}, below {:.4f}; by "
        "the standard error {:.4f}\n",
        name, gradient, theta_deg, coverage.edges[c], coverage.bins[c], coverage.share(c),
        coverage.above[c] / coverage.intervals[c], coverage.below[c] / coverage.intervals[c],
        coverage.by_error[c] / coverage.intervals[c]);
  }
  std::fflush(stdout);
}

// Whether 95 % intervals hold the truth in 95 % of 200 repeats, by the expected hits of a bin. 2^15 paths each, against
// 2^24.
void coverage() {
  for (const double theta : {0.0, 60.0}) {
    coverage_of("mirror, beam", 0.3, theta, Mirror{}, ControlVariate::Off);
    coverage_of("dielectric, beam", 0.3, theta, Dielectric{1.5}, ControlVariate::Off);
  }
  for (const double gradient : {0.3, 0.8}) {
    coverage_of("mirror, corrected splat", gradient, 60.0, Mirror{}, ControlVariate::On);
    coverage_of("dielectric, corrected splat", gradient, 60.0, Dielectric{1.5}, ControlVariate::On);
  }
}

// Means over draws of a relief: the albedo by order, and the standard error of the first order's mean.
struct Explicit {
  std::array<double, test::SmithBsdf::kept_orders> orders{};
  double albedo = 0.0, spread = 0.0, transmitted = 0.0;
  MapEstimate reflection;
};

void add_scaled(DirectionMap& to, const DirectionMap& from, double factor) {
  to.resize(from.size());
  for (std::size_t k = 0; k < to.size(); ++k) to[k] += factor * from[k];
}

Explicit traced(std::vector<PathTracer*> draws, const PathTracingOptions& options) {
  Explicit result;
  const double share = 1.0 / static_cast<double>(draws.size());
  const auto areas = projected_solid_angles(options.grid);
  DirectionMap variance;
  double square = 0.0;
  for (std::size_t draw = 0; draw < draws.size(); ++draw) {
    const Bsdf bsdf = draws[draw]->trace(options);
    for (std::size_t order = 0; order < result.orders.size(); ++order)
      for (std::size_t bin = 0; bin < areas.size(); ++bin)
        result.orders[order] += share * areas[bin] * bsdf.reflection_orders[order].mean[bin];
    const double once = std::inner_product(areas.begin(), areas.end(), bsdf.reflection_orders[0].mean.begin(), 0.0);
    result.albedo += share * bsdf.energy.reflected.value;
    square += share * once * once;
    result.transmitted += share * bsdf.energy.transmitted.value;
    add_scaled(result.reflection.mean, bsdf.reflection.mean, share);
    // Halves of the draws rather than of the samples: what differs from draw to draw is noise as well.
    add_scaled(draw % 2 == 0 ? result.reflection.half_a : result.reflection.half_b, bsdf.reflection.mean, 2.0 * share);
    add_scaled(result.reflection.standard_error, bsdf.reflection.standard_error, share * std::sqrt(share));
  }
  result.spread = std::sqrt(std::max(0.0, square - result.orders[0] * result.orders[0]) /
                            std::max(1.0, static_cast<double>(draws.size()) - 1.0));
  return result;
}

void smith_row(std::vector<PathTracer*> draws, double gradient, const Material& material, double theta_deg) {
  PathTracingOptions options;
  options.incidence = at(theta_deg, 25.0);
  options.grid = {32, 32};
  options.material = material;
  options.samples = std::uint64_t{1} << 18;
  options.bounce_orders = test::SmithBsdf::kept_orders;
  options.max_bounces = 1024;
  const Explicit real = traced(std::move(draws), options);
  const test::SmithBsdf smith =
      test::smith_bsdf(gradient, material, options.incidence, options.grid, std::uint64_t{1} << 20, 3);
  const MapDifference difference = relative_l2(options.grid, real.reflection, smith.reflection);
  fmt::print("{:14} s = {} {:3.0f} deg ", to_string(material), gradient, theta_deg);
  for (std::size_t k = 0; k < real.orders.size(); ++k) fmt::print("  {:.4f}/{:.4f}", real.orders[k], smith.orders[k]);
  fmt::print("  albedo {:.4f}/{:.4f} order 1 ± {:.4f}  L2 {:.3f} ± {:.3f}\n", real.albedo, smith.albedo(), real.spread,
             difference.corrected.value, difference.corrected.standard_error);
  std::fflush(stdout);
}

// Explicit Gaussian surfaces against Smith's model of them: explicit/Smith, orders 1, 2, 3, 4 and above.
void smith() {
  for (const double gradient : {0.3, 0.5, 0.8}) {
    PathTracer first(test::gaussian_relief(512, gradient, 16.0, 1)),
        second(test::gaussian_relief(512, gradient, 16.0, 2));
    PathTracer third(test::gaussian_relief(512, gradient, 16.0, 3)),
        fourth(test::gaussian_relief(512, gradient, 16.0, 4));
    for (const Material& material : {Material{Mirror{}}, Material{Dielectric{1.5}}})
      for (const double theta : {0.0, 30.0, 60.0, 75.0})
        smith_row({&first, &second, &third, &fourth}, gradient, material, theta);
  }
}

const std::map<std::string, std::function<void()>> studies = {
    {"furnace", furnace}, {"reciprocity", reciprocity}, {"coverage", coverage}, {"smith", smith}};

}  // namespace
}  // namespace mezzotint

int main(int argc, char** argv) {
  const auto found = argc == 2 ? mezzotint::studies.find(argv[1]) : mezzotint::studies.end();
  if (found == mezzotint::studies.end()) {
    fmt::print("usage: physics_study NAME, one of:");
    for (const auto& [name, study] : mezzotint::studies) fmt::print(" {}", name);
    fmt::print("\n");
    return 2;
  }
  found->second();
  return 0;
}
