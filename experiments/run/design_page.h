#pragma once

#include <optional>
#include <string>
#include <vector>

#include "experiments/report/report.h"
#include "experiments/run/run_results.h"
#include "inverse/gamut/gamut.h"

namespace mezzotint {

/// What the page of a design shows, from the files of its folder.
struct DesignResults {
  Target target;
  nlohmann::ordered_json json;   ///< design.json
  std::optional<Design> design;  ///< none for a free form
  std::optional<Verification> traced;
  std::vector<Bsdf> predicted, wanted;  ///< one a direction of the light
  HeightField relief;
  std::string verdict;
};
[[nodiscard]] DesignResults load_design(const Experiment& experiment, const RunFolder& folder);

/// The page of a design: within reach or not, residuals, lobes, what is determined, the search, the blur.
[[nodiscard]] Report design_page(const Experiment& experiment, const DesignResults& results);

/// Its sections.
[[nodiscard]] Section reach_section(const DesignResults& results);
[[nodiscard]] Section residual_section(const DesignResults& results);
[[nodiscard]] Section certainty_section(const DesignResults& results);
[[nodiscard]] Section course_section(const DesignResults& results);
[[nodiscard]] Section layer_section(const DesignResults& results);
[[nodiscard]] Section blur_section(const DesignResults& results);

/// A combination of parameters as a sentence: "height_um and wavelength_um grow together".
[[nodiscard]] std::string together_in_words(const ParameterCombination& combination,
                                            const std::vector<Variable>& variables);

}  // namespace mezzotint
