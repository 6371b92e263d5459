#include "forward/scattering/path_walk.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace mezzotint {

namespace {

Side other(Side side) { return side == Side::Outside ? Side::Inside : Side::Outside; }

void leak(double weight, BatchTally& tally) {
  tally.add(Fate::CutOff, weight);
  tally.leaked += weight;
}

enum class Branch { Reflected, Refracted };

bool is_exit(RayEnd end, Side side) { return end == (side == Side::Outside ? RayEnd::Above : RayEnd::Below); }

// Light from a facet into the open, whatever stands in its way: the splat.
void leave_unhindered(Branch branch, float way_z, std::uint32_t bin, double weight, BatchTally& tally) {
  const bool up = branch == Branch::Reflected;
  if (up ? way_z <= 0.0F : way_z >= 0.0F) return;
  tally.leave(up ? Fate::Reflected : Fate::Transmitted, bin, weight, 1);
}

// The path that goes on from hit k.
void push(const WalkSpace& space, std::size_t k, Branch branch, Side side, float weight, std::uint64_t number,
          std::uint8_t first_branch, PathBatch& next) {
  const HitBatch& hits = space.hits;
  const InteractionBatch& met = space.met;
  const std::size_t at = next.count++;
  RayBatch& rays = next.rays;
  rays.cell_x[at] = hits.cell_x[k];
  rays.cell_y[at] = hits.cell_y[k];
  rays.x[at] = hits.x[k];
  rays.y[at] = hits.y[k];
  rays.z[at] = hits.z[k];
  const bool reflected = branch == Branch::Reflected;
  rays.dx[at] = reflected ? met.reflected_x[k] : met.refracted_x[k];
  rays.dy[at] = reflected ? met.reflected_y[k] : met.refracted_y[k];
  rays.dz[at] = reflected ? met.reflected_z[k] : met.refracted_z[k];
  rays.side[at] = side;
  rays.left[at] = hits.triangle[k];
  next.weight[at] = weight;
  next.bin[at] = reflected ? met.reflected_bin[k] : met.refracted_bin[k];
  next.number[at] = number;
  next.branch[at] = first_branch;
}

// The cosine of a path's way about the normal of the facet that it leaves: the same as that of its arrival.
float departure_cosine(const HitBatch& hits, const RayBatch& rays, std::size_t k) {
  const float a = hits.slope_x[k], b = hits.slope_y[k];
  return std::abs(rays.dz[k] - a * rays.dx[k] - b * rays.dy[k]) / std::sqrt(1.0F + a * a + b * b);
}

}  // namespace

PathWalker::PathWalker(const PeriodicTile& tile, const ReliefTracer& tracer, const PathTracingOptions& options)
    : tile_(tile),
      tracer_(tracer),
      options_(options),
      choices_(options.seed, RandomPurpose::RayChoice),
      to_light_(to_direction(options.incidence)) {
  if (const auto* clear = std::get_if<Dielectric>(&options.material)) {
    absorption_per_cell_ = clear->absorption_per_um * tile.unit_um();
  }
}

void PathWalker::interact(const RayBatch& rays, std::size_t count, WalkSpace& space) const {
  if (options_.normals == NormalKind::Geometric) {
    interact_geometric(options_.material, options_.grid, rays, space.hits, count, space.met);
  } else {
    interact_one_by_one(tile_, options_.material, options_.grid, options_.normals, rays, space.hits, count, space.met);
  }
}

void PathWalker::walk(const IncidentLight& light, const SampleStrata& strata, std::uint64_t first,
                      std::uint64_t first_index, std::size_t count, WalkSpace& space, BatchTally& tally) const {
  light.fill(strata, first, first_index, count, space.aimed);
  const RayBatch& rays = space.aimed.rays;
  tracer_.closest_hits(rays, count, space.hits);
  interact(rays, count, space);
  for (std::size_t k = 0; k < count; ++k) {
    space.start_weight[k] = 0.0F;
    if (space.hits.end[k] != RayEnd::Surface) {
      leak(1.0, tally);
    } else if (light.met_a_copy(space.aimed, space.hits, k)) {
      tally.add(Fate::LeftSideways, 1.0);
    } else {
      space.start_weight[k] = 1.0F;
    }
  }
  split(rays, count, first_index, space, tally);
  follow(First::Counts, space, tally);
}

