#pragma once

#include <vector>

#include "fabrication/device/virtual_printer.h"
#include "forward/process/depth_cure.h"

namespace mezzotint {

/// Where the platform really put each layer.
struct LayerPlace {
  Length lower;  ///< over the platform
  Length gap;    ///< thickness that the step left for it
};

/// The job's steps, each with an error of its own.
[[nodiscard]] std::vector<LayerPlace> place_layers(const Job& job, const VirtualPrinterOptions& options);

/// A layer as the dose in depth takes it: the gap that the platform left, and its exposure against the profile's.
[[nodiscard]] StackLayer stack_layer(const PrinterProfile& profile, const JobLayer& layer, Length gap);

/// A layer that cures this share of its gap bonds to the one above and counts as filled.
inline constexpr double filled_share = 0.9;

/// Whether the top of the print is a height field over the part: what cures by its own light lies on a layer that is
/// filled, or is an overhang that fills its own layer and hangs on to a neighbour that is held.
/// @throws MethodError naming the first layer (from the last one down) and pixel where that does not hold: above
///         a layer that cures and does not fill; a film over a void that does not fill its layer, whose place in the
///         gap no dose tells; an island that nothing holds.
void require_height_field(const Job& job, const PrinterProfile& profile);

}  // namespace mezzotint
