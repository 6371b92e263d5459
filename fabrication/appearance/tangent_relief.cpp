#include "fabrication/appearance/tangent_relief.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Geometry>

#include "fabrication/appearance/solid_relief.h"
#include "forward/base/error.h"
#include "forward/pattern/pattern_tree.h"
#include "forward/pattern/solid_noise.h"

namespace mezzotint {

namespace {

using Eigen::Vector3d;
using Shared = std::shared_ptr<const FieldSurface>;

template <class Kind>
concept NoiseLike = std::constructible_from<SolidPattern, const Kind&>;

// Triangles may be longer than waves: what bends is the field, not the wave. On a sphere of ten waves' radius this
// leaves an error of 2 % in the wavelength where rings could be perfect, and twice the length 10 %.
constexpr double edges_a_wave = 1.5;

std::array<double, 3> array_of(const Vector3d& v) { return {v.x(), v.y(), v.z()}; }

// The pattern's x axis turned by `direction`: where its slopes are steep.
Vector3d steep_direction(const TangentFrame& frame, Angle direction) {
  return std::cos(direction.radians()) * frame.along + std::sin(direction.radians()) * frame.normal.cross(frame.along);
}
TangentFrame frame_of(const FieldSurface& on, const SurfacePoint& point) {
  return frame_at(on.surface, on.field.directions, point.triangle, point.weights);
}
// Along the long side of what is drawn out.
std::array<double, 3> long_direction(const FieldSurface& on, const SurfacePoint& point, Angle direction) {
  const TangentFrame frame = frame_of(on, point);
  return array_of(frame.normal.cross(steep_direction(frame, direction)));
}

std::vector<Vector3d> wave_directions(const FieldSurface& on, Angle direction) {
  std::vector<Vector3d> directions;
  for (std::size_t node = 0; node < on.surface.normals.size(); ++node)
    directions.push_back(steep_direction({on.field.directions[node], on.surface.normals[node]}, direction));
  return directions;
}

template <NoiseLike Kind>
TangentRelief relief_of(const Kind& kind, const Shared& on) {
  if (kind.stretch == 1.0) return {solid_relief(kind), {}};
  return {{[kind, on]() -> ReliefProbe {
             auto pattern = std::make_shared<SolidPattern>(kind);
             return [pattern, kind, on](const SurfacePoint& point) {
               const auto at = array_of(1e3 * point.place_mm);
               return kind.height.um() *
                      pattern->gray_along(at, long_direction(*on, point, kind.direction), kind.stretch);
             };
           },
           Length{}, kind.height},
          {}};
}

TangentRelief relief_of(const LineIntegralConvolution& lines, const Shared& on) {
  require(lines.singularities.empty(),
          "on a part the direction field has the singularities; leave `singularities` out of the pattern");
  return {{[lines, on]() -> ReliefProbe {
             auto noise = std::make_shared<SolidNoise>(lines.seed, lines.hash);
             return [noise, lines, on](const SurfacePoint& point) {
               const Vector3d at = 1e3 / lines.scale.um() * point.place_mm;
               const double value = noise->smeared(array_of(at), long_direction(*on, point, lines.direction),
                                                   lines.length / lines.scale);
               return lines.height.um() * std::clamp(0.5 + value, 0.0, 1.0);
             };
           },
           Length{}, lines.height},
          {}};
}

TangentRelief relief_of(const Ridges& ridges, const Shared& on) {
  require(ridges.skew == 0.5, "on a part ridges are symmetric (skew = 0.5): a field of lines has no head");
  auto phase = std::make_shared<const SurfacePhase>(
      surface_phase(on->surface, wave_directions(*on, ridges.direction), ridges.wavelength));
  TangentRelief result{{}, {phase->figures}};
  result.relief = {[phase, ridges]() -> ReliefProbe {
                     return [phase, ridges](const SurfacePoint& point) {
                       // Even about crests and valleys, so that the line's orientation does not matter.
                       const double turns = phase_at(*phase, point.triangle, point.weights);
                       return ridges.height.um() * 2.0 * std::abs(turns - std::round(turns));
                     };
                   },
                   Length{}, ridges.height};
  return result;
}

TangentRelief relief_of(const Sinusoid& sinusoid, const Shared& on) {
  struct Phases {
    SurfacePhase u, v;
  };
  auto phases = std::make_shared<const Phases>(
      Phases{surface_phase(on->surface, wave_directions(*on, sinusoid.direction), sinusoid.wavelength_u),
             surface_phase(on->surface, wave_directions(*on, sinusoid.direction + 90.0_deg), sinusoid.wavelength_v)});
  TangentRelief result{{}, {phases->u.figures, phases->v.figures}};
  result.relief = {[phases, sinusoid]() -> ReliefProbe {
                     return [phases, sinusoid](const SurfacePoint& point) {
                       // A line turned around changes the sign of both, and their product stays.
                       const double u = phase_at(phases->u, point.triangle, point.weights);
                       const double v = phase_at(phases->v, point.triangle, point.weights);
                       const double turn = 2.0 * std::numbers::pi;
                       return sinusoid.height.um() * (0.5 + 0.5 * std::sin(turn * u) * std::sin(turn * v));
                     };
                   },
                   Length{}, sinusoid.height};
  return result;
}

template <Composed Kind>
TangentRelief relief_of(const Kind&, const Shared&) {
  throw InvalidInput("on a part patterns are of a simple kind; `[[region]]` puts several of them on it");
}

}  // namespace

TangentRelief tangent_relief(const Pattern& pattern, const Shared& on) {
  require_valid(pattern);
  return std::visit([&](const auto& kind) { return relief_of(kind, on); }, pattern);
}

std::optional<Length> longest_edge_for(const Pattern& pattern) {
  if (const auto* ridges = std::get_if<Ridges>(&pattern)) return ridges->wavelength * edges_a_wave;
  if (const auto* sinusoid = std::get_if<Sinusoid>(&pattern))
    return std::min(sinusoid->wavelength_u, sinusoid->wavelength_v) * edges_a_wave;
  return {};
}

}  // namespace mezzotint
