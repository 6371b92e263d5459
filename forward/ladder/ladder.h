#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "forward/base/progress.h"
#include "forward/base/units.h"
#include "forward/scattering/path_tracing.h"

namespace mezzotint {

/// The models of a relief's BSDF, the cheapest first. (Diffraction will be one more. Single scattering with traced
/// visibility is none: with the splat as control variate it costs what `Paths` costs; see docs/physics.md.)
enum class Rung {
  Moments,  ///< Gaussian slopes of the measured slope covariance: Beckmann with Smith masking–shadowing
  Slopes,   ///< the real slope distribution, by a dense splat of all facets; no shadows, no second interaction
  Paths     ///< everything that rays can do
};
[[nodiscard]] std::string_view name_of(Rung rung);

struct LadderOptions {
  DirectionAngles incidence;
  DirectionGrid grid;
  Material material = Dielectric{};
  double tolerance = 0.02;  ///< of the reflection map: relative_l2 to `Paths` without noise
  Length wavelength = Length::from_nm(550.0);
  std::uint64_t most_samples = std::uint64_t{1} << 30;
  std::uint64_t seed = 1;
};

/// What a rung would be off by, and how that is known.
struct Forecast {
  Rung rung = Rung::Paths;
  double error = 0.0;  ///< upper bound, some 95 %
  std::string reason;
};

struct Choice {
  Rung rung = Rung::Paths;
  std::vector<Forecast> forecasts;    ///< of the rungs that were looked at, the cheapest first
  std::vector<std::string> warnings;  ///< where geometric optics itself is in doubt
};

/// Gaussian slopes alone, for a field whose mean slope is none. Exact for what it is.
[[nodiscard]] Bsdf bsdf_from_moments(const HeightField& field, const LadderOptions& options);

/// The cheapest rung whose forecast meets the tolerance, run to that tolerance.
///
/// How       A relief that is nowhere steep enough to shadow or to be met twice needs no ray: `Slopes` is exact. For
///           others a pilot of paths measures what the splat leaves out. A mirrored patch and an absorbing medium have
///           no splat, and are always traced. `Moments` is never taken where there is a
///           relief: its lobe costs more than the splat (60 reliefs of 256²: 3 ms and up, against 1.5 to 2), which is
///           nearer. `Paths` corrects a splat of its own, which leaves out shadows and meetings; the pilot has made its
///           plan.
/// Measured  60 scenes drawn at random (tests/benchmark/auto_study.cpp: nine families of reliefs, s = 0.03 … 1, 0 …
///           85°, six materials) at 5 % and 1 %: true error within the tolerance in all; time over that of the cheapest
///           rung that met it 1.08 and 1.06 in the median, 8.5 and 8.8 at worst, where both took milliseconds.
/// Result    provenance "model" (the rung), "choice" (why, in words), "predicted_error", and "warnings".
/// @throws   what PathTracer::trace throws.
[[nodiscard]] Bsdf simulate_auto(const HeightField& field, PathTracer& tracer, const LadderOptions& options,
                                 const Progress& progress = {}, Choice* choice = nullptr);

/// Words about whether rays are the right model: feature size and 4π·Sq·cosθ/λ. Empty where they are.
[[nodiscard]] std::vector<std::string> geometric_optics_warnings(const PathTracer::ReliefFacts& facts,
                                                                 const LadderOptions& options);

}  // namespace mezzotint
