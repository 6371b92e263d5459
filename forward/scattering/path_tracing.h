#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>

#include "forward/base/progress.h"
#include "forward/optics/bsdf.h"
#include "forward/optics/material.h"
#include "forward/scattering/sample_strata.h"
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

/// What finds the facet that a ray meets.
enum class TracerKind {
  HeightField,  ///< HeightFieldTracer: watertight, many rays at once
  Embree        ///< ReliefScene: the independent reference
};

/// Whether single scattering comes from a dense splat of all facets, without what a sweep and a pilot tell to be in
/// shadow or to meet the surface again, and rays only correct it, most of them where that is likely to be wrong.
enum class ControlVariate {
  Automatic,  ///< where it pays: s·tanθ below `control_variate_limit`
  Off,
  On  ///< refused where it is not possible: interpolated normals, mirrored fields, absorption, Estimator::Slides, light
      ///< spread over a bin, Embree
};

/// Up to this product of the RMS gradient s and tanθ the corrected splat is known to be the better estimator; above it
/// a beam is aimed from above. Measured, squared error times time of the splat ÷ that of the beam (index 1.5, 2^17
/// paths, 512² cells; in brackets 128²): 0.05 (0.22) at s·tanθ = 4.5 (s = 0.8, 80°), 0.05 (0.21) at 9 (0.8, 85°), 0.51
/// (0.86) at 11 (2, 80°), 0.64 (1.13) at 23 (2, 85°), 0.03 (0.61) at 46 (0.8, 89°), 0.19 (1.17) at 115 (2, 89°).
inline constexpr double control_variate_limit = 20.0;

struct PathTracingOptions {
  DirectionAngles incidence;
  /// Light from all directions of the map's bin that holds `incidence`, uniformly in projected solid
  /// angle, instead of from one direction (for tests of reciprocity).
  bool spread_incidence_over_bin = false;
  DirectionGrid grid;
  Material material = Dielectric{};
  /// The most paths; rounded up to batches × a power of two (a batch is one set of Morton strata), so at most
  /// doubled. Time is linear in it. Without `tolerance` and `seconds` all are traced in one pass.
  std::uint64_t samples = 1U << 20;
  /// Stop earlier, at this relative standard error of the reflection √(Σ a·se² / Σ a·f²), a = pixel ∩ disc; 0: no.
  double tolerance = 0.0;
  /// Stop earlier, after so many seconds; 0: no. The result then depends on the machine.
  double seconds = 0.0;
  /// Independent randomisations, from which the standard errors come (so with batches − 1 degrees of freedom); even, at
  /// least 4. Few batches are finely stratified ones: 8 instead of 32 halve the time to an error.
  std::uint32_t batches = 8;
  /// Interactions a path may have. What is cut off is reported. 1: single scattering with traced visibility.
  std::uint32_t max_bounces = 64;
  /// Maps of the reflection by order of interaction, kept apart: so many; the last holds all higher orders. 0: none.
  std::uint32_t bounce_orders = 0;
  Estimator estimator = Estimator::Flux;
  NormalKind normals = NormalKind::Geometric;
  TracerKind tracer = TracerKind::HeightField;
  Placement placement = Placement::Strata;
  /// Follow one branch of every interaction alone, by roulette, as the slides do; for comparison only: 10 to 25 times
  /// the paths for the same error, at index 1.5 and steep incidence.
  bool roulette_first = false;
  ControlVariate control_variate = ControlVariate::Automatic;
  /// Where to keep what was traced: read at the start if the file exists, written after every pass. Going on gives the
  /// same bits as never having stopped; a run may be refined later with more samples or a smaller tolerance.
  std::filesystem::path state;
  std::uint64_t seed = 1;
};

/// Relative standard error of a map: √(Σ a·se² / Σ a·f²), a = pixel ∩ disc.
[[nodiscard]] double relative_error(const DirectionGrid& grid, const MapEstimate& map);

/// The BSDF of a relief by path tracing: rays at stratified points of the macro area, in Morton order; Fresnel at every
/// interaction; both branches of the first two kept by expected value, Russian roulette between reflection and
/// refraction at deeper ones; where it pays, single scattering by a dense splat of all facets, which rays only correct
/// (see CorrectionPlan: what the splat leaves out, and where the rays go).
///
/// Ends     a periodic field continues periodically; a mirrored one has its rays aimed at the original (in the
///          plane of the mean height) and is continued by mirrored copies; light whose first interaction is with
///          a copy is `left_sideways`. That light is no part of the maps, and they are normalised by the rest:
///          Σ f · (projected solid angle) = reflected / (1 − left_sideways).
/// Energy   the audit sums to 1 (Estimator::Slides: it does not, and its excess over 1 is what it creates). Light
///          that rounding lets through the surface is part of `cut_off` and stands as "leaked_share" in the
///          provenance; "normal_fallback_share" is the share of interactions whose interpolated normal would
///          have sent light through the surface. With the control variate the shares are estimates whose sum is known
///          to be 1: that is used to lower their noise, and "unadjusted_energy" tells the sum before; "splat_left_out"
///          tells what the splat left to the paths, "correction_density" on how much of the area they were spent.
/// Errors   InvalidInput for incidence ≥ 90°, fewer than 2×2 samples or more than 2^28, a field with missing
///          samples (fill them first), more than 2^36 paths, batches that are odd or fewer than 4. DeviceError
///          where Embree fails. MethodError where all light meets mirrored copies. FileError for a state that is
///          damaged or belongs to another run. What `progress` throws.
/// Memory   12 bytes a cell (Embree: 170; four times as much for a mirrored field), 6 more with the control variate
///          (and 12 for a moment), 48 bytes a bin and batch.
/// Bits     the same for the same options and field with any number of threads (not where `seconds` ended it).
/// Source   Frisvad 2019, slides "BRDF measurement", "Progressive updates"; the weight is corrected (the slides' one
///          multiplies by (ω_s·m)/cosθ_i, which belongs to points uniform on the microsurface).
class PathTracer {
public:
  /// Builds what the tracers need, once for all directions of the light.
  explicit PathTracer(const HeightField& field);
  ~PathTracer();
  PathTracer(const PathTracer&) = delete;
  PathTracer& operator=(const PathTracer&) = delete;

  [[nodiscard]] Bsdf trace(const PathTracingOptions& options, const Progress& progress = {});

  /// Single scattering without rays: the dense splat of all facets alone (the rung `slopes`). Exact for what it is, so
  /// its standard errors are 0; shadows and further interactions are left out, which creates energy at grazing
  /// incidence: the maps are divided by the total, which stands in the provenance as "unadjusted_energy".
  /// @throws InvalidInput where ControlVariate::On would be refused.
  [[nodiscard]] Bsdf splat(const PathTracingOptions& options);

  /// Facts that say which method a relief needs.
  struct ReliefFacts {
    double rms_gradient = 0.0;   ///< s
    double steepest = 0.0;       ///< largest |∇z| of all facets
    double rms_height_um = 0.0;  ///< Sq, about the mean height
  };
  [[nodiscard]] ReliefFacts facts();

private:
  struct Scene;
  std::unique_ptr<Scene> scene_;
};

/// One direction of the light: a PathTracer that is used once.
[[nodiscard]] Bsdf trace_bsdf(const HeightField& field, const PathTracingOptions& options,
                              const Progress& progress = {});

}  // namespace mezzotint