// The first interaction: both branches go on, weighted.
void PathWalker::split(const RayBatch& rays, std::size_t count, std::uint64_t first_index, WalkSpace& space,
                       BatchTally& tally) const {
  PathBatch& next = space.paths[0];
  next.count = 0;
  double absorbed = 0.0;
  for (std::size_t k = 0; k < count; ++k) {
    const float weight = space.start_weight[k];
    if (weight == 0.0F) continue;
    ++tally.interactions;
    const float share = space.met.reflectance[k];
    if (options_.roulette_first && space.met.refracts[k] != 0) {
      const bool reflect = choices_.uniform4(first_index + k, 2U << 24)[0] < double{share};
      push(space, k, reflect ? Branch::Reflected : Branch::Refracted, reflect ? Side::Outside : Side::Inside, weight,
           first_index + k, reflect ? 0 : 1, next);
      continue;
    }
    if (share > 0.0F) push(space, k, Branch::Reflected, Side::Outside, weight * share, first_index + k, 0, next);
    if (space.met.refracts[k] != 0) {
      push(space, k, Branch::Refracted, Side::Inside, weight * (1.0F - share), first_index + k, 1, next);
    } else {
      absorbed += double{weight * (1.0F - share)};
    }
  }
  tally.add(Fate::Absorbed, absorbed);
  tally.normal_fallbacks += std::exchange(space.met.normal_fallbacks, 0);
  if (options_.estimator != Estimator::Slides) return;
  next.slides_factor.resize(next.rays.size());
  for (std::size_t k = 0; k < next.count; ++k) {
    const std::size_t hit = static_cast<std::size_t>(next.number[k] - first_index);
    next.slides_factor[k] = departure_cosine(space.hits, rays, hit);
  }
}

void PathWalker::follow(First first, WalkSpace& space, BatchTally& tally) const {
  for (std::uint32_t order = 1; space.paths[(order - 1) % 2].count > 0; ++order) {
    const PathBatch& paths = space.paths[(order - 1) % 2];
    PathBatch& next = space.paths[order % 2];
    next.count = 0;
    tracer_.closest_hits(paths.rays, paths.count, space.hits);
    bool any_hit = false;
    for (std::size_t k = 0; k < paths.count; ++k) {
      const RayEnd end = space.hits.end[k];
      if (end == RayEnd::Surface)
        any_hit = true;
      else if (first == First::Counts || order > 1 || paths.in_splat[k] == 0 || !is_exit(end, paths.rays.side[k]))
        end_path(paths, k, end, order, tally);
    }
    if (!any_hit) continue;
    if (order < options_.max_bounces) interact(paths.rays, paths.count, space);
    for (std::size_t k = 0; k < paths.count; ++k) {
      if (space.hits.end[k] != RayEnd::Surface) continue;
      // The splat took this light for gone; it is not.
      if (first == First::InSplat && order == 1 && paths.in_splat[k] != 0) {
        leave_unhindered(paths.branch[k] == 0 ? Branch::Reflected : Branch::Refracted, paths.rays.dz[k], paths.bin[k],
                         -double{paths.weight[k]}, tally);
      }
      if (order >= options_.max_bounces)
        tally.add(Fate::CutOff, double{paths.weight[k]});
      else
        meet_again(paths, k, order, space, next, tally);
    }
    tally.normal_fallbacks += std::exchange(space.met.normal_fallbacks, 0);
  }
}

void PathWalker::meet_again(const PathBatch& paths, std::size_t k, std::uint32_t order, WalkSpace& space,
                            PathBatch& next, BatchTally& tally) const {
  ++tally.interactions;
  const Side side = paths.rays.side[k];
  const float share = space.met.reflectance[k];
  float weight = paths.weight[k];
  if (side == Side::Inside && absorption_per_cell_ > 0.0) {
    const auto kept = static_cast<float>(attenuation(paths.rays, k, double{space.hits.z[k]}));
    tally.add(Fate::Absorbed, double{weight} - double{weight * kept});
    weight *= kept;
  }
  const std::size_t before = next.count;
  if (space.met.refracts[k] == 0) {
    tally.add(Fate::Absorbed, double{weight} - double{weight * share});
    push(space, k, Branch::Reflected, side, weight * share, paths.number[k], paths.branch[k], next);
  } else if (order == 1 && !options_.roulette_first && options_.estimator == Estimator::Flux) {
    push(space, k, Branch::Reflected, side, weight * share, paths.number[k], paths.branch[k], next);
    push(space, k, Branch::Refracted, other(side), weight * (1.0F - share), paths.number[k],
         static_cast<std::uint8_t>(paths.branch[k] + 2), next);
  } else {
    const double choice =
        choices_.uniform4(paths.number[k], (std::uint32_t{paths.branch[k]} << 24) + order / 4)[order % 4];
    const bool reflect = choice < double{share};
    push(space, k, reflect ? Branch::Reflected : Branch::Refracted, reflect ? side : other(side), weight,
         paths.number[k], paths.branch[k], next);
  }
  if (options_.estimator == Estimator::Slides) {
    next.slides_factor.resize(next.rays.size());
    next.slides_factor[before] = departure_cosine(space.hits, paths.rays, k);
  }
}

