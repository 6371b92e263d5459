#pragma once

#include <functional>
#include <optional>

#include "forward/base/progress.h"
#include "forward/bsdf_table/bsdf_table.h"

namespace mezzotint {

struct BsdfTableOptions {
  BsdfSymmetry symmetry;
  Angle largest_theta = Angle::from_degrees(85.0);
  std::size_t coarse_rings = 4;     ///< equally far in sinθ, from the normal to the largest θ; 2 at least
  std::size_t coarse_azimuths = 5;  ///< of each ring, where not isotropic; both ends of a range that ends at mirrors
  /// Of the reflection (and transmission) map halfway between nodes: relative_l2 without noise. It holds the finite
  /// size of the bins too: for lobes of a few bins' width ask for no less than 0.1.
  double tolerance = 0.05;
  std::size_t most_incidences = 64;
  double join_tolerance = 0.01;  ///< of joining outgoing bins, a map; 0 joins empty ones only
  double relative_index = 1.5;   ///< of the medium below, for transmission
};

/// What a table cost, and how well it holds.
struct BsdfTableReport {
  std::size_t incidences = 0;
  std::size_t computed = 0;  ///< of these; the others came from the cache
  /// The largest difference between a computed map and what its neighbours made of it, over the intervals as they were
  /// last tried: those of the final table are half as wide, so theirs is smaller (smooth: a fourth).
  double largest_difference = 0.0;
  std::size_t untried = 0;            ///< intervals that the budget left open
  std::size_t stalled = 0;            ///< intervals above the tolerance, where halving helps no more
  bool met = false;                   ///< every interval was tried and is within the tolerance
  std::size_t squares = 0, bins = 0;  ///< stored values of all maps, and what they were joined from
  double largest_join_difference = 0.0;
  double largest_clipped_share = 0.0;  ///< of a map's light, in bins that noise made negative
};

using ComputeBsdf = std::function<Bsdf(const DirectionAngles& to_light)>;
using FindBsdf = std::function<std::optional<Bsdf>(const DirectionAngles& to_light)>;

/// Builds a table by asking `compute` for one direction of the light after the other.
///
/// How      From coarse rings on, the interval that was worst so far is halved: its middle is computed, compared with
///          what its neighbours make of it, and kept as a node either way. Whether lobes follow θ between two rings is
///          chosen there, by what comes closer. An interval rests when the difference is
///          within the tolerance, or no clear noise; it is given up when halving brings less than a fifth. A halved
///          interval of θ costs a ring: coarse_azimuths directions. Each halved interval of a ring costs one.
/// Resume   `find` is asked first. The order of questions depends on the answers alone, so a run that is started again
///          with what an earlier one computed goes on where that ended, to the same bits.
/// Memory   the full maps of all nodes are kept until the end: 32 bytes a bin and node, twice with transmission.
/// @throws InvalidInput for bad options, or a budget below the coarse nodes; for a Bsdf of another grid than the first
///         or maps that do not fit it; and what `compute`, `find` and `progress` throw.
struct BuiltBsdfTable {
  BsdfTable table;
  BsdfTableReport report;
};
[[nodiscard]] BuiltBsdfTable build_bsdf_table(const ComputeBsdf& compute, const BsdfTableOptions& options,
                                              const Progress& progress = {}, const FindBsdf& find = {});

/// A map between nodes, before bins are joined: mean, error and halves, averaged over the bins of its grid at 4 × 4
/// points each. `nodes` are numbered as in the grid of incidences. With `warp` off, the nodes' maps are added where
/// they stand (cross-fade): two lobes in place of one; for comparisons.
/// @pre the light stands above the horizon, and all nodes have one grid
[[nodiscard]] MapEstimate interpolated_reflection(const IncidenceGrid& incidences, const std::vector<Bsdf>& nodes,
                                                  const DirectionAngles& to_light, bool warp = true);
[[nodiscard]] MapEstimate interpolated_transmission(const IncidenceGrid& incidences, const std::vector<Bsdf>& nodes,
                                                    const DirectionAngles& to_light, double relative_index);

}  // namespace mezzotint
