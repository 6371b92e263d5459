#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "forward/scattering/cell_density.h"
#include "forward/tracing/periodic_tile.h"

namespace mezzotint {

/// What became of one point that a pilot looked at.
struct PilotOutcome {
  std::uint32_t column = 0, row = 0;  ///< its cell
  bool faces_light = false;
  bool lit = false;
  bool reflected_met = false;  ///< the reflected light meets the surface again
  bool refracted_met = false;
  float way_up = 0.0F;     ///< z of the reflected light's direction
  float reflected = 0.0F;  ///< light that the facet reflects or refracts, for each light on its macro area
  float refracted = 0.0F;
  float reflected_on = 0.0F;  ///< share of the reflected light that is reflected again where it meets the surface
};

/// What the splat takes for granted for one direction of the light, and how likely that is wrong where: the density
/// that the points of the correction are drawn from.
///
/// Shadows   come from a sweep.
/// Meetings  whether the light that a cell reflects meets the surface again. A pilot, a point in every block of 4 × 4
///           cells, tells how likely that is by class: how many pilots of the blocks around met it, and how steeply a
///           facet reflects. Where neither is near certain, a ray from the cell's middle decides.
/// Doubt     how often a cell is judged wrongly, by class: what it was judged, and whether its neighbours were judged
///           alike. The pilot's points tell.
/// All are thrown away then: the density does not depend on any path that it weighs. It is the same for every seed.
class CorrectionPlan {
public:
  static constexpr std::uint32_t block = 4;
  /// Cells of the pilot, one a block.
  struct PilotGrid {
    std::uint32_t columns, rows;
  };
  [[nodiscard]] static PilotGrid pilot_grid(const PeriodicTile& tile);

  /// @param lit       as sweep_light tells.
  /// @param outcomes  of the pilot, row after row.
  CorrectionPlan(const PeriodicTile& tile, std::vector<std::uint8_t> lit, const std::vector<PilotOutcome>& outcomes);

  /// The share of a cell that the splat takes for lit.
  [[nodiscard]] float lit_share(std::size_t cell) const { return 0.5F * static_cast<float>(lit_[cell]); }
  /// Whether the splat takes the light that a facet reflects for gone; otherwise it is left to the correction.
  [[nodiscard]] bool escapes(std::size_t cell, float way_up) const { return way_up > 0.0F && meets_[cell] == 0; }

  /// Nearly nothing is shadowed or meets the surface again: points are drawn evenly, and nothing else is asked.
  [[nodiscard]] bool quiet() const { return quiet_; }
  /// Judges a cell by its class; false where a ray has to.
  [[nodiscard]] bool judge(std::uint32_t column, std::uint32_t row, float way_up);
  /// The judgement of a ray.
  void decide(std::size_t cell, bool meets) { meets_[cell] = meets ? 1 : 0; }
  /// When all cells are judged: how much the judgements are to be doubted.
  void learn_doubt(const std::vector<PilotOutcome>& outcomes);

  /// Mean square of what a point of a facet is likely to change, in units of the maps' mean.
  [[nodiscard]] float likely_square(std::size_t cell, float way_up, float reflected, float refracted) const;
  /// The density, from the root mean square of what the facets of each cell are likely to change.
  void set_density(std::vector<float> importance);
  [[nodiscard]] const CellDensity& density() const { return *density_; }

  /// Shares of the cells that the splat leaves out.
  [[nodiscard]] double dark_share() const;
  [[nodiscard]] double meeting_share() const;
  /// (Σ q)² / (cells · Σ q²) of the density q: 1 for an even one, 0.1 for one that is even on a tenth of the area.
  [[nodiscard]] double density_share() const { return density_share_; }

private:
  static constexpr std::size_t crowd_classes = 9, way_classes = 24, lit_classes = 9, meet_classes = 6;

  [[nodiscard]] static std::size_t way_class(float way_up);
  void learn_meetings(const std::vector<PilotOutcome>& outcomes);
  void learn_scale(const std::vector<PilotOutcome>& outcomes);
  [[nodiscard]] std::vector<std::uint8_t> count_around(const std::vector<PilotOutcome>& outcomes,
                                                       bool PilotOutcome::*met) const;
  [[nodiscard]] std::vector<std::uint8_t> with_neighbours(const std::vector<std::uint8_t>& judged) const;

  std::uint32_t columns_, rows_;
  PilotGrid grid_;
  bool quiet_ = false;
  std::vector<std::uint8_t> lit_, meets_;             ///< a cell
  std::vector<std::uint8_t> lit_class_, meet_class_;  ///< a cell: its judgement, and how near others differ
  std::array<float, lit_classes> wrongly_lit_{};      ///< mean square of how wrong
  std::array<float, meet_classes> wrong_way_{}, meets_again_{};
  std::vector<std::uint8_t> crowd_, crowd_below_;  ///< a block: class of how many pilots around met the surface
  std::array<std::array<float, way_classes>, crowd_classes> chance_{};  ///< that reflected light meets the surface
  std::array<float, crowd_classes> chance_below_{};
  float reflected_on_ = 0.0F;  ///< mean square of the share that is reflected again there
  float per_reflected_ = 0.0F, per_refracted_ = 0.0F;
  std::optional<CellDensity> density_;
  double density_share_ = 1.0;
};

}  // namespace mezzotint
