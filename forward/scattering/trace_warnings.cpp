#include "forward/scattering/trace_warnings.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "forward/optics/bsdf_warnings.h"

namespace mezzotint {

namespace {

// Rounding at edges loses some 1e-6 of the light; what is lost beyond this has another reason.
constexpr double harmless_loss = 1e-4;
constexpr double harmless_fallback_share = 0.01;
constexpr double harmless_left_sideways = 0.1;
constexpr double harmless_created_energy = 0.01;
constexpr std::uint32_t rows_looked_at = 64;

double number(const Bsdf& bsdf, const char* key) {
  const auto found = bsdf.provenance.find(key);
  return found == bsdf.provenance.end() ? 0.0 : std::stod(found->second);
}

using Sentences = std::vector<std::string>;

void look_for_cut_off(const PathTracingOptions& options, const Bsdf& bsdf, double relative_error,
                      Sentences& sentences) {
  const double cut_off = bsdf.energy.cut_off.value - number(bsdf, "leaked_share");
  const double stated = relative_error * (bsdf.energy.reflected.value + bsdf.energy.transmitted.value);
  if (cut_off <= std::max(harmless_loss, stated)) return;
  sentences.push_back(
      options.max_bounces == 1
          ? fmt::format("{:.2g} % of the light meets the surface again, which single scattering leaves out: more than "
                        "the stated error; use --model paths",
                        100.0 * cut_off)
          : fmt::format("{:.2g} % of the light was cut off after {} interactions and stands in no map: more than the "
                        "stated error; allow more (--max-bounces)",
                        100.0 * cut_off, options.max_bounces));
}

void look_for_lost_light(const Bsdf& bsdf, Sentences& sentences) {
  const double leaked = number(bsdf, "leaked_share");
  if (leaked > harmless_loss) {
    sentences.push_back(
        fmt::format("{:.2g} % of the light was lost by the tracer: rays that run level between the crests, or through "
                    "an edge by rounding; light from higher up, or a less steep relief, is traced without loss",
                    100.0 * leaked));
  }
  const double sideways = bsdf.energy.left_sideways.value;
  if (sideways > harmless_left_sideways) {
    sentences.push_back(
        fmt::format("{:.0f} % of the light met mirrored copies before the patch (left_sideways): the maps are those of "
                    "the rest; use a larger patch or light from higher up",
                    100.0 * sideways));
  }
}

void look_at_normals(const Bsdf& bsdf, Sentences& sentences) {
  const double share = number(bsdf, "normal_fallback_share");
  if (share <= harmless_fallback_share) return;
  sentences.push_back(
      fmt::format("in {:.2g} % of the interactions an interpolated normal would have sent light through the surface, "
                  "and the facet's was taken: the map mixes two surfaces; use geometric normals, or sample the relief "
                  "more finely",
                  100.0 * share));
}

void look_for_created_energy(const PathTracingOptions& options, const Bsdf& bsdf, Sentences& sentences) {
  if (options.estimator != Estimator::Slides) return;
  const EnergyAudit& energy = bsdf.energy;
  const double sum = energy.reflected.value + energy.transmitted.value + energy.absorbed.value +
                     energy.left_sideways.value + energy.cut_off.value;
  if (std::abs(sum - 1.0) <= harmless_created_energy) return;
  sentences.push_back(
      fmt::format("the slides' weight does not conserve energy: of each watt that comes in, {:.3g} W are "
                  "accounted for; it is for comparison only (--estimator flux)",
                  sum));
}

void look_at_tolerance(const PathTracingOptions& options, const Bsdf& bsdf, double relative_error,
                       Sentences& sentences) {
  if (!(options.tolerance > 0.0) || relative_error <= options.tolerance) return;
  const double paths = number(bsdf, "samples");
  sentences.push_back(
      fmt::format("the tolerance of {:.2g} was not met: the relative standard error is {:.2g} after {:.2g} paths, and "
                  "some {:.0e} would be needed",
                  options.tolerance, relative_error, paths, paths * std::pow(relative_error / options.tolerance, 2.0)));
}

void append(const Sentences& more, Sentences& sentences) {
  sentences.insert(sentences.end(), more.begin(), more.end());
}

}  // namespace

std::vector<std::string> trace_warnings(const PathTracingOptions& options, const Bsdf& bsdf, bool is_mesh) {
  Sentences sentences;
  const double error = relative_error(bsdf.grid, bsdf.reflection);
  look_for_created_energy(options, bsdf, sentences);
  look_for_cut_off(options, bsdf, error, sentences);
  if (!is_mesh) look_for_lost_light(bsdf, sentences);
  look_at_normals(bsdf, sentences);
  look_at_tolerance(options, bsdf, error, sentences);
  append(map_warnings(bsdf), sentences);
  return sentences;
}

double caught_light(const PeriodicTile& tile, const DirectionAngles& incidence) {
  const Direction light = to_direction(incidence);
  const double along_x = light.x() / light.z(), along_y = light.y() / light.z();
  const std::uint32_t step = std::max<std::uint32_t>(1, tile.rows() / rows_looked_at);
  double caught = 0.0, facets = 0.0;
  for (std::uint32_t row = 0; row < tile.rows(); row += step) {
    const std::uint32_t upper = row + 1 == tile.rows() ? 0 : row + 1;
    for (std::uint32_t column = 0; column < tile.columns(); ++column) {
      const std::uint32_t right = column + 1 == tile.columns() ? 0 : column + 1;
      const double z00 = double{tile.height(column, row)}, z10 = double{tile.height(right, row)};
      const double z01 = double{tile.height(column, upper)}, z11 = double{tile.height(right, upper)};
      caught += std::max(0.0, 1.0 - (z10 - z00) * along_x - (z11 - z10) / tile.cell_y() * along_y);
      caught += std::max(0.0, 1.0 - (z11 - z01) * along_x - (z01 - z00) / tile.cell_y() * along_y);
      facets += 2.0;
    }
  }
  return caught / facets;
}

std::vector<std::string> splat_warnings(const Bsdf& bsdf, double caught) {
  Sentences sentences;
  const double created = std::max(0.0, caught - 1.0);
  const double again = std::max(0.0, caught - number(bsdf, "unadjusted_energy"));
  if (std::max(created, again) > harmless_created_energy) {
    sentences.push_back(
        fmt::format("slopes alone know neither shadows, which would take {:.2g} % of the light away, nor further "
                    "interactions, which would scatter {:.2g} % anew; the maps are divided by what is left, which does "
                    "not mend their shape: use --model auto or paths",
                    100.0 * created, 100.0 * again));
  }
  append(map_warnings(bsdf), sentences);
  return sentences;
}

}  // namespace mezzotint
