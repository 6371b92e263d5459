#pragma once

#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "experiments/report/charts.h"
#include "experiments/report/components.h"
#include "forward/optics/bsdf.h"

namespace mezzotint {

/// How the standard error of a traced map fell while it was traced: x in paths, y relative. From the provenance
/// "convergence"; empty for a map that took no paths.
[[nodiscard]] Series convergence_of(const std::string& name, const Bsdf& bsdf);

/// Such curves, both axes logarithmic, with the tolerance as a line. Maps without paths are left out.
/// @param tolerance  relative; 0: none was asked for
[[nodiscard]] std::optional<nlohmann::json> convergence_chart(const Panel& panel, const std::vector<Series>& curves,
                                                              double tolerance);

/// Where the light went, as shares of what came in, with their sum.
[[nodiscard]] nlohmann::json energy_table(const Panel& panel, const Bsdf& bsdf);

}  // namespace mezzotint
