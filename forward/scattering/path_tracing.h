#pragma once

#include <cstdint>
#include <memory>

#include "forward/base/progress.h"
#include "forward/optics/bsdf.h"
#include "forward/optics/material.h"
#include "forward/surface/height_field.h"

namespace mezzotint {

/// Which weight a path carries.
enum class Estimator {
  Flux,   ///< each ray carries Φ_i/N: conserves energy and is reciprocal
  Slides  ///< the slides' (ω·m)/cosθ_i, for comparison only: gains energy at grazing incidence
};

/// Which normal a ray is reflected about.
enum class NormalKind {
  Geometric,    ///< of the triangle
  Interpolated  ///< of the angle-weighted pseudo-normals; the triangle's where the other would send the
                ///< ray through the surface, and the share of such hits is reported
};

struct PathTracingOptions {
  DirectionAngles incidence;
  /// Light from all directions of the map's bin that holds `incidence`, uniformly in projected solid
  /// angle, instead of from one direction (for tests of reciprocity).
  bool spread_incidence_over_bin = false;
  DirectionGrid grid;
  Material material = Dielectric{};
  /// Paths in all; rounded up to batches × a power of two (a batch is one set of Morton strata), so at most
  /// doubled. Time is linear in it.
  std::uint64_t samples = 1U << 20;
  /// Independent randomisations, from which the standard errors come; even, at least 4.
  std::uint32_t batches = 32;
  /// Interactions a path may have. What is cut off is reported.
  std::uint32_t max_bounces = 64;
  Estimator estimator = Estimator::Flux;
  NormalKind normals = NormalKind::Geometric;
  std::uint64_t seed = 1;
};

/// The BSDF of a relief by path tracing with Embree: rays aimed at stratified points of the macro area,
/// in Morton order; Fresnel at every interaction; both branches of the first kept by expected value,
/// Russian roulette between reflection and refraction at deeper ones.
///
/// Ends     a periodic field continues periodically; a mirrored one has its rays aimed at the original (in the
///          plane of the mean height) and is continued by mirrored copies; light whose first interaction is with
///          a copy is `left_sideways`. That light is no part of the maps, and they are normalised by the rest:
///          Σ f · (projected solid angle) = reflected / (1 − left_sideways).
/// Energy   the audit sums to 1 (Estimator::Slides: it does not, and its excess over 1 is what it creates). Light
///          that rounding lets through the surface is part of `cut_off` and stands as "leaked_share" in the
///          provenance; "normal_fallback_share" is the share of interactions whose interpolated normal would
///          have sent light through the surface.
/// Errors   InvalidInput for incidence ≥ 90°, fewer than 2×2 samples or more than 2^28, a field with missing
///          samples (fill them first), more than 2^36 paths, batches that are odd or fewer than 4. DeviceError
///          where Embree fails. MethodError where all light meets mirrored copies. What `progress` throws.
/// Memory   some 170 bytes a cell (four times that for a mirrored field), 16 bytes a bin and batch in flight.
/// Bits     the same for the same options and field with any number of threads.
/// Source   Frisvad 2019, slides "BRDF measurement"; the weight is corrected (the slides' one multiplies by
///          (ω_s·m)/cosθ_i, which belongs to points uniform on the microsurface).
class PathTracer {
public:
  /// Builds the tree of triangles, once for all directions of the light.
  explicit PathTracer(const HeightField& field);
  ~PathTracer();
  PathTracer(const PathTracer&) = delete;
  PathTracer& operator=(const PathTracer&) = delete;

  [[nodiscard]] Bsdf trace(const PathTracingOptions& options, const Progress& progress = {});

private:
  struct Scene;
  std::unique_ptr<Scene> scene_;
};

/// One direction of the light: a PathTracer that is used once.
[[nodiscard]] Bsdf trace_bsdf(const HeightField& field, const PathTracingOptions& options,
                              const Progress& progress = {});

}  // namespace mezzotint
