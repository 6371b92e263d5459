#include "forward/scattering/path_tracing.h"

#include <algorithm>
#include <bit>
#include <chrono>
#include <cmath>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include "forward/base/digest.h"
#include "forward/base/error.h"
#include "forward/optics/bsdf_warnings.h"
#include "forward/scattering/batch_tally.h"
#include "forward/scattering/incident_light.h"
#include "forward/scattering/path_walk.h"
#include "forward/scattering/planned_splat.h"
#include "forward/scattering/scene_tracing.h"
#include "forward/scattering/trace_result.h"
#include "forward/scattering/trace_state.h"
#include "forward/scattering/trace_warnings.h"
#include "forward/surface/relief_warnings.h"
#include "forward/tracing/beam_front.h"
#include "forward/tracing/height_field_tracer.h"
#include "forward/tracing/relief_scene.h"

namespace mezzotint {

namespace {

// Between two looks at `progress` every batch walks this many paths, some milliseconds.
constexpr std::uint64_t paths_per_slice = std::uint64_t{1} << 14;
// The first of several passes: enough paths for a first idea of the error.
constexpr std::uint64_t paths_of_first_pass = std::uint64_t{1} << 15;
// A splat with a smaller share of the light has nothing to offer: nearly all of it meets the surface again (steep
// mirrors), and the correction that makes the audit sum to 1 would divide by next to nothing.
constexpr double least_splat_share = 0.1;

}  // namespace

void require_valid(const PathTracingOptions& options) {
  require_valid(options.grid);
  const double theta = options.incidence.theta.radians();
  require(theta >= 0.0 && theta < 0.5 * std::numbers::pi && std::isfinite(options.incidence.phi.radians()),
          "the light must come from above: theta from 0 up to, but not including, 90°");
  require(options.batches >= 4 && options.batches % 2 == 0 && options.batches <= 65536,
          "the number of batches must be even, from 4 to 65536");
  require(options.samples >= 1 && options.samples <= (std::uint64_t{1} << 36),
          "the number of samples must be from 1 to 2^36");
  require(options.max_bounces >= 1 && options.max_bounces <= 65536, "a path needs from 1 to 65536 interactions");
  require(options.bounce_orders <= 64, "at most 64 orders of interaction can be kept apart");
  require(options.tolerance >= 0.0 && options.seconds >= 0.0, "a tolerance or a time cannot be negative");
  if (const auto* dielectric = std::get_if<Dielectric>(&options.material)) {
    require(dielectric->eta >= 1.0001 && dielectric->eta <= 10.0,
            "the index of refraction of a dielectric must be from 1.0001 to 10");
    require(dielectric->absorption_per_um >= 0.0, "an absorption cannot be negative");
  }
}

namespace {

std::uint32_t bits_for(std::uint64_t paths, std::uint32_t batches) {
  const std::uint64_t least = std::max<std::uint64_t>(1, (paths + batches - 1) / batches);
  return static_cast<std::uint32_t>(std::bit_width(least - 1));
}

// Paths of pass 0, 1, 2, …, a batch: 1, 1, 1, 1, 2, 2, 4, 4, 8, … times the first, so that a pass adds a third to a
// half and a run that is refined later goes through the same passes.
std::uint32_t pass_bits(std::uint32_t pass, std::uint32_t first_bits) {
  return first_bits + (pass < 4 ? 0 : (pass - 2) / 2);
}

bool splat_is_possible(const PathTracingOptions& options, const PeriodicTile& tile) {
  const auto* clear = std::get_if<Dielectric>(&options.material);
  return options.normals == NormalKind::Geometric && options.estimator == Estimator::Flux && !tile.mirrored() &&
         !options.spread_incidence_over_bin && options.tracer == TracerKind::HeightField && !options.roulette_first &&
         (clear == nullptr || clear->absorption_per_um == 0.0);
}

double splat_share(const BatchTally& splat, const PeriodicTile& tile) {
  double sum = 0.0;
  for (const double light : splat.total_energy) sum += light;
  return sum / (2.0 * tile.columns() * tile.rows());
}

double rms_gradient(const PeriodicTile& tile) {
  double sum = 0.0;
  for (std::uint32_t row = 0; row < tile.rows(); ++row) {
    const std::uint32_t upper = row + 1 == tile.rows() ? 0 : row + 1;
    for (std::uint32_t column = 0; column < tile.columns(); ++column) {
      const std::uint32_t right = column + 1 == tile.columns() ? 0 : column + 1;
      const double z = tile.height(column, row);
      const double a = tile.height(right, row) - z, b = (tile.height(column, upper) - z) / tile.cell_y();
      sum += a * a + b * b;
    }
  }
  return std::sqrt(sum / (double{1} * tile.columns() * tile.rows()));
}

bool use_splat(const PathTracingOptions& options, const PeriodicTile& tile, double gradient) {
  if (options.control_variate == ControlVariate::Off) return false;
  const bool possible = splat_is_possible(options, tile);
  require(possible || options.control_variate == ControlVariate::Automatic,
          "the splat of all facets (the model slopes, and the control variate) needs a periodic field, geometric "
          "normals, one "
          "direction of the light, the flux estimator, no absorption and the height-field tracer; use the model paths");
  const double steepness = gradient * std::tan(options.incidence.theta.radians());
  return possible && (options.control_variate == ControlVariate::On || steepness < control_variate_limit);
}

}  // namespace

struct PathTracer::Scene {
  explicit Scene(const HeightField& field) : tile(field), warnings(relief_warnings(field)) {}

