#include "forward/bsdf_table/build_bsdf_table.h"

#include <algorithm>
#include <utility>

#include "forward/base/error.h"
#include "forward/bsdf_table/incidence_refinement.h"

namespace mezzotint {

namespace {

AdaptiveMap joined(const Bsdf& bsdf, const MapEstimate& map, double tolerance, BsdfTableReport& report) {
  JoinedMap joined = join_smooth_bins(bsdf.grid, map, tolerance);
  report.squares += joined.map.square_count();
  if (!joined.map.empty()) report.bins += bsdf.grid.size();
  report.largest_join_difference = std::max(report.largest_join_difference, joined.difference);
  report.largest_clipped_share = std::max(report.largest_clipped_share, joined.clipped_share);
  return std::move(joined.map);
}

}  // namespace

BuiltBsdfTable build_bsdf_table(const ComputeBsdf& compute, const BsdfTableOptions& options, const Progress& progress,
                                const FindBsdf& find) {
  require(options.join_tolerance >= 0.0 && options.join_tolerance < 1.0,
          "the tolerance of joining bins lies in [0, 1)");
  RefinedIncidences refined = refine_incidences(compute, options, progress, find);
  BuiltBsdfTable built{{}, refined.report};
  BsdfTable& table = built.table;
  table.grid = refined.nodes.front().grid;
  table.relative_index = options.relative_index;
  table.provenance = refined.nodes.front().provenance;
  table.incidences = refined.grid;
  // Nodes in the order of the grid, in place of that of the search.
  for (IncidenceRing& ring : table.incidences.rings) {
    for (std::size_t& node : ring.nodes) {
      const Bsdf& bsdf = refined.nodes[node];
      node = table.nodes.size();
      table.nodes.push_back({bsdf.incidence, bsdf.energy,
                             joined(bsdf, bsdf.reflection, options.join_tolerance, built.report),
                             joined(bsdf, bsdf.transmission, options.join_tolerance, built.report)});
    }
  }
  require_valid(table);
  report(progress, "bsdf table", 1.0);
  return built;
}

}  // namespace mezzotint