void PathWalker::end_path(const PathBatch& paths, std::size_t k, RayEnd end, std::uint32_t order,
                          BatchTally& tally) const {
  const RayBatch& rays = paths.rays;
  const double weight = double{paths.weight[k]};
  const bool outside = rays.side[k] == Side::Outside;
  if (end == RayEnd::Above && outside) {
    const bool slides = options_.estimator == Estimator::Slides;
    const double factor = slides ? double{paths.slides_factor[k]} / to_light_.z() : 1.0;
    return tally.leave(Fate::Reflected, paths.bin[k], weight * factor, order);
  }
  if (end == RayEnd::Below && !outside) {
    const double kept = absorption_per_cell_ > 0.0 ? attenuation(rays, k, tile_.lowest()) : 1.0;
    tally.add(Fate::Absorbed, weight * (1.0 - kept));
    return tally.leave(Fate::Transmitted, paths.bin[k], weight * kept, order);
  }
  leak(weight, tally);
}

// Beer–Lambert along a ray inside, up to a height.
double PathWalker::attenuation(const RayBatch& rays, std::size_t k, double end_height) const {
  constexpr double level = 1e-6;  // a ray this level inside of the relief ends within the same cell
  const double fall = std::abs(end_height - double{rays.z[k]}), speed = std::max(level, std::abs(double{rays.dz[k]}));
  return std::exp(-absorption_per_cell_ * fall / speed);
}

// Hits, as if light had come to the points of `space` without being shadowed.
void PathWalker::place_on_surface(std::size_t count, WalkSpace& space) const {
  HitBatch& hits = space.hits;
  const SurfacePoints& points = space.points;
  const auto per_y = static_cast<float>(1.0 / tile_.cell_y());  // to the same bits as in the splat
  for (std::size_t k = 0; k < count; ++k) {
    const auto column = static_cast<std::uint32_t>(points.cell_x[k]),
               row = static_cast<std::uint32_t>(points.cell_y[k]);
    const float in_x = points.x[k], in_y = points.y[k];
    const std::uint32_t right = column + 1 == tile_.columns() ? 0 : column + 1;
    const std::uint32_t upper = row + 1 == tile_.rows() ? 0 : row + 1;
    const float z00 = tile_.height(column, row), z11 = tile_.height(right, upper);
    const bool lower_half = in_x > in_y;
    const float corner = lower_half ? tile_.height(right, row) : tile_.height(column, upper);
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
    const std::size_t cell = static_cast<std::size_t>(space.hits.cell_y[k]) * tile_.columns() +
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
  const std::uint32_t upper = row + 1 == tile_.rows() ? 0 : row + 1;
  const auto per_y = static_cast<float>(1.0 / tile_.cell_y());
  for (std::uint32_t begin = 0; begin < tile_.columns(); begin += rays_together / 2) {
    const std::uint32_t end = std::min<std::uint32_t>(tile_.columns(), begin + rays_together / 2);
    std::size_t count = 0;
    for (std::uint32_t column = begin; column < end; ++column) {
      const std::uint32_t right = column + 1 == tile_.columns() ? 0 : column + 1;
      const float z00 = tile_.height(column, row), z10 = tile_.height(right, row);
      const float z01 = tile_.height(column, upper), z11 = tile_.height(right, upper);
      space.hits.slope_x[count] = z10 - z00;
      space.hits.slope_y[count++] = (z11 - z10) * per_y;
      space.hits.slope_x[count] = z11 - z01;
      space.hits.slope_y[count++] = (z01 - z00) * per_y;
    }
    shine(count, space);
    interact_geometric(options_.material, options_.grid, space.aimed.rays, space.hits, count, space.met);
    const std::size_t first_cell = std::size_t{row} * tile_.columns() + begin;
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
    for (std::uint32_t begin = 0; begin < tile_.columns(); begin += rays_together) {
      const auto count = std::min<std::size_t>(rays_together, tile_.columns() - begin);
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
        push(space, k, Branch::Reflected, Side::Outside, 1.0F, std::size_t{row} * tile_.columns() + column, 0, next);
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
