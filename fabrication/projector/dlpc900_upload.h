#pragma once

#include "fabrication/device/light_engine.h"
#include "fabrication/projector/dlpc900_link.h"

namespace mezzotint::dlpc900 {

/// A gray picture as one encoded image a controller: the left half to the primary, the right half to the secondary.
[[nodiscard]] std::vector<std::vector<std::uint8_t>> encode_halves(const ShownPicture& picture,
                                                                   std::size_t controllers);

/// Full-speed USB carries one report a millisecond at best, acknowledgements included: 64 kB/s at most.
[[nodiscard]] UploadEstimate estimate_upload(const std::vector<std::vector<std::uint8_t>>& images);

/// Loads image 0 of every controller. An image whose acknowledgement is lost is loaded anew, once.
void upload(Link& link, const std::vector<std::vector<std::uint8_t>>& images);

}  // namespace mezzotint::dlpc900
