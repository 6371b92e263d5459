#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "forward/pattern/pattern.h"
#include "forward/pattern/pattern_tree.h"

/// Inside of forward/pattern.

namespace mezzotint {

/// Where a pattern of a composition is drawn, and which derivatives are wanted: toward some numbers of the whole.
struct PatternPlace {
  Sheet sheet;
  std::span<const std::string> names;  ///< of the numbers, with their paths from the whole pattern
  std::vector<PatternMap> slopes;      ///< ∂(sheet.place)/∂(number), one each
  std::string path;                    ///< what stands before the names of this pattern's numbers: "parts[1]."

  /// Which of the names is this pattern's own number `name`.
  [[nodiscard]] std::optional<std::size_t> find(std::string_view name) const;
};

[[nodiscard]] PatternPlace whole_place(const Sheet& sheet, std::span<const std::string> names);

/// The place of a composition's part.
[[nodiscard]] PatternPlace place_below(const PatternPlace& place, std::string_view kind, std::size_t part);
[[nodiscard]] PatternPlace place_below(const PatternPlace& place, const TurnedPattern& turned);

/// The map to a kind's own units, for its coarsest octave, with its derivatives.
struct SteepMap {
  PatternMap map;
  std::vector<PatternMap> slopes;  ///< one a number

  /// Whether it changes with that number.
  [[nodiscard]] bool moves(std::size_t number) const;
};
[[nodiscard]] SteepMap steep_map(const Noise& noise, const PatternPlace& place);
[[nodiscard]] SteepMap steep_map(const FractionalBrownianMotion& motion, const PatternPlace& place);
[[nodiscard]] SteepMap steep_map(const Turbulence& turbulence, const PatternPlace& place);
[[nodiscard]] SteepMap steep_map(const LineIntegralConvolution& lines, const PatternPlace& place);
[[nodiscard]] SteepMap steep_map(const Sinusoid& sinusoid, const PatternPlace& place);
[[nodiscard]] SteepMap steep_map(const Ridges& ridges, const PatternPlace& place);

/// The height of a pattern, with its derivatives. Of two equal heights of which the larger counts, the first.
struct SteepHeight {
  double um = 0.0;
  std::vector<double> slopes;  ///< one a number, in µm a unit of it
};
[[nodiscard]] SteepHeight steep_height(const Pattern& pattern, const std::string& path,
                                       std::span<const std::string> names);

}  // namespace mezzotint
