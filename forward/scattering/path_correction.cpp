// The part of PathWalker that knows the splat: points of the surface, what the splat takes for granted, and the paths
// that put it right.

#include <algorithm>
#include <cmath>
#include <span>

#include "forward/scattering/path_steps.h"
#include "forward/scattering/path_walk.h"

namespace mezzotint {

// Hits, as if light had come to the points of `space` without being shadowed.
void PathWalker::place_on_surface(std::size_t count, WalkSpace& space) const {
  HitBatch& hits = space.hits;
  const SurfacePoints& points = space.points;
  const auto per_y = static_cast<float>(1.0 / tile_->cell_y());  // to the same bits as in the splat
  for (std::size_t k = 0; k < count; ++k) {
    const auto column = static_cast<std::uint32_t>(points.cell_x[k]),
               row = static_cast<std::uint32_t>(points.cell_y[k]);
    const float in_x = points.x[k], in_y = points.y[k];
    const std::uint32_t right = column + 1 == tile_->columns() ? 0 : column + 1;
    const std::uint32_t upper = row + 1 == tile_->rows() ? 0 : row + 1;
    const float z00 = tile_->height(column, row), z11 = tile_->height(right, upper);
    const bool lower_half = in_x > in_y;
    const float corner = lower_half ? tile_->height(right, row) : tile_->height(column, upper);
    const float a = lower_half ? corner - z00 : z11 - corner, b = lower_half ? z11 - corner : corner - z00;
    hits.end[k] = RayEnd::Surface;
    hits.cell_x[k] = points.cell_x[k];
    hits.cell_y[k] = points.cell_y[k];
    hits.x[k] = in_x;
    hits.y[k] = in_y;
    hits.z[k] = z00 + (a * in_x + b * in_y);
    hits.slope_x[k] = a;
    hits.slope_y[k] = b * per_y;
    hits.triangle[k] = lower_half ? 0 : 1;
  }
}

void PathWalker::correct(const CorrectionPlan& plan, const SampleStrata& strata, std::uint64_t first,
                         std::uint64_t first_index, std::size_t count, WalkSpace& space, BatchTally& tally) const {
  plan.density().points(strata, first, count, space.points);
  place_on_surface(count, space);
  shine(count, space);
  interact_geometric(options_.material, options_.grid, space.aimed.rays, space.hits, count, space.met);
  find_lit(count, space);
  double absorbed_in_splat = 0.0;
  for (std::size_t k = 0; k < count; ++k) {
    float& weight = space.start_weight[k];
    if (weight == 0.0F) continue;
    weight *= space.points.weight[k];
    const std::size_t cell = static_cast<std::size_t>(space.hits.cell_y[k]) * tile_->columns() +
                             static_cast<std::size_t>(space.hits.cell_x[k]);
    const float wrong = (space.lit[k] != 0 ? 1.0F : 0.0F) - plan.lit_share(cell);
    const bool escapes = plan.escapes(cell, space.met.reflected_z[k]);
    space.escapes[k] = escapes ? 1 : 0;
    if (wrong != 0.0F) splat_one(space, k, escapes, weight * wrong, tally);
    if (space.lit[k] == 0) weight = 0.0F;
    if (space.met.refracts[k] == 0) absorbed_in_splat += double{weight * (1.0F - space.met.reflectance[k])};
  }
  split(space.aimed.rays, count, first_index, space, tally);
  tally.add(Fate::Absorbed, -absorbed_in_splat);
  PathBatch& paths = space.paths[0];
  for (std::size_t k = 0; k < paths.count; ++k)
    paths.in_splat[k] = paths.branch[k] != 0 || space.escapes[paths.number[k] - first_index] != 0 ? 1 : 0;
  follow(First::InSplat, space, tally);
}

void PathWalker::probe(std::span<const double> x, std::span<const double> y, WalkSpace& space,
                       std::span<PilotOutcome> outcomes) const {
  const std::size_t count = outcomes.size();
  for (std::size_t k = 0; k < count; ++k) {
    space.points.cell_x[k] = static_cast<std::int32_t>(outcomes[k].column);
    space.points.cell_y[k] = static_cast<std::int32_t>(outcomes[k].row);
    space.points.x[k] = static_cast<float>(x[k]);
    space.points.y[k] = static_cast<float>(y[k]);
  }
  place_on_surface(count, space);
  shine(count, space);
  interact_geometric(options_.material, options_.grid, space.aimed.rays, space.hits, count, space.met);
  find_lit(count, space);
  PathBatch& next = space.paths[0];
  next.count = 0;
  for (std::size_t k = 0; k < count; ++k) {
    PilotOutcome& one = outcomes[k];
    const float weight = space.start_weight[k], share = space.met.reflectance[k];
    one.faces_light = weight > 0.0F;
    one.lit = space.lit[k] != 0;
    one.way_up = space.met.reflected_z[k];
    one.reflected = weight * share;
    const bool refracts = space.met.refracts[k] != 0;
    one.refracted = refracts ? weight * (1.0F - share) : 0.0F;
    if (one.lit) push(space, k, Branch::Reflected, Side::Outside, 1.0F, k, 0, next);
    if (one.lit && refracts) push(space, k, Branch::Refracted, Side::Inside, 1.0F, k, 1, next);
  }
  tracer_.closest_hits(next.rays, next.count, space.hits);
  for (std::size_t k = 0; k < next.count; ++k) {
    PilotOutcome& one = outcomes[next.number[k]];
    (next.branch[k] == 0 ? one.reflected_met : one.refracted_met) = space.hits.end[k] == RayEnd::Surface;
  }
  interact_geometric(options_.material, options_.grid, next.rays, space.hits, next.count, space.met);
  for (std::size_t k = 0; k < next.count; ++k) {
    if (next.branch[k] == 0 && space.hits.end[k] == RayEnd::Surface)
      outcomes[next.number[k]].reflected_on = space.met.reflectance[k];
  }
}

// Rays from the points that face the light towards it.
void PathWalker::find_lit(std::size_t count, WalkSpace& space) const {
  PathBatch& next = space.paths[0];
  next.count = 0;
  for (std::size_t k = 0; k < count; ++k) {
    space.lit[k] = 0;
    if (space.start_weight[k] == 0.0F) continue;
    push(space, k, Branch::Reflected, Side::Outside, 1.0F, k, 0, next);
    const std::size_t at = next.count - 1;
    next.rays.dx[at] = static_cast<float>(to_light_.x());
    next.rays.dy[at] = static_cast<float>(to_light_.y());
    next.rays.dz[at] = static_cast<float>(to_light_.z());
  }
  HitBatch& shadows = space.shadows;
  tracer_.closest_hits(next.rays, next.count, shadows);
  for (std::size_t k = 0; k < next.count; ++k) {
    if (shadows.end[k] == RayEnd::Above) space.lit[next.number[k]] = 1;
  }
}

// The light of one interaction as the splat sees it; with a negative weight, to take it back.
void PathWalker::splat_one(const WalkSpace& space, std::size_t k, bool escapes, float weight, BatchTally& tally) const {
  const InteractionBatch& met = space.met;
  const float share = met.reflectance[k];
  if (share > 0.0F && escapes)
    leave_unhindered(Branch::Reflected, met.reflected_z[k], met.reflected_bin[k], double{weight * share}, tally);
  const double rest = double{weight * (1.0F - share)};
  if (met.refracts[k] == 0) return tally.add(Fate::Absorbed, rest);
  leave_unhindered(Branch::Refracted, met.refracted_z[k], met.refracted_bin[k], rest, tally);
}

void PathWalker::splat_row(std::uint32_t row, const CorrectionPlan* plan, WalkSpace& space, BatchTally& tally,
                           std::span<float> importance) const {
  const std::uint32_t upper = row + 1 == tile_->rows() ? 0 : row + 1;
  const auto per_y = static_cast<float>(1.0 / tile_->cell_y());
  for (std::uint32_t begin = 0; begin < tile_->columns(); begin += rays_together / 2) {
    const std::uint32_t end = std::min<std::uint32_t>(tile_->columns(), begin + rays_together / 2);
    std::size_t count = 0;
    for (std::uint32_t column = begin; column < end; ++column) {
      const std::uint32_t right = column + 1 == tile_->columns() ? 0 : column + 1;
      const float z00 = tile_->height(column, row), z10 = tile_->height(right, row);
      const float z01 = tile_->height(column, upper), z11 = tile_->height(right, upper);
      space.hits.slope_x[count] = z10 - z00;
      space.hits.slope_y[count++] = (z11 - z10) * per_y;
      space.hits.slope_x[count] = z11 - z01;
      space.hits.slope_y[count++] = (z01 - z00) * per_y;
    }
    shine(count, space);
    interact_geometric(options_.material, options_.grid, space.aimed.rays, space.hits, count, space.met);
    const std::size_t first_cell = std::size_t{row} * tile_->columns() + begin;
    if (plan != nullptr && !plan->quiet()) set_importance(*plan, first_cell, count, space, importance.subspan(begin));
    for (std::size_t k = 0; k < count; ++k) {
      const float weight = space.start_weight[k];
      if (weight == 0.0F) continue;
      const std::size_t cell = first_cell + k / 2;
      const float lit = plan == nullptr ? 1.0F : plan->lit_share(cell);
      const bool escapes = plan == nullptr || plan->escapes(cell, space.met.reflected_z[k]);
      if (lit > 0.0F) splat_one(space, k, escapes, weight * lit, tally);
    }
  }
}

// Of some cells, two facets each: the root mean square of what a point is likely to change.
void PathWalker::set_importance(const CorrectionPlan& plan, std::size_t first_cell, std::size_t count,
                                const WalkSpace& space, std::span<float> importance) const {
  for (std::size_t k = 0; k < count; k += 2) {
    float square = 0.0F;
    for (const std::size_t facet : {k, k + 1}) {
      const float weight = space.start_weight[facet], share = space.met.reflectance[facet];
      if (weight == 0.0F) continue;
      const float refracted = space.met.refracts[facet] != 0 ? weight * (1.0F - share) : 0.0F;
      square += plan.likely_square(first_cell + k / 2, space.met.reflected_z[facet], weight * share, refracted);
    }
    importance[k / 2] = std::sqrt(0.5F * square);
  }
}

void PathWalker::look_ahead(std::uint32_t first_row, std::uint32_t end_row, CorrectionPlan& plan,
                            WalkSpace& space) const {
  PathBatch& next = space.paths[0];
  next.count = 0;
  const auto decide = [&] {
    tracer_.closest_hits(next.rays, next.count, space.shadows);
    for (std::size_t k = 0; k < next.count; ++k) plan.decide(next.number[k], space.shadows.end[k] == RayEnd::Surface);
    next.count = 0;
  };
  for (std::uint32_t row = first_row; row < end_row; ++row) {
    for (std::uint32_t begin = 0; begin < tile_->columns(); begin += rays_together) {
      const auto count = std::min<std::size_t>(rays_together, tile_->columns() - begin);
      for (std::size_t k = 0; k < count; ++k) {
        // The middle of the lower half stands for the cell.
        space.points.cell_x[k] = static_cast<std::int32_t>(begin + k);
        space.points.cell_y[k] = static_cast<std::int32_t>(row);
        space.points.x[k] = 2.0F / 3.0F;
        space.points.y[k] = 1.0F / 3.0F;
      }
      place_on_surface(count, space);
      shine(count, space);
      interact_geometric(options_.material, options_.grid, space.aimed.rays, space.hits, count, space.met);
      for (std::size_t k = 0; k < count; ++k) {
        const auto column = static_cast<std::uint32_t>(begin + k);
        if (plan.judge(column, row, space.met.reflected_z[k])) continue;
        push(space, k, Branch::Reflected, Side::Outside, 1.0F, std::size_t{row} * tile_->columns() + column, 0, next);
        if (next.count == rays_together) decide();
      }
    }
  }
  decide();
}

// The beam at the facets of `space.hits`, and the light that each catches for each light on its macro area.
void PathWalker::shine(std::size_t count, WalkSpace& space) const {
  RayBatch& rays = space.aimed.rays;
  const HitBatch& hits = space.hits;
  const auto lx = static_cast<float>(to_light_.x()), ly = static_cast<float>(to_light_.y());
  const auto lz = static_cast<float>(to_light_.z());
  for (std::size_t k = 0; k < count; ++k) {
    rays.dx[k] = -lx;
    rays.dy[k] = -ly;
    rays.dz[k] = -lz;
    rays.side[k] = Side::Outside;
    space.start_weight[k] = std::max(0.0F, (lz - hits.slope_x[k] * lx - hits.slope_y[k] * ly) / lz);
  }
}

}  // namespace mezzotint
