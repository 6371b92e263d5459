#include "forward/scattering/planned_splat.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include "forward/scattering/light_sweep.h"
#include "forward/scattering/path_walk.h"

namespace mezzotint {

namespace {

// The splat's rows are summed in so many groups, whatever the number of threads.
constexpr std::uint32_t groups = 16;

using Spaces = tbb::enumerable_thread_specific<WalkSpace>;

struct Rows {
  std::uint32_t first, end;
};
Rows rows_of_group(const PeriodicTile& tile, std::uint32_t group) {
  const std::uint64_t rows = tile.rows();
  return {static_cast<std::uint32_t>(rows * group / groups), static_cast<std::uint32_t>(rows * (group + 1) / groups)};
}

/// @param importance  of all cells, filled where there is a plan.
BatchTally splat_rows(const PeriodicTile& tile, const PathWalker& walker, const PathTracingOptions& options,
                      const CorrectionPlan* plan, std::span<float> importance, Spaces& spaces) {
  std::vector<BatchTally> sums(groups, empty_tally(options));
  tbb::parallel_for(std::uint32_t{0}, groups, [&](std::uint32_t group) {
    const Rows rows = rows_of_group(tile, group);
    for (std::uint32_t row = rows.first; row < rows.end; ++row) {
      const std::size_t first = plan == nullptr ? 0 : std::size_t{row} * tile.columns();
      walker.splat_row(row, plan, spaces.local(), sums[group], importance.subspan(first));
      sums[group].close_slice();
    }
  });
  BatchTally all = empty_tally(options);
  for (const BatchTally& sum : sums) all.add(sum);
  return all;
}

// A point anywhere in every block of the plan's grid. The same for every seed: the density is no part of the chance.
std::vector<PilotOutcome> send_pilot(const PeriodicTile& tile, const PathWalker& walker, Spaces& spaces) {
  const CorrectionPlan::PilotGrid grid = CorrectionPlan::pilot_grid(tile);
  std::vector<PilotOutcome> outcomes(std::size_t{grid.columns} * grid.rows);
  const RandomStream random(0, RandomPurpose::Pilot);
  const std::size_t bands = (outcomes.size() + rays_together - 1) / rays_together;
  tbb::parallel_for(std::size_t{0}, bands, [&](std::size_t band) {
    const std::size_t first = band * rays_together, count = std::min(rays_together, outcomes.size() - first);
    std::vector<double> x(count), y(count);
    for (std::size_t k = 0; k < count; ++k) {
      const auto column = static_cast<std::uint32_t>((first + k) % grid.columns);
      const auto row = static_cast<std::uint32_t>((first + k) / grid.columns);
      const auto u = random.uniform4(first + k);
      const double at_x = CorrectionPlan::block * u[0], at_y = CorrectionPlan::block * u[1];
      PilotOutcome& one = outcomes[first + k];
      one.column = std::min(tile.columns() - 1, CorrectionPlan::block * column + static_cast<std::uint32_t>(at_x));
      one.row = std::min(tile.rows() - 1, CorrectionPlan::block * row + static_cast<std::uint32_t>(at_y));
      x[k] = at_x - std::floor(at_x);
      y[k] = at_y - std::floor(at_y);
    }
    walker.probe(x, y, spaces.local(), std::span(outcomes).subspan(first, count));
  });
  return outcomes;
}

}  // namespace

BatchTally empty_tally(const PathTracingOptions& options) {
  BatchTally empty(options.grid);
  if (options.bounce_orders > 0) empty.keep_orders(options.bounce_orders);
  return empty;
}

BatchTally splat_all(const PeriodicTile& tile, const ReliefTracer& tracer, const PathTracingOptions& options) {
  Spaces spaces;
  return splat_rows(tile, PathWalker(tile.frame(), &tile, tracer, options), options, nullptr, {}, spaces);
}

PlannedSplat plan_splat(const PeriodicTile& tile, const ReliefTracer& tracer, const PathTracingOptions& options) {
  const PathWalker walker(tile.frame(), &tile, tracer, options);
  Spaces spaces;
  const std::vector<PilotOutcome> pilot = send_pilot(tile, walker, spaces);
  CorrectionPlan plan(tile, sweep_light(tile, to_direction(options.incidence)), pilot);
  if (!plan.quiet()) {
    tbb::parallel_for(std::uint32_t{0}, groups, [&](std::uint32_t group) {
      const Rows rows = rows_of_group(tile, group);
      walker.look_ahead(rows.first, rows.end, plan, spaces.local());
    });
    plan.learn_doubt(pilot);
  }
  std::vector<float> importance(std::size_t{tile.columns()} * tile.rows(), 1.0F);
  BatchTally splat = splat_rows(tile, walker, options, &plan, importance, spaces);
  plan.set_density(std::move(importance));
  return {std::move(plan), std::move(splat)};
}

}  // namespace mezzotint
