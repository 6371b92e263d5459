#pragma once

#include <cstddef>
#include <string>

#include "experiments/configuration/toml_table.h"
#include "inverse/design/design_goal.h"
#include "inverse/search/minimize.h"

namespace mezzotint {

/// `[search]`: how a design is found.
struct SearchSpecification {
  MinimizeOptions minimize;
  MeasureSum objective;  ///< empty: "automatic"
  std::size_t draws = 8;
  std::size_t fresh_draws = 12;

  /// Whether the objective is named and counts slopes alone, or light.
  [[nodiscard]] bool by_slopes() const;
  [[nodiscard]] bool by_light() const { return !objective.empty() && !by_slopes(); }
};

/// @param has_lobe  whether the target names a lobe; an objective that compares lobes is refused where it does not
/// @throws ConfigurationError
[[nodiscard]] SearchSpecification read_search(TomlTable table, bool has_lobe);

}  // namespace mezzotint
