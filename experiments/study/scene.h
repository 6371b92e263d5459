#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "experiments/study/relief_families.h"
#include "forward/surface/height_field.h"

namespace mezzotint {

/// A relief of a study, scaled to an RMS gradient.
struct StudyRelief {
  std::string family;  ///< see draw_relief; "scan"
  double gradient = 0.0;
  HeightField field;
};

/// A relief of a family with this RMS gradient.
/// @throws InvalidInput for what draw_relief refuses, or a gradient outside of (0, 4].
[[nodiscard]] StudyRelief make_study_relief(const std::string& family, double gradient, const ReliefDraw& draw);

/// A measurement as a relief of a study: levelled and filled, with its own gradient, and the mirrored patch that it is.
[[nodiscard]] StudyRelief scan_relief(const HeightField& measured);

/// What stands for a scan where none is given: random waves, seen by the virtual profilometer at 1 µm with 10 nm of
/// noise, askew, and with 1 % of the samples missing.
[[nodiscard]] HeightField virtual_scan(std::size_t cells);

/// The families of the committed chart, in its order. A scan is added to them.
[[nodiscard]] const std::vector<std::string>& study_families();

/// Every `step`-th sample: the same relief on a coarser mesh.
[[nodiscard]] HeightField coarser(const HeightField& field, std::size_t step);

}  // namespace mezzotint
