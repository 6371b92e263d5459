#include <algorithm>
#include <array>
#include <cmath>

#include "forward/bsdf_table/bsdf_table.h"
#include "forward/bsdf_table/lobe_warp.h"

namespace mezzotint {

namespace {

using Eigen::Vector2d;

const AdaptiveMap& map_of(const BsdfTableNode& node, bool reflected) {
  return reflected ? node.reflection : node.transmission;
}

LobeChart chart_of(const BsdfTable& table, const Direction& to_light, bool reflected) {
  return reflected ? LobeChart::of_reflection(to_light) : LobeChart::of_transmission(to_light, table.relative_index);
}

// A part of the stencil with its lobe on its way to the light that was asked for.
struct MovedLobe {
  const AdaptiveMap* map;
  LobeChart at_light, at_node;

  MovedLobe(const BsdfTable& table, const StencilPart& part, const Direction& to_light, bool reflected)
      : map(&map_of(table.nodes[part.node], reflected)),
        at_light(chart_of(table, light_for(part, to_light, table.nodes[part.node].incidence), reflected)),
        at_node(chart_of(table, to_direction(table.nodes[part.node].incidence), reflected)) {}
};

// A part's share of the samples of one hemisphere.
struct Choice {
  const StencilPart* part;
  bool reflected;
  double up_to;  ///< the shares so far and this one
};

class Choices {
public:
  Choices(const BsdfTable& table, const Stencil& stencil) {
    for (const bool reflected : {true, false}) {
      for (const StencilPart& part : stencil) {
        total_ += part.weight * map_of(table.nodes[part.node], reflected).integral();
        choices_.at(count_++) = {&part, reflected, total_};
      }
    }
  }
  [[nodiscard]] double total() const { return total_; }
  /// u goes on as a uniform number of the choice. @pre total() > 0
  [[nodiscard]] const Choice& choose(double& u) const {
    const double mark = u * total_;
    std::size_t k = 0;
    while (k + 1 < count_ && mark >= choices_[k].up_to) ++k;
    while (k > 0 && share(k) <= 0.0) --k;  // the mark was rounded up to the very end
    u = std::clamp((mark - (k > 0 ? choices_[k - 1].up_to : 0.0)) / share(k), 0.0, 1.0 - 0x1p-53);
    return choices_[k];
  }

private:
  [[nodiscard]] double share(std::size_t k) const { return choices_[k].up_to - (k > 0 ? choices_[k - 1].up_to : 0.0); }
  std::array<Choice, 16> choices_;
  std::size_t count_ = 0;
  double total_ = 0.0;
};

}  // namespace

Estimate evaluate(const BsdfTable& table, const Direction& to_light, const Direction& to_viewer) {
  if (!(to_light.z() > 0.0)) return {};
  const bool reflected = to_viewer.z() >= 0.0;
  double value = 0.0, variance = 0.0, node_error = 0.0;
  std::size_t node = table.nodes.size();
  for (const StencilPart& part : stencil_of(table.incidences, to_light)) {
    if (map_of(table.nodes[part.node], reflected).empty()) continue;
    const MovedLobe lobe(table, part, to_light, reflected);
    const auto [point, jacobian] = LobeWarp(lobe.at_light, lobe.at_node)(part.turn * to_viewer.head<2>());
    const AdaptiveMap::Square square = lobe.map->at(point.x(), point.y());
    value += part.weight * jacobian * double{square.value};
    // Images of one node share its noise: added as if they were the same.
    if (part.node != node) node_error = 0.0;
    node = part.node;
    const double error = part.weight * jacobian * double{square.standard_error};
    variance += error * (2.0 * node_error + error);
    node_error += error;
  }
  return {value, std::sqrt(variance)};
}

double scattered_share(const BsdfTable& table, const Direction& to_light) {
  if (!(to_light.z() > 0.0)) return 0.0;
  const Stencil stencil = stencil_of(table.incidences, to_light);
  return Choices(table, stencil).total();
}

BsdfSample sample(const BsdfTable& table, const Direction& to_light, double u1, double u2) {
  if (!(to_light.z() > 0.0)) return {};
  const Stencil stencil = stencil_of(table.incidences, to_light);
  const Choices choices(table, stencil);
  if (!(choices.total() > 0.0)) return {};
  const auto& [part, reflected, ignored] = choices.choose(u1);
  const MovedLobe lobe(table, *part, to_light, reflected);
  const Vector2d at_node = lobe.map->sample(u1, u2);
  const Vector2d across = part->turn.transpose() * LobeWarp(lobe.at_node, lobe.at_light)(at_node).point;
  const double along = std::sqrt(std::max(0.0, 1.0 - across.squaredNorm()));
  const Direction to_viewer(across.x(), across.y(), reflected ? along : -along);
  return {to_viewer, pdf(table, to_light, to_viewer), choices.total()};
}

double pdf(const BsdfTable& table, const Direction& to_light, const Direction& to_viewer) {
  const double total = scattered_share(table, to_light);
  return total > 0.0 ? evaluate(table, to_light, to_viewer).value * std::abs(to_viewer.z()) / total : 0.0;
}

}  // namespace mezzotint