  const HeightFieldTracer& height_field() {
    if (!fast) fast.emplace(tile);
    return *fast;
  }
  const ReliefTracer& tracer(TracerKind kind) {
    if (kind == TracerKind::HeightField) return height_field();
    if (!triangles) triangles.emplace(tile);
    return *triangles;
  }
  double gradient() {
    if (!known_gradient) known_gradient = rms_gradient(tile);
    return *known_gradient;
  }
  std::string digest() const {
    std::string text;
    for (std::uint32_t row = 0; row < tile.rows(); ++row)
      for (std::uint32_t column = 0; column < tile.columns(); ++column) {
        const float z = tile.height(column, row);
        text.append(reinterpret_cast<const char*>(&z), sizeof(z));
      }
    return sha256_hex({reinterpret_cast<const std::byte*>(text.data()), text.size()});
  }

  // The splat of one setting, kept for the next run of the same.
  const BatchTally& splat(const PathTracingOptions& options);
  // The splat with its shadows, and where it has to be corrected; kept like it.
  const PlannedSplat& planned(const PathTracingOptions& options);

  PeriodicTile tile;
  std::vector<std::string> warnings;  ///< of the relief itself
  std::optional<HeightFieldTracer> fast;
  std::optional<ReliefScene> triangles;
  std::optional<double> known_gradient;
  bool has_normals = false;
  std::string splat_key, planned_key;
  std::optional<BatchTally> kept_splat;
  std::optional<PlannedSplat> kept_planned;
};

namespace {

std::string key_of(const PathTracingOptions& options) {
  return fmt::format("{:a} {:a} {}x{} {} {}", options.incidence.theta.radians(), options.incidence.phi.radians(),
                     options.grid.width, options.grid.height, to_string(options.material), options.bounce_orders);
}

}  // namespace

const BatchTally& PathTracer::Scene::splat(const PathTracingOptions& options) {
  const std::string key = key_of(options);
  if (!kept_splat || key != splat_key) {
    kept_splat = splat_all(tile, height_field(), options);
    splat_key = key;
  }
  return *kept_splat;
}

const PlannedSplat& PathTracer::Scene::planned(const PathTracingOptions& options) {
  const std::string key = key_of(options);
  if (!kept_planned || key != planned_key) {
    kept_planned = plan_splat(tile, height_field(), options);
    planned_key = key;
  }
  return *kept_planned;
}

namespace {

/// One call of trace: passes until the budget or the tolerance is met.
class Run {
public:
  Run(const SceneFrame& frame, const PeriodicTile* tile, const ReliefTracer& tracer, const HeightFieldTracer* fast,
      const PlannedSplat* splat, const PathTracingOptions& options, const Progress& progress)
      : frame_(frame),
        options_(options),
        progress_(progress),
        walker_(frame, tile, tracer, options),
        splat_(splat),
        start_(std::chrono::steady_clock::now()) {
    if (splat == nullptr && fast != nullptr && !options.spread_incidence_over_bin) {
      front_.emplace(fast->pyramid(), -to_direction(options.incidence), frame.mean);
    }
    light_.emplace(frame, options, front_ ? &*front_ : nullptr);
    state_.tallies.assign(options.batches, empty_tally(options));
  }

  void resume(const std::string& run) {
    run_ = run;
    if (!options_.state.empty()) read_state(options_.state, run_, state_);
  }

