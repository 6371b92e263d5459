#include "forward/scattering/path_walk.h"

#include "forward/scattering/surface_interaction.h"

namespace mezzotint {

struct PathWalker::Path {
  Ray ray;
  double weight = 1.0;
  Direction last_normal;
  double cos_incident = 1.0;  ///< of the first ray, about the macrosurface
  std::uint64_t ray_index = 0;
  std::uint32_t branch = 0;  ///< 0 was reflected first, 1 refracted: they draw different random numbers
  std::uint32_t interactions = 0;

  void turn(const SurfaceHit& hit, const Direction& direction, Side side, const Direction& normal) {
    ray = {hit.position, direction, side, hit.triangle};
    last_normal = normal;
  }
};

namespace {

Side other(Side side) { return side == Side::Outside ? Side::Inside : Side::Outside; }

void count(const SurfaceInteraction& met, BatchTally& tally) {
  ++tally.interactions;
  if (met.normal_fell_back) ++tally.normal_fallbacks;
}

void leak(double weight, BatchTally& tally) {
  tally.add(Fate::CutOff, weight);
  tally.leaked += weight;
}

}  // namespace

PathWalker::PathWalker(const PeriodicTile& tile, const ReliefTracer& tracer, const PathTracingOptions& options)
    : tile_(tile), tracer_(tracer), options_(options), choices_(options.seed, RandomPurpose::RayChoice) {}

bool PathWalker::met_a_copy(const Ray& first, const SurfaceHit& hit) const {
  if (!tile_.mirrored()) return false;
  const Eigen::Vector3d place = first.origin + hit.distance * first.direction;
  const double x = place.x() + 0.5 * tile_.length_x(), y = place.y() + 0.5 * tile_.length_y();
  return x < 0.0 || y < 0.0 || x > tile_.original_length_x() || y > tile_.original_length_y();
}

double PathWalker::choice(const Path& path) const {
  return choices_.uniform4(path.ray_index, (path.branch << 24) + path.interactions / 4)[path.interactions % 4];
}

void PathWalker::walk(const Ray& first, std::uint64_t ray_index, BatchTally& tally) const {
  SurfaceHit hit;
  if (tracer_.closest_hit(first, hit) != RayEnd::Surface) return leak(1.0, tally);
  if (met_a_copy(first, hit)) return tally.add(Fate::LeftSideways, 1.0);
  const SurfaceInteraction met = interact(tile_, options_.material, options_.normals, first, hit);
  count(met, tally);
  Path path;
  path.ray_index = ray_index;
  path.cos_incident = -first.direction.z();
  path.interactions = 1;
  path.weight = met.reflectance;
  path.turn(hit, met.reflected, Side::Outside, met.normal);
  if (path.weight > 0.0) follow(path, tally);
  path.weight = 1.0 - met.reflectance;
  if (!met.refracts) return tally.add(Fate::Absorbed, path.weight);
  path.branch = 1;
  path.turn(hit, met.refracted, Side::Inside, met.normal);
  follow(path, tally);
}

void PathWalker::follow(Path path, BatchTally& tally) const {
  SurfaceHit hit;
  for (;;) {
    const RayEnd end = tracer_.closest_hit(path.ray, hit);
    if (end != RayEnd::Surface) return end_path(path, end, tally);
    if (path.interactions == options_.max_bounces) return tally.add(Fate::CutOff, path.weight);
    meet_again(path, hit, tally);
  }
}

void PathWalker::meet_again(Path& path, const SurfaceHit& hit, BatchTally& tally) const {
  const SurfaceInteraction met = interact(tile_, options_.material, options_.normals, path.ray, hit);
  count(met, tally);
  if (!met.refracts) {
    tally.add(Fate::Absorbed, path.weight * (1.0 - met.reflectance));
    path.weight *= met.reflectance;
    path.turn(hit, met.reflected, path.ray.side, met.normal);
  } else if (choice(path) < met.reflectance) {
    path.turn(hit, met.reflected, path.ray.side, met.normal);
  } else {
    path.turn(hit, met.refracted, other(path.ray.side), met.normal);
  }
  ++path.interactions;
}

void PathWalker::end_path(const Path& path, RayEnd end, BatchTally& tally) const {
  const Direction& way = path.ray.direction;
  if (end == RayEnd::Above && path.ray.side == Side::Outside) {
    const bool slides = options_.estimator == Estimator::Slides;
    const double factor = slides ? way.dot(path.last_normal) / path.cos_incident : 1.0;
    return tally.leave(Fate::Reflected, way, path.weight * factor);
  }
  if (end == RayEnd::Below && path.ray.side == Side::Inside) return tally.leave(Fate::Transmitted, way, path.weight);
  leak(path.weight, tally);
}

}  // namespace mezzotint
