#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "forward/base/random.h"
#include "forward/scattering/batch_tally.h"
#include "forward/scattering/correction_plan.h"
#include "forward/scattering/incident_light.h"
#include "forward/scattering/interaction_batch.h"
#include "forward/scattering/path_branch.h"
#include "forward/scattering/path_tracing.h"
#include "forward/tracing/periodic_tile.h"
#include "forward/tracing/relief_tracer.h"

namespace mezzotint {

/// Paths on their way: their rays and what they carry, all after the same number of interactions.
struct PathBatch {
  // Room for a vector more than asked for, as in RayBatch.
  explicit PathBatch(std::size_t capacity)
      : rays(capacity),
        weight(capacity + 16),
        bin(capacity + 16),
        number(capacity + 16),
        branch(capacity + 16),
        in_splat(capacity) {}
  RayBatch rays;
  std::vector<float> weight;
  std::vector<std::uint32_t> bin;      ///< of the map, should nothing stand in the way
  std::vector<std::uint64_t> number;   ///< of the first ray, among all rays of the run: names its random numbers
  std::vector<std::uint8_t> branch;    ///< 0 was reflected first, 1 refracted: they draw different random numbers
  std::vector<std::uint8_t> in_splat;  ///< first ones of a correction: the splat took this light for gone
  std::vector<float> slides_factor;    ///< (ω·m) at the last interaction; Estimator::Slides alone fills it
  std::size_t count = 0;
};

/// So many first rays are followed together: their paths fit into a core's own cache.
inline constexpr std::size_t rays_together = 4096;

/// What one thread needs for a walk.
struct WalkSpace {
  AimedRays aimed{rays_together};
  HitBatch hits{4 * rays_together};
  HitBatch shadows{rays_together};
  InteractionBatch met{4 * rays_together};
  std::array<PathBatch, 2> paths = {PathBatch(4 * rays_together), PathBatch(4 * rays_together)};
  EndLists ends{4 * rays_together};
  std::vector<float> start_weight = std::vector<float>(rays_together + 16);
  std::vector<float> branch_weight = std::vector<float>(rays_together + 16);
  std::vector<std::uint8_t> lit = std::vector<std::uint8_t>(rays_together);
  std::vector<std::uint8_t> escapes = std::vector<std::uint8_t>(rays_together);
  SurfacePoints points{rays_together};
};

/// Follows light from its first ray to where it ends, many paths at a time. Knows nothing of how rays find facets.
class PathWalker {
public:
  /// All that is given must outlive the walker. Without a relief only `walk` can be used.
  PathWalker(const SceneFrame& frame, const PeriodicTile* relief, const ReliefTracer& tracer,
             const PathTracingOptions& options);

  /// The light of strata first … first + count − 1, each of weight 1.
  void walk(const IncidentLight& light, const SampleStrata& strata, std::uint64_t first, std::uint64_t first_index,
            std::size_t count, WalkSpace& space, BatchTally& tally) const;

  /// What the splat leaves out, from points of the surface: the light of those that are lit and were not taken for it,
  /// or the other way round; and for lit ones the light of further interactions, minus what the splat took them for.
  /// The points of strata first … first + count − 1 of the plan's density.
  void correct(const CorrectionPlan& plan, const SampleStrata& strata, std::uint64_t first, std::uint64_t first_index,
               std::size_t count, WalkSpace& space, BatchTally& tally) const;

  /// What becomes of points of the surface up to the next interaction, for a pilot; `outcomes` know their cells.
  void probe(std::span<const double> x, std::span<const double> y, WalkSpace& space,
             std::span<PilotOutcome> outcomes) const;

  /// Judges the cells of some rows: whether the light that they reflect meets the surface again.
  void look_ahead(std::uint32_t first_row, std::uint32_t end_row, CorrectionPlan& plan, WalkSpace& space) const;

  /// Dense splat of one row of facets: each sends the light that its slope alone would catch straight out. All rows
  /// together are exact for geometric normals: no noise at all.
  /// @param plan        for the shares that are lit; nullptr: all are.
  /// @param importance  of the row's cells, filled where a plan is given that is not quiet.
  void splat_row(std::uint32_t row, const CorrectionPlan* plan, WalkSpace& space, BatchTally& tally,
                 std::span<float> importance) const;

private:
  enum class First { Counts, InSplat };  ///< whether light that leaves after one interaction is to be added
  void interact(const RayBatch& rays, std::size_t count, WalkSpace& space) const;
  void split(const RayBatch& rays, std::size_t count, std::uint64_t first_index, WalkSpace& space,
             BatchTally& tally) const;
  void split_by_choice(std::size_t count, std::uint64_t first_index, WalkSpace& space, BatchTally& tally) const;
  void split_by_weight(std::size_t count, std::uint64_t first_index, WalkSpace& space, BatchTally& tally) const;
  void follow(First first, WalkSpace& space, BatchTally& tally) const;
  void end_left_out(const PathBatch& paths, const WalkSpace& space, BatchTally& tally) const;
  void end_all(const PathBatch& paths, std::uint32_t order, const WalkSpace& space, BatchTally& tally) const;
  void meet_all(First first, const PathBatch& paths, std::uint32_t order, WalkSpace& space, PathBatch& next,
                BatchTally& tally) const;
  void meet_again(const PathBatch& paths, std::size_t k, std::uint32_t order, WalkSpace& space, PathBatch& next,
                  BatchTally& tally) const;
  void place_on_surface(std::size_t count, WalkSpace& space) const;
  void set_importance(const CorrectionPlan& plan, std::size_t first_cell, std::size_t count, const WalkSpace& space,
                      std::span<float> importance) const;
  void splat_one(const WalkSpace& space, std::size_t k, bool escapes, float weight, BatchTally& tally) const;
  void shine(std::size_t count, WalkSpace& space) const;
  void find_lit(std::size_t count, WalkSpace& space) const;
  [[nodiscard]] double attenuation(const RayBatch& rays, std::size_t k, double end_height) const;
  [[nodiscard]] double attenuation_to(const HitBatch& hits, const RayBatch& rays, std::size_t k) const;

  SceneFrame frame_;
  const PeriodicTile* tile_;  ///< nullptr for a mesh
  const ReliefTracer& tracer_;
  const PathTracingOptions& options_;
  RandomStream choices_;
  Direction to_light_;
  double absorption_per_cell_ = 0.0;
};

}  // namespace mezzotint
