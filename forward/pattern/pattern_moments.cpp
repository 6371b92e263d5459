#include "forward/pattern/pattern_moments.h"

#include <array>
#include <cmath>
#include <numbers>

#include "forward/pattern/line_integral_convolution.h"
#include "forward/pattern/octave_sum.h"
#include "forward/pattern/pattern_tree.h"
#include "forward/pattern/pattern_waves.h"
#include "forward/pattern/sparse_noise.h"

namespace mezzotint {

namespace {

constexpr double pi = std::numbers::pi;

template <typename Kind>
concept OfOctaves = requires(const Kind& kind) {
  octave_sum(kind);
};

SlopeCovariance sum(const SlopeCovariance& a, const SlopeCovariance& b) {
  return {a.xx + b.xx, a.yy + b.yy, a.xy + b.xy};
}
SlopeCovariance scaled(const SlopeCovariance& a, double factor) {
  return {factor * a.xx, factor * a.yy, factor * a.xy};
}

// C = Mᵀ diag(u, v) M: mean square slopes in the pattern's units to covariance a µm.
SlopeCovariance slopes_through(const PatternMap& m, double u, double v) {
  return {u * m.ux * m.ux + v * m.vx * m.vx, u * m.uy * m.uy + v * m.vy * m.vy, u * m.ux * m.uy + v * m.vx * m.vy};
}

template <OfOctaves Kind>
std::optional<GrayMoments> moments(const Kind& kind, const Sheet& sheet) {
  const OctaveSum octaves = octave_sum(kind);
  GrayMoments result{octaves.offset, 0.0, {}};
  for (const Octave& octave : octaves.octaves) {
    const PatternMap map = fitted(in_units(map_of(kind, sheet), 1.0 / octave.frequency, 1.0 / octave.frequency), sheet);
    const double share = octave.weight * octave.weight, mean = octaves.absolute ? mean_noise_magnitude : 0.0;
    result.mean += octave.weight * mean;
    result.variance += share * (noise_variance_at_z0 - mean * mean);
    // |n| is as steep as n, and its slopes, like those of n, have no mean: what is mixed of two octaves vanishes.
    const double slope = share * 0.5 * noise_plane_gradient_square_at_z0;
    result.slopes = sum(result.slopes, slopes_through(map, slope, slope));
  }
  return result;
}

std::optional<GrayMoments> moments(const LineIntegralConvolution& lines, const Sheet& sheet) {
  if (!lines.singularities.empty()) return {};
  const LineSlopes slopes = smeared_noise(lines.length / lines.scale);
  return GrayMoments{0.5, noise_variance_at_z0,
                     slopes_through(fitted(map_of(lines, sheet), sheet), slopes.across, slopes.along)};
}

std::optional<GrayMoments> moments(const Sinusoid& sinusoid, const Sheet& sheet) {
  const double slope = 0.25 * pi * pi;
  return GrayMoments{0.5, 0.0625, slopes_through(fitted(map_of(sinusoid, sheet), sheet), slope, slope)};
}

std::optional<GrayMoments> moments(const Ridges& ridges, const Sheet& sheet) {
  const PatternMap map = fitted_along_u(map_of(ridges, sheet), sheet);
  return GrayMoments{0.5, 1.0 / 12.0, slopes_through(map, 1.0 / (ridges.skew * (1.0 - ridges.skew)), 0.0)};
}

std::optional<GrayMoments> moments(const PatternSum& pattern, const Sheet& sheet) {
  if (!parts_are_uncorrelated(pattern.parts, sheet, pattern.parts.size())) return {};
  const Length height = height_of(pattern);
  GrayMoments total;
  for (const PatternPart& part : pattern.parts) {
    const auto own = closed_form_moments(part.pattern, sheet);
    if (!own) return {};
    const double share = height_of(part.pattern) / height;
    total.mean += share * own->mean;
    total.variance += share * share * own->variance;
    total.slopes = sum(total.slopes, scaled(own->slopes, share * share));
  }
  return total;
}

// One factor after the other: E(fg) = E f E g, E(fg)² = E f² E g², E(fg)_x² = E f_x² E g² + E f² E g_x²; in the mixed
// term stands E f f_x, which is half the slope of a constant.
std::optional<GrayMoments> moments(const PatternProduct& pattern, const Sheet& sheet) {
  if (!parts_are_uncorrelated(pattern.parts, sheet, 2)) return {};
  GrayMoments total{1.0, 0.0, {}};
  for (const PatternPart& part : pattern.parts) {
    const auto own = closed_form_moments(part.pattern, sheet);
    if (!own) return {};
    const double square = total.variance + total.mean * total.mean, own_square = own->variance + own->mean * own->mean;
    total.slopes = sum(scaled(total.slopes, own_square), scaled(own->slopes, square));
    total.mean *= own->mean;
    total.variance = square * own_square - total.mean * total.mean;
  }
  return total;
}

std::optional<GrayMoments> moments(const TurnedPattern& pattern, const Sheet& sheet) {
  return closed_form_moments(pattern.parts[0].pattern, sheet_below(pattern, sheet));
}

// Where one part ends and another begins stand cliffs.
std::optional<GrayMoments> moments(const MaskedPattern&, const Sheet&) { return {}; }
std::optional<GrayMoments> moments(const PatternRegions&, const Sheet&) { return {}; }

}  // namespace

std::optional<GrayMoments> closed_form_moments(const Pattern& pattern, const Sheet& sheet) {
  return std::visit([&](const auto& kind) { return moments(kind, sheet); }, pattern);
}

}  // namespace mezzotint
