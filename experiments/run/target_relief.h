#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "forward/surface/height_field.h"

namespace mezzotint {

/// A scan made ready to be traced: levelled, outliers taken out, holes filled, and what was done to it.
struct TargetRelief {
  HeightField field;
  std::map<std::string, std::string> provenance;
};

/// @param outliers  samples further than that many standard deviations from the plane are taken out; 0: none.
[[nodiscard]] TargetRelief read_target_relief(const std::filesystem::path& scan, double outliers);

}  // namespace mezzotint
