#pragma once

#include <string>
#include <vector>

#include "inverse/free_form/free_form.h"

/// Inside of inverse: the shapes that a free-form search grows from. The shape decides which valley it ends in.

namespace mezzotint {

struct StartShape {
  std::string name;  ///< in words
  HeightField wanted;
};

/// Noise in two scales, crossed waves, ridges across the longer axis of the goal's first lobe, and a saw that leans
/// toward its middle: each a periodic tile of one height a pixel, and all but the saw eight tenths of a layer high.
[[nodiscard]] std::vector<StartShape> start_shapes(const LobeTarget& goal, const PrinterProfile& printer,
                                                   const FreeFormOptions& options);

}  // namespace mezzotint
