#pragma once

#include <vector>

#include "fabrication/device/virtual_printer.h"

namespace mezzotint {

/// Where the platform really put each layer.
struct LayerPlace {
  Length lower;  ///< over the platform
  Length gap;    ///< thickness that the step left for it
};

/// The job's steps, each with an error of its own.
[[nodiscard]] std::vector<LayerPlace> place_layers(const Job& job, const VirtualPrinterOptions& options);

/// The profile as a layer of this exposure and gap sees it.
[[nodiscard]] PrinterProfile profile_of_layer(const PrinterProfile& profile, const JobLayer& layer, Length gap);

/// A layer that cures this share of its gap bonds to the one above and counts as filled.
inline constexpr double filled_share = 0.9;

/// @throws MethodError naming the first layer and pixel that cures above a void.
void require_no_overhang(const Job& job, const PrinterProfile& profile);

}  // namespace mezzotint
