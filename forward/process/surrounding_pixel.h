#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include "forward/process/printed_relief.h"

/// Inside of forward/process.

namespace mezzotint {

/// Which pixel stands at `index`, that may lie outside of 0…count−1 (count ≥ 1); none where it is dark.
[[nodiscard]] inline std::optional<std::size_t> pixel_at(std::int64_t index, std::size_t count, Surround surround) {
  const auto n = static_cast<std::int64_t>(count);
  if (index >= 0 && index < n) return static_cast<std::size_t>(index);
  if (surround == Surround::Dark) return std::nullopt;
  const std::int64_t period = surround == Surround::Repeat ? n : 2 * n;
  const std::int64_t wrapped = ((index % period) + period) % period;
  return static_cast<std::size_t>(wrapped < n ? wrapped : period - 1 - wrapped);
}

}  // namespace mezzotint
