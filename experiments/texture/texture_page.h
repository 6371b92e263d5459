#pragma once

#include <map>
#include <string>

#include "experiments/report/report.h"
#include "experiments/texture/texture_findings.h"

namespace mezzotint {

/// Where a surface came from.
struct TextureSource {
  std::string name, format, title, assumption;
  std::map<std::string, std::string> provenance;
};

/// The page of a surface's texture: relief, heights, wavelengths, slopes, profile, all parameters with standard errors,
/// and how they were evaluated. Missing samples are filled for the spectrum alone, and that is said.
[[nodiscard]] Report texture_page(const TextureFindings& findings, const TextureRequest& request,
                                  const TextureSource& source);

}  // namespace mezzotint
