#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>

namespace mezzotint {

/// What share of a pixel counts as covered by the part.
///
/// Volume    the share of the pixel's box, pixel × layer, that the part fills: a surface that crosses a layer becomes
///           gray along z as well. The default: it is what gray is for, and its sum is the part's volume.
/// Midplane  the share of the pixel's square that the part covers half-way up the layer. What other slicers do; a face
///           that lies flat is there or not, and its height is rounded to whole layers.
enum class CoverageMode { Volume, Midplane };

/// How a layer is covered: exactly, by closed forms, or by samples.
struct CoverageOptions {
  CoverageMode mode = CoverageMode::Volume;
  /// 0: exact. N: N × N samples of a pixel, in the plane half-way up the layer; for comparison.
  int supersample = 0;
};

inline constexpr int most_supersamples = 64;

/// Columns [begin, end) of a row that are covered alike; 0 < coverage ≤ 1.
struct CoverageRun {
  std::uint32_t begin = 0, end = 0;
  float coverage = 0.0F;
};

/// One row of a layer: runs from left to right, nothing between them.
using TakeCoverageRow = std::function<void(std::size_t row, std::span<const CoverageRun> runs)>;

}  // namespace mezzotint
