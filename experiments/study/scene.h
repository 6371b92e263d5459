#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "forward/surface/height_field.h"

namespace mezzotint {

/// A periodic relief of a study, scaled to an RMS gradient.
struct StudyRelief {
  std::string family;  ///< "gaussian", "sinusoid", "ridges"
  double gradient = 0.0;
  HeightField field;
};

/// "gaussian" (random waves of 16 to 64 a side), "sinusoid" (sin·sin, 16 periods), "ridges" (triangular, 16 periods).
/// @param cells  a side; 1 µm each
[[nodiscard]] StudyRelief make_study_relief(const std::string& family, double gradient, std::size_t cells);

/// The names that make_study_relief understands.
[[nodiscard]] const std::vector<std::string>& study_families();

/// Every second sample: the same relief on a coarser mesh.
[[nodiscard]] HeightField coarser(const HeightField& field);

}  // namespace mezzotint
