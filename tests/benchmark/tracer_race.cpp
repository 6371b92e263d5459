#include "tests/benchmark/tracer_race.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include <fmt/format.h>

#include "tests/benchmark/embree_rival.h"
#include "tests/benchmark/measure.h"
#include "tests/benchmark/noise_relief.h"
#include "tests/benchmark/ray_sets.h"

namespace mezzotint::benchmark {

namespace {

constexpr std::array<double, 3> angles_deg = {0.0, 45.0, 80.0};

// Every `step`-th call from `first` on.
double our_seconds(const HeightFieldTracer& tracer, const RaySet& rays, std::size_t first = 0, std::size_t step = 1) {
  HitBatch hits(rays_per_call);
  RayBatch batch(rays_per_call);
  double sum = 0.0;
  for (std::size_t call = first; call < rays.calls.size(); call += step) {
    batch = rays.calls[call];  // into the cache, where a walk has its rays
    const double before = thread_seconds();
    tracer.closest_hits(batch, batch.size(), hits);
    sum += thread_seconds() - before;
  }
  return sum;
}

struct Rival {
  std::string name;
  std::function<double(const RaySet&)> seconds;
};

std::vector<RaySet> ray_sets(const PeriodicTile& tile, const HeightFieldTracer& tracer, std::uint32_t bits) {
  std::vector<RaySet> sets;
  for (const double theta : angles_deg) sets.push_back(incident_rays(tile, tracer, theta, Start::Front, bits));
  for (std::size_t k = 0; k < angles_deg.size(); ++k) {
    sets.push_back(reflected_rays(sets[k], tracer));
    sets.back().name = fmt::format("secondary {:.0f}°", angles_deg[k]);
  }
  for (const double theta : angles_deg) sets.push_back(incident_rays(tile, tracer, theta, Start::Top, bits));
  return sets;
}

// Rays that end elsewhere than Embree's. Those that leave the tile at its side are left out, and so is the edge of a
// triangle: 2e-3 cells is what single precision makes of a long way.
std::size_t disagreements(const PeriodicTile& tile, const HeightFieldTracer& tracer, const RaySet& rays,
                          const std::vector<float>& distances) {
  std::size_t at = 0, apart = 0;
  HitBatch hits(rays_per_call);
  for (const RayBatch& call : rays.calls) {
    tracer.closest_hits(call, call.size(), hits);
    for (std::size_t k = 0; k < call.size(); ++k, ++at) {
      const bool met = hits.end[k] == RayEnd::Surface, expected = std::isfinite(distances[at]);
      const double way = expected ? double{distances[at]} : 200.0;
      const double x = call.cell_x[k] + double{call.x[k]} + way * double{call.dx[k]};
      const double y = call.cell_y[k] + double{call.y[k]} + way * double{call.dy[k]};
      if (x < 0.0 || y < 0.0 || x > tile.columns() || y > tile.rows()) continue;
      const double z = double{call.z[k]} + way * double{call.dz[k]};
      if (met != expected || (met && std::abs(z - double{hits.z[k]}) > 2e-3)) ++apart;
    }
  }
  return apart;
}

// A tree of triangles takes 170 bytes a cell: at 4096² it would measure the machine's memory.
constexpr std::size_t largest_with_triangles = 2048;

std::vector<Rival> embree_modes(EmbreeRival& grid, EmbreeRival* triangles) {
  std::vector<Rival> modes = {
      {"grid I1", [&](const RaySet& r) { return grid.seconds(r, Call::One, false); }},
      {"grid I16", [&](const RaySet& r) { return grid.seconds(r, Call::Packet, false); }},
      {"grid I16c", [&](const RaySet& r) { return grid.seconds(r, Call::Packet, true); }},
      {"grid 1M", [&](const RaySet& r) { return grid.seconds(r, Call::Stream, false); }},
      {"grid 1Mc", [&](const RaySet& r) { return grid.seconds(r, Call::Stream, true); }},
  };
  if (triangles != nullptr)
    modes.push_back({"tri I16c", [=](const RaySet& r) { return triangles->seconds(r, Call::Packet, true); }});
  return modes;
}

// One line of the table: rivals turn by turn, so that a change of load meets all of them.
nlohmann::json race_with(const RaySet& rays, const std::vector<Rival>& rivals, int repetitions) {
  std::vector<std::vector<double>> rates(rivals.size()), ratios(rivals.size());
  for (int repetition = 0; repetition < repetitions; ++repetition) {
    for (std::size_t k = 0; k < rivals.size(); ++k) {
      rates[k].push_back(1e-6 * static_cast<double>(rays.size()) / rivals[k].seconds(rays));
      ratios[k].push_back(rates[0].back() / rates[k].back());
    }
  }
  nlohmann::json row = {{"rays", rays.name}, {"count", rays.size()}};
  double least = HUGE_VAL;
  fmt::print("{:14}", rays.name);
  for (std::size_t k = 0; k < rivals.size(); ++k) {
    fmt::print("{:>10.1f}", median(rates[k]));
    row["mrays_per_s"][rivals[k].name] = median(rates[k]);
    if (k > 0) least = std::min(least, median(ratios[k]));
  }
  if (rivals.size() > 1) row["ours_over_best"] = least;
  return row;
}

void print_head(const RaceOptions& options, const PeriodicTile& tile, const std::vector<Rival>& rivals) {
  fmt::print(
      "\n{0}² cells, s = {1}, {2:.1f} cells high, 2^{3} rays, Mrays/s on one thread (c: COHERENT), median of {4}\n",
      options.size, options.gradient, 2.0 * tile.highest(), options.bits, options.repetitions);
  fmt::print("{:14}", "rays");
  for (const Rival& rival : rivals) fmt::print("{:>10}", rival.name);
  fmt::print("{}\n", options.embree ? " ours ÷ best   apart" : "");
}

}  // namespace

nlohmann::json race(const RaceOptions& options) {
  const PeriodicTile tile(noise_relief(options.size, options.gradient));
  const HeightFieldTracer tracer(tile);
  std::optional<EmbreeRival> grid, triangles;
  std::vector<Rival> rivals = {{"ours", [&](const RaySet& r) { return our_seconds(tracer, r); }}};
  if (options.embree) {
    grid.emplace(tile, Mesh::Grid);
    if (options.size <= largest_with_triangles) triangles.emplace(tile, Mesh::Triangles);
    for (Rival& mode : embree_modes(*grid, triangles ? &*triangles : nullptr)) rivals.push_back(std::move(mode));
  }
  print_head(options, tile, rivals);
  nlohmann::json rows = nlohmann::json::array();
  for (const RaySet& rays : ray_sets(tile, tracer, options.bits)) {
    nlohmann::json row = race_with(rays, rivals, options.repetitions);
    if (options.embree) {
      std::vector<float> distances;
      (void)grid->seconds(rays, Call::One, false, &distances);
      row["apart"] = disagreements(tile, tracer, rays, distances);
      fmt::print("{:>12.2f}{:>8}", row["ours_over_best"].get<double>(), row["apart"].get<std::size_t>());
    }
    fmt::print("\n");
    std::fflush(stdout);
    rows.push_back(row);
  }
  return {{"cells", options.size}, {"rms_gradient", options.gradient}, {"rows", rows}};
}

nlohmann::json race_two_threads(const RaceOptions& options) {
  const PeriodicTile tile(noise_relief(options.size, options.gradient));
  const HeightFieldTracer tracer(tile);
  fmt::print("\nTwo threads, {}² cells: time of one ÷ time of the slower of two\n", options.size);
  nlohmann::json rows = nlohmann::json::array();
  for (const RaySet& rays : ray_sets(tile, tracer, options.bits)) {
    std::vector<double> factors;
    for (int repetition = 0; repetition < options.repetitions; ++repetition) {
      std::array<double, 2> seconds{};
      const double alone = our_seconds(tracer, rays);
      std::thread second([&] { seconds[1] = our_seconds(tracer, rays, 1, 2); });
      seconds[0] = our_seconds(tracer, rays, 0, 2);
      second.join();
      factors.push_back(alone / std::max(seconds[0], seconds[1]));
    }
    fmt::print("{:14}{:>8.2f}\n", rays.name, median(factors));
    rows.push_back({{"rays", rays.name}, {"factor", median(factors)}});
  }
  return {{"cells", options.size}, {"rows", rows}};
}

}  // namespace mezzotint::benchmark
