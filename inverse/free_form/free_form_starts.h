#pragma once

#include <string>
#include <vector>

#include "inverse/free_form/free_form.h"

/// Inside of inverse/free_form: the shapes that a search grows from. The shape decides which valley it ends in.

namespace mezzotint {

struct StartShape {
  std::string name;               ///< in words
  std::vector<double> wanted_um;  ///< one a pixel; below 0 where nothing shall cure
};

/// Noise in two scales, crossed waves, and ridges across the longer axis of the goal's first lobe, as steep as that is
/// wide; each eight tenths of a layer high and lifted to its top, where gray levels are finest. Where that lobe leans
/// to a side also saws that lean with it: with as few teeth as the layer's height allows for its slope, and one and two
/// more, always a whole number along either axis of the tile; a dark pixel at the foot of each cliff makes it steep.
[[nodiscard]] std::vector<StartShape> start_shapes(const LobeTarget& goal, const PrinterProfile& printer,
                                                   const FreeFormOptions& options);

}  // namespace mezzotint
