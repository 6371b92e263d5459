#include "forward/scattering/path_walk.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "forward/scattering/path_steps.h"

namespace mezzotint {

namespace {

Side other(Side side) { return side == Side::Outside ? Side::Inside : Side::Outside; }

void leak(double weight, BatchTally& tally) {
  tally.add(Fate::CutOff, weight);
  tally.leaked += weight;
}

// The cosine of a path's way about the normal of the facet that it leaves: the same as that of its arrival.
float departure_cosine(const HitBatch& hits, const RayBatch& rays, std::size_t k) {
  const float a = hits.slope_x[k], b = hits.slope_y[k];
  return std::abs(rays.dz[k] - a * rays.dx[k] - b * rays.dy[k]) / std::sqrt(1.0F + a * a + b * b);
}

}  // namespace

PathWalker::PathWalker(const SceneFrame& frame, const PeriodicTile* relief, const ReliefTracer& tracer,
                       const PathTracingOptions& options)
    : frame_(frame),
      tile_(relief),
      tracer_(tracer),
      options_(options),
      choices_(options.seed, RandomPurpose::RayChoice),
      to_light_(to_direction(options.incidence)) {
  if (const auto* clear = std::get_if<Dielectric>(&options.material)) {
    absorption_per_cell_ = clear->absorption_per_um * frame.unit_um;
  }
}

void PathWalker::interact(const RayBatch& rays, std::size_t count, WalkSpace& space) const {
  if (options_.normals == NormalKind::Geometric && tile_ != nullptr) {
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
  for (std::size_t k = 0; k < count; ++k) space.start_weight[k] = space.hits.end[k] == RayEnd::Surface ? 1.0F : 0.0F;
  const bool may_miss = frame_.ends != SceneEnds::Periodic;
  for (std::size_t k = 0; k < count; ++k) {
    if (may_miss && light.missed(space.aimed, space.hits, k)) {
      tally.add(Fate::LeftSideways, 1.0);
      space.start_weight[k] = 0.0F;
    } else if (space.hits.end[k] != RayEnd::Surface) {
      leak(1.0, tally);
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
  if (options_.roulette_first)
    split_by_choice(count, first_index, space, tally);
  else
    split_by_weight(count, first_index, space, tally);
  tally.normal_fallbacks += std::exchange(space.met.normal_fallbacks, 0);
  if (options_.estimator != Estimator::Slides) return;
  next.slides_factor.resize(next.rays.size());
  for (std::size_t k = 0; k < next.count; ++k) {
    const std::size_t hit = static_cast<std::size_t>(next.number[k] - first_index);
    next.slides_factor[k] = departure_cosine(space.hits, rays, hit);
  }
}

// All that is reflected before all that is refracted: a tracer likes its rays by side.
void PathWalker::split_by_weight(std::size_t count, std::uint64_t first_index, WalkSpace& space,
                                 BatchTally& tally) const {
  const InteractionBatch& met = space.met;
  std::vector<float>& weight = space.branch_weight;
  const float* start = space.start_weight.data();
  std::uint64_t interactions = 0;
  for (std::size_t k = 0; k < count; ++k) interactions += start[k] > 0.0F ? 1 : 0;
  tally.interactions += interactions;
  for (std::size_t k = 0; k < count; ++k) weight[k] = start[k] * met.reflectance[k];
  push_branch(space.hits,
              {met.reflected_x, met.reflected_y, met.reflected_z, met.reflected_bin, weight, Side::Outside, 0},
              first_index, count, space.paths[0]);
  if (std::holds_alternative<Dielectric>(options_.material)) {
    for (std::size_t k = 0; k < count; ++k)
      weight[k] = met.refracts[k] != 0 ? start[k] * (1.0F - met.reflectance[k]) : 0.0F;
    push_branch(space.hits,
                {met.refracted_x, met.refracted_y, met.refracted_z, met.refracted_bin, weight, Side::Inside, 1},
                first_index, count, space.paths[0]);
  } else if (std::holds_alternative<Conductor>(options_.material)) {
    double absorbed = 0.0;
    for (std::size_t k = 0; k < count; ++k) {
      if (start[k] > 0.0F) absorbed += double{start[k] * (1.0F - met.reflectance[k])};
    }
    tally.add(Fate::Absorbed, absorbed);
  }
}

// One branch goes on, by roulette.
void PathWalker::split_by_choice(std::size_t count, std::uint64_t first_index, WalkSpace& space,
                                 BatchTally& tally) const {
  PathBatch& next = space.paths[0];
  for (std::size_t k = 0; k < count; ++k) {
    const float weight = space.start_weight[k], share = space.met.reflectance[k];
    if (weight == 0.0F) continue;
    ++tally.interactions;
    const bool refracts = space.met.refracts[k] != 0;
    const bool reflect = !refracts || choices_.uniform4(first_index + k, 2U << 24)[0] < double{share};
    push(space, k, reflect ? Branch::Reflected : Branch::Refracted, reflect ? Side::Outside : Side::Inside,
         refracts ? weight : weight * share, first_index + k, reflect ? 0 : 1, next);
    if (!refracts) tally.add(Fate::Absorbed, double{weight * (1.0F - share)});
  }
}

void PathWalker::follow(First first, WalkSpace& space, BatchTally& tally) const {
  for (std::uint32_t order = 1; space.paths[(order - 1) % 2].count > 0; ++order) {
    const PathBatch& paths = space.paths[(order - 1) % 2];
    PathBatch& next = space.paths[order % 2];
    next.count = 0;
    tracer_.closest_hits(paths.rays, paths.count, space.hits);
    space.ends.sort(paths.rays, space.hits, paths.count);
    if (first == First::Counts || order > 1)
      end_all(paths, order, space, tally);
    else
      end_left_out(paths, space, tally);
    for (const std::uint32_t k : space.ends.lost) {
      const double weight = double{paths.weight[k]};
      space.hits.end[k] == RayEnd::Sideways ? tally.add(Fate::LeftSideways, weight) : leak(weight, tally);
    }
    if (!space.ends.met.empty()) meet_all(first, paths, order, space, next, tally);
  }
}

// Of the first ones of a correction, those that the splat left out.
void PathWalker::end_left_out(const PathBatch& paths, const WalkSpace& space, BatchTally& tally) const {
  for (const std::uint32_t k : space.ends.reflected)
    if (paths.in_splat[k] == 0) tally.leave(Fate::Reflected, paths.bin[k], double{paths.weight[k]}, 1);
  for (const std::uint32_t k : space.ends.transmitted)
    if (paths.in_splat[k] == 0) tally.leave(Fate::Transmitted, paths.bin[k], double{paths.weight[k]}, 1);
}

// All that leave. Light without a factor of its own for each path goes straight into the bins.
void PathWalker::end_all(const PathBatch& paths, std::uint32_t order, const WalkSpace& space, BatchTally& tally) const {
  const EndLists& ends = space.ends;
  if (options_.estimator == Estimator::Slides) {
    for (const std::uint32_t k : ends.reflected) {
      const double factor = double{paths.slides_factor[k]} / to_light_.z();
      tally.leave(Fate::Reflected, paths.bin[k], double{paths.weight[k]} * factor, order);
    }
  } else {
    tally.leave_all(Fate::Reflected, ends.reflected, paths.bin, paths.weight, order);
  }
  if (absorption_per_cell_ == 0.0) {
    return tally.leave_all(Fate::Transmitted, ends.transmitted, paths.bin, paths.weight, order);
  }
  for (const std::uint32_t k : ends.transmitted) {
    const double weight = double{paths.weight[k]}, kept = attenuation(paths.rays, k, frame_.lowest);
    tally.add(Fate::Absorbed, weight * (1.0 - kept));
    tally.leave(Fate::Transmitted, paths.bin[k], weight * kept, order);
  }
}

void PathWalker::meet_all(First first, const PathBatch& paths, std::uint32_t order, WalkSpace& space, PathBatch& next,
                          BatchTally& tally) const {
  if (order < options_.max_bounces) interact(paths.rays, paths.count, space);
  for (const std::uint32_t k : space.ends.met) {
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

void PathWalker::meet_again(const PathBatch& paths, std::size_t k, std::uint32_t order, WalkSpace& space,
                            PathBatch& next, BatchTally& tally) const {
  ++tally.interactions;
  const Side side = paths.rays.side[k];
  const float share = space.met.reflectance[k];
  float weight = paths.weight[k];
  if (side == Side::Inside && absorption_per_cell_ > 0.0) {
    const auto kept = static_cast<float>(attenuation_to(space.hits, paths.rays, k));
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

// The same up to a hit.
double PathWalker::attenuation_to(const HitBatch& hits, const RayBatch& rays, std::size_t k) const {
  if (!hits.way.empty()) return std::exp(-absorption_per_cell_ * double{hits.way[k]});
  return attenuation(rays, k, double{hits.z[k]});
}

// Beer–Lambert along a ray inside, up to a height.
double PathWalker::attenuation(const RayBatch& rays, std::size_t k, double end_height) const {
  constexpr double level = 1e-6;  // a ray this level inside of the relief ends within the same cell
  const double fall = std::abs(end_height - double{rays.z[k]}), speed = std::max(level, std::abs(double{rays.dz[k]}));
  return std::exp(-absorption_per_cell_ * fall / speed);
}

}  // namespace mezzotint