  TraceResult go() {
    const bool stepwise = options_.tolerance > 0.0 || options_.seconds > 0.0 || !options_.state.empty();
    const std::uint32_t whole = bits_for(options_.samples, options_.batches);
    const std::uint32_t first = stepwise ? std::min(whole, bits_for(paths_of_first_pass, options_.batches)) : whole;
    while (!done(whole)) {
      const std::uint32_t bits = stepwise ? pass_bits(state_.passes, first) : whole;
      pass(bits);
      state_.convergence.push_back({paths(), error()});
      if (!options_.state.empty()) write_state(options_.state, run_, state_);
    }
    return result();
  }

private:
  [[nodiscard]] std::uint64_t paths() const { return state_.rays_per_batch * options_.batches; }
  [[nodiscard]] double seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }
  [[nodiscard]] bool done(std::uint32_t whole) const {
    if (state_.passes == 0) return false;
    if (state_.rays_per_batch >= (std::uint64_t{1} << whole)) return true;
    if (options_.tolerance > 0.0 && state_.convergence.back().error <= options_.tolerance) return true;
    return options_.seconds > 0.0 && seconds() >= options_.seconds;
  }
  [[nodiscard]] TraceResult result() const {
    return summarise(options_, state_, splat_, 2.0 * frame_.columns * frame_.rows);
  }
  [[nodiscard]] double error() const { return relative_error(options_.grid, result().bsdf.reflection); }

  void pass(std::uint32_t bits) {
    const std::uint64_t rays = std::uint64_t{1} << bits;
    const std::uint64_t traced = paths();
    for (std::uint64_t begin = 0; begin < rays; begin += paths_per_slice) {
      const std::uint64_t count = std::min(paths_per_slice, rays - begin);
      tbb::parallel_for(std::uint32_t{0}, options_.batches,
                        [&](std::uint32_t batch) { slice(batch, bits, begin, count, traced + batch * rays); });
      tell(begin + count, rays);
    }
    state_.rays_per_batch += rays;
    ++state_.passes;
  }

  void slice(std::uint32_t batch, std::uint32_t bits, std::uint64_t begin, std::uint64_t count, std::uint64_t number) {
    WalkSpace& space = spaces_.local();
    BatchTally& tally = state_.tallies[batch];
    const SampleStrata strata(bits, options_.placement, options_.seed, state_.passes, batch);
    for (std::uint64_t first = begin; first < begin + count; first += rays_together) {
      const std::size_t here = static_cast<std::size_t>(std::min<std::uint64_t>(rays_together, begin + count - first));
      if (splat_)
        walker_.correct(splat_->plan, strata, first, number + first, here, space, tally);
      else
        walker_.walk(*light_, strata, first, number + first, here, space, tally);
    }
    tally.close_slice();
  }

  void tell(std::uint64_t of_pass, std::uint64_t rays) {
    if (!progress_) return;
    const double now = static_cast<double>(state_.rays_per_batch + of_pass) * options_.batches;
    double goal = static_cast<double>(std::uint64_t{options_.batches} << bits_for(options_.samples, options_.batches));
    std::string note;
    if (!state_.convergence.empty()) {
      const auto& last = state_.convergence.back();
      note = fmt::format("standard error {:.2g} % after {:.3g} paths", 100.0 * last.error,
                         static_cast<double>(last.paths));
      if (options_.tolerance > 0.0 && last.error > 0.0)
        goal = std::min(goal, static_cast<double>(last.paths) * std::pow(last.error / options_.tolerance, 2.0));
    }
    double fraction = std::min(1.0, now / goal);
    if (options_.seconds > 0.0) fraction = std::max(fraction, std::min(1.0, seconds() / options_.seconds));
    // A pass that goes beyond what seemed to be needed is nearly done.
    if (of_pass < rays) fraction = std::min(fraction, 0.99);
    report(progress_, "trace", fraction, note);
  }

