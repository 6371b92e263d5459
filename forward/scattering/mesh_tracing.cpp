#include "forward/scattering/mesh_tracing.h"

#include <algorithm>
#include <cmath>
#include <span>

#include <fmt/format.h>

#include "forward/base/digest.h"
#include "forward/base/error.h"
#include "forward/optics/bsdf_warnings.h"
#include "forward/scattering/incident_light.h"
#include "forward/scattering/scene_tracing.h"
#include "forward/scattering/trace_warnings.h"

namespace mezzotint {

namespace {

// First rays that are looked at before any path is walked.
constexpr std::uint32_t pilot_bits = 12;
// A pass that no run gets to, so that the pilot's rays are none of the run's.
constexpr std::uint32_t pilot_pass = 0xFFFF;

std::string digest_of(const TriangleMesh& mesh, const std::optional<MeshPeriod>& period) {
  const std::string text = fmt::format("{} {} {:a} {:a}", sha256_hex(std::as_bytes(std::span(mesh.vertices_um))),
                                       sha256_hex(std::as_bytes(std::span(mesh.triangles))),
                                       period ? period->x.um() : 0.0, period ? period->y.um() : 0.0);
  return sha256_hex(std::as_bytes(std::span(text)));
}

void require_possible(const PathTracingOptions& options) {
  require_valid(options);
  require(options.normals == NormalKind::Geometric, "a mesh is traced with the normals of its triangles");
  require(options.estimator == Estimator::Flux, "the slides' estimator is for height fields, for comparison only");
  require(options.control_variate != ControlVariate::On, "the splat of all facets is for height fields");
}

// The same scene with a guard band around what rays are aimed at. Returns the band's width in cells of pitch_x.
double keep_off_the_ends(const DirectionAngles& incidence, SceneFrame& frame) {
  if (frame.ends != SceneEnds::Open) return 0.0;
  const double length_x = frame.columns, length_y = frame.rows * frame.cell_y;
  const double wanted = (frame.highest - frame.lowest) * (1.0 + std::tan(incidence.theta.radians()));
  const double band = std::min(wanted, 0.25 * std::min(length_x, length_y));
  frame.aimed_x = band;
  frame.aimed_y = band / frame.cell_y;
  frame.aimed_columns = length_x - 2.0 * band;
  frame.aimed_rows = (length_y - 2.0 * band) / frame.cell_y;
  return band;
}

/// Shares of the first rays.
struct FirstHits {
  double behind = 0.0, missed = 0.0;
};

FirstHits look_at_first_hits(const SceneFrame& frame, const MeshScene& scene, const PathTracingOptions& options) {
  constexpr std::size_t count = std::size_t{1} << pilot_bits;
  const IncidentLight light(frame, options, nullptr);
  const SampleStrata strata(pilot_bits, Placement::Strata, options.seed, pilot_pass, 0);
  AimedRays aimed(count);
  HitBatch hits(count);
  light.fill(strata, 0, 0, count, aimed);
  scene.closest_hits(aimed.rays, count, hits);
  FirstHits shares;
  for (std::size_t k = 0; k < count; ++k) {
    if (hits.end[k] == RayEnd::Behind) shares.behind += 1.0 / count;
    if (light.missed(aimed, hits, k)) shares.missed += 1.0 / count;
  }
  return shares;
}

std::string from_behind_text(double share) {
  return fmt::format(
      "{:.2g} % of the first hits met a face from behind: is the mesh oriented outwards, and large enough for this "
      "light?",
      100.0 * share);
}

void tell(const FirstHits& first, Bsdf& bsdf) {
  constexpr double few = 1e-3, worth_a_word = 0.01;
  bsdf.provenance["from_behind_share"] = fmt::format("{:.4g}", first.behind);
  bsdf.provenance["missed_share"] = fmt::format("{:.4g}", first.missed);
  if (first.behind > few) add_warnings(bsdf, {from_behind_text(first.behind)});
  if (first.missed > worth_a_word)
    add_warnings(bsdf, {fmt::format("{:.2g} % of the light went past the mesh or through holes in it; the maps are of "
                                    "the rest",
                                    100.0 * first.missed)});
}

void tell_losses(Bsdf& bsdf) {
  constexpr double most_leaked = 1e-4, worth_a_word = 0.05;
  const double leaked = std::stod(bsdf.provenance.at("leaked_share"));
  if (leaked > most_leaked)
    add_warnings(bsdf, {fmt::format("{:.2g} % of the light was lost through the surface: holes, or faces that are "
                                    "turned round",
                                    100.0 * leaked)});
  if (bsdf.energy.left_sideways.value > worth_a_word)
    add_warnings(bsdf, {fmt::format("{:.2g} % of the light left the patch sideways: it is small for its height",
                                    100.0 * bsdf.energy.left_sideways.value)});
}

}  // namespace

MeshPathTracer::MeshPathTracer(const TriangleMesh& mesh, const std::optional<MeshPeriod>& period)
    : triangles_(mesh.triangles.size()), digest_(digest_of(mesh, period)), scene_(mesh, period) {}

Bsdf MeshPathTracer::trace(const PathTracingOptions& asked, const Progress& progress) const {
  require_possible(asked);
  PathTracingOptions options = asked;
  options.tracer = TracerKind::Embree;
  SceneFrame frame = scene_.frame();
  const double band = keep_off_the_ends(options.incidence, frame);
  const FirstHits first = look_at_first_hits(frame, scene_, options);
  require(first.behind <= 0.5, from_behind_text(first.behind) + " Turn its faces round");
  Bsdf bsdf = trace_scene(frame, scene_, digest_, options, progress);
  bsdf.provenance["surface"] = fmt::format("mesh of {} triangles", triangles_);
  bsdf.provenance["ends"] = frame.ends == SceneEnds::Periodic
                                ? fmt::format("periodic, {:.6g} x {:.6g} um", frame.columns * frame.unit_um,
                                              frame.rows * frame.cell_y * frame.unit_um)
                                : fmt::format("open, rays aimed {:.4g} um within the ends", band * frame.unit_um);
  tell(first, bsdf);
  tell_losses(bsdf);
  add_warnings(bsdf, trace_warnings(options, bsdf, true));
  return bsdf;
}

}  // namespace mezzotint
