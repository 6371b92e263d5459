#pragma once

#include <functional>
#include <span>

#include "forward/process/printed_relief.h"

namespace mezzotint {

/// Spreads the light of an image (see `spread_light`) and hands every finished row to `finish`, while it
/// is still in the cache. Rows are finished in any order, by several threads.
[[nodiscard]] GrayImage spread_rows(const GrayImage& image, const PrinterProfile& profile,
                                    const ProcessOptions& options, const std::function<void(std::span<float>)>& finish);

}  // namespace mezzotint
