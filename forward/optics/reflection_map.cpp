#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "forward/base/error.h"
#include "forward/optics/bin_pieces.h"
#include "forward/optics/lit_lobe.h"

namespace mezzotint {

namespace {

// Gauss–Legendre on [0, 1]: exact for polynomials of degree 7.
struct RuleNode {
  double at;
  double weight;
};
constexpr std::array<RuleNode, 4> gauss = {{{0.069431844202973712, 0.173927422568726929},
                                            {0.330009478207571868, 0.326072577431273071},
                                            {0.669990521792428132, 0.326072577431273071},
                                            {0.930568155797026288, 0.173927422568726929}}};

// Far more halvings than a lobe of α = 1e-4 needs on a single bin (about 2 × 16): a guard, not a setting.
constexpr int deepest = 60;

struct Mean {
  double sum = 0.0, weights = 0.0;
  [[nodiscard]] double value() const { return weights > 0.0 ? sum / weights : 0.0; }
};

Direction lifted(const BinPatch::Point& point) {
  return {point.x, point.y, std::sqrt(std::max(0.0, 1.0 - point.x * point.x - point.y * point.y))};
}

// A rectangle of a patch's own coordinates.
struct Part {
  double s0 = 0.0, s1 = 1.0, t0 = 0.0, t1 = 1.0;
};

enum class Split { None, Rows, AlongRows };

// How to cut a part over which the lobe changes too much for one rule; judged by the slopes at nine points.
Split split_of(const LitLobe& lobe, const BinPatch& patch, const Part& part) {
  std::array<std::array<Eigen::Array2d, 3>, 3> slope;
  Eigen::Array2d lowest = Eigen::Array2d::Constant(1e300), highest = -lowest;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      const double s = part.s0 + 0.5 * static_cast<double>(i) * (part.s1 - part.s0);
      const double t = part.t0 + 0.5 * static_cast<double>(j) * (part.t1 - part.t0);
      slope[i][j] = lobe.scaled_slope_toward(lifted(patch.at(s, t)));
      lowest = lowest.min(slope[i][j]);
      highest = highest.max(slope[i][j]);
    }
  }
  const Eigen::Array2d extent = highest - lowest;
  // Slopes between the nine points may lie outside of their box; half as much again on every side is ample.
  const Eigen::Array2d nearest = (lowest - 0.5 * extent).max(-(highest + 0.5 * extent)).max(0.0);
  if (extent.maxCoeff() <= lobe.smooth_over(std::sqrt(nearest.square().sum()))) return Split::None;
  double over_rows = 0.0, along_rows = 0.0;
  for (std::size_t k = 0; k < 3; ++k) {
    over_rows = std::max(over_rows, (slope[2][k] - slope[0][k]).abs().maxCoeff());
    along_rows = std::max(along_rows, (slope[k][2] - slope[k][0]).abs().maxCoeff());
  }
  return over_rows > along_rows ? Split::Rows : Split::AlongRows;
}

void add_part(const LitLobe& lobe, const BinPatch& patch, const Part& part, int depth, Mean& mean) {
  const Split split = depth < deepest ? split_of(lobe, patch, part) : Split::None;
  if (split == Split::Rows) {
    const double middle = 0.5 * (part.s0 + part.s1);
    add_part(lobe, patch, {part.s0, middle, part.t0, part.t1}, depth + 1, mean);
    add_part(lobe, patch, {middle, part.s1, part.t0, part.t1}, depth + 1, mean);
    return;
  }
  if (split == Split::AlongRows) {
    const double middle = 0.5 * (part.t0 + part.t1);
    add_part(lobe, patch, {part.s0, part.s1, part.t0, middle}, depth + 1, mean);
    add_part(lobe, patch, {part.s0, part.s1, middle, part.t1}, depth + 1, mean);
    return;
  }
  const double height = part.s1 - part.s0, width = part.t1 - part.t0;
  for (const RuleNode& row : gauss) {
    for (const RuleNode& node : gauss) {
      const BinPatch::Point point = patch.at(part.s0 + height * row.at, part.t0 + width * node.at);
      const double weight = point.density * height * width * row.weight * node.weight;
      mean.sum += weight * lobe.brdf(lifted(point));
      mean.weights += weight;
    }
  }
}

}  // namespace

DirectionMap reflection_map(const MicrofacetLobe& lobe, const Material& material, const DirectionAngles& to_light,
                            const DirectionGrid& grid) {
  require_valid(lobe);
  require_valid(grid);
  const double theta = to_light.theta.radians();
  require(theta >= 0.0 && theta < 0.5 * std::numbers::pi && std::isfinite(to_light.phi.radians()),
          "the light stands above the horizon: theta from 0 to less than 90 degrees");
  const LitLobe lit(lobe, material, to_direction(to_light));
  DirectionMap map(grid.size());
  for (std::size_t bin = 0; bin < map.size(); ++bin) {
    Mean mean;
    for (const BinPatch& patch : patches_of_bin(grid, bin % grid.width, bin / grid.width)) {
      add_part(lit, patch, Part{}, 0, mean);
    }
    map[bin] = mean.value();
  }
  return map;
}

}  // namespace mezzotint