  SceneFrame frame_;
  const PathTracingOptions& options_;
  const Progress& progress_;
  std::optional<BeamFront> front_;
  std::optional<IncidentLight> light_;
  PathWalker walker_;
  const PlannedSplat* splat_;  ///< nullptr where paths are everything
  std::chrono::steady_clock::time_point start_;
  std::string run_;
  TraceState state_;
  tbb::enumerable_thread_specific<WalkSpace> spaces_;
};

// All that a state depends on, but for the budget.
std::string run_digest(const std::string& relief, const PathTracingOptions& options, bool splat) {
  const std::string text = fmt::format(
      "{} {:a} {:a} {} {}x{} {} batches {} bounces {} orders {} estimator {} normals {} tracer {} placement {} planned "
      "splat "
      "{} roulette {} seed {}",
      relief, options.incidence.theta.radians(), options.incidence.phi.radians(), options.spread_incidence_over_bin,
      options.grid.width, options.grid.height, to_string(options.material), options.batches, options.max_bounces,
      options.bounce_orders, static_cast<int>(options.estimator), static_cast<int>(options.normals),
      static_cast<int>(options.tracer), static_cast<int>(options.placement), splat, options.roulette_first,
      options.seed);
  return sha256_hex({reinterpret_cast<const std::byte*>(text.data()), text.size()});
}

}  // namespace

Bsdf trace_scene(const SceneFrame& frame, const ReliefTracer& tracer, const std::string& digest,
                 const PathTracingOptions& options, const Progress& progress) {
  Run run(frame, nullptr, tracer, nullptr, nullptr, options, progress);
  if (!options.state.empty()) run.resume(run_digest(digest, options, false));
  return run.go().bsdf;
}

double relative_error(const DirectionGrid& grid, const MapEstimate& map) {
  const auto areas = projected_solid_angles(grid);
  double noise = 0.0, power = 0.0;
  for (std::size_t bin = 0; bin < areas.size(); ++bin) {
    noise += areas[bin] * map.standard_error[bin] * map.standard_error[bin];
    power += areas[bin] * map.mean[bin] * map.mean[bin];
  }
  return power > 0.0 ? std::sqrt(noise / power) : 0.0;
}

PathTracer::PathTracer(const HeightField& field) : scene_(std::make_unique<Scene>(field)) {}
PathTracer::~PathTracer() = default;

Bsdf PathTracer::trace(const PathTracingOptions& options, const Progress& progress) {
  require_valid(options);
  if (options.normals == NormalKind::Interpolated && !scene_->has_normals) {
    scene_->tile.prepare_normals();
    scene_->has_normals = true;
  }
  const PlannedSplat* splat =
      use_splat(options, scene_->tile, scene_->gradient()) ? &scene_->planned(options) : nullptr;
  if (splat != nullptr && splat_share(splat->splat, scene_->tile) < least_splat_share) {
    require(
        options.control_variate == ControlVariate::Automatic,
        "nearly no light leaves this relief after one interaction, so that the control variate has nothing to offer");
    splat = nullptr;
  }
  const bool height_field = options.tracer == TracerKind::HeightField;
  if (!height_field && !scene_->triangles) report(progress, "trace", 0.0, "building the tree of triangles");
  const HeightFieldTracer* fast = height_field ? &scene_->height_field() : nullptr;
  Run run(scene_->tile.frame(), &scene_->tile, scene_->tracer(options.tracer), fast, splat, options, progress);
  if (!options.state.empty()) run.resume(run_digest(scene_->digest(), options, splat != nullptr));
  Bsdf bsdf = run.go().bsdf;
  add_warnings(bsdf, scene_->warnings);
  add_warnings(bsdf, trace_warnings(options, bsdf));
  return bsdf;
}

Bsdf PathTracer::splat(const PathTracingOptions& options) {
  require_valid(options);
  PathTracingOptions wanted = options;
  wanted.control_variate = ControlVariate::On;
  (void)use_splat(wanted, scene_->tile, 0.0);
  Bsdf bsdf = splat_result(options, scene_->splat(options), 2.0 * scene_->tile.columns() * scene_->tile.rows());
  add_warnings(bsdf, scene_->warnings);
  add_warnings(bsdf, splat_warnings(bsdf, caught_light(scene_->tile, options.incidence)));
  return bsdf;
}

PathTracer::ReliefFacts PathTracer::facts() {
  const PeriodicTile& tile = scene_->tile;
  double square = 0.0;
  for (std::uint32_t row = 0; row < tile.rows(); ++row) {
    for (std::uint32_t column = 0; column < tile.columns(); ++column) {
      const double z = tile.height(column, row) - tile.mean();
      square += z * z;
    }
  }
  const double cells = double{1} * tile.columns() * tile.rows();
  return {scene_->gradient(), double{scene_->height_field().pyramid().steepest},
          std::sqrt(square / cells) * tile.unit_um()};
}

Bsdf trace_bsdf(const HeightField& field, const PathTracingOptions& options, const Progress& progress) {
  require_valid(options);  // before anything is built
  return PathTracer(field).trace(options, progress);
}

}  // namespace mezzotint
