#pragma once

#include <optional>
#include <vector>

#include "experiments/configuration/experiment_file.h"
#include "experiments/run/design_file.h"
#include "experiments/run/run_files.h"
#include "experiments/run/run_folder.h"
#include "forward/optics/bsdf.h"

namespace mezzotint {

/// The BSDFs of one direction of the light, and how far they are from one another.
struct IncidenceResult {
  DirectionAngles incidence;
  Bsdf predicted, printed, measured;
  std::optional<Bsdf> traced_target;  ///< of a scan
  DirectionMap target_lobe;           ///< Beckmann lobe of the target's slopes (closed form)
  DirectionMap own_lobe;              ///< Beckmann lobe of the print's own slopes
  MapDifference printed_to_target;    ///< the traced target where there is one, else its lobe
  MapDifference printed_to_own_lobe;  ///< what the pattern's shape and multiple scattering add: it is no Beckmann lobe
  std::optional<MapDifference> target_to_its_lobe;  ///< the same of a scan
  double own_lobe_to_target_lobe = 0.0;             ///< what the slopes' errors alone would make of a Beckmann lobe
  MapDifference measured_to_predicted;
};

/// Everything that a run's page shows, from the files of its stages.
struct RunResults {
  Target target;
  Design design;
  nlohmann::ordered_json comparison;
  HeightField design_relief, printed_relief, measured_relief, residual_relief;
  std::optional<HeightField> target_relief;
  SlopeAxes printed_slopes;  ///< of this one print
  TargetError printed_error;
  double coherent_share = 1.0;  ///< light that the ground's left-out octaves leave unscattered
  std::vector<IncidenceResult> incidences;
  /// Maps that stayed above `[simulation] tolerance` at the largest number of samples, in words.
  std::vector<std::string> noisy_maps;
  std::vector<std::string> map_warnings;  ///< what the BSDFs themselves warn of, but for their noise
};

/// Whether another placement of the measurement fits nearly as well, as on a periodic pattern.
[[nodiscard]] bool is_ambiguous(const RunResults& results);
inline constexpr double ambiguity_margin = 0.02;
inline constexpr const char* ambiguity_in_words =
    "the measurement fits the design nearly as well at another place (runner_up): a periodic pattern repeats, and "
    "shift_x and shift_y may be off by whole periods";

[[nodiscard]] RunResults load_results(const Experiment& experiment, const RunFolder& folder);

/// summary.json: every figure under its standard name, with its uncertainty.
[[nodiscard]] nlohmann::ordered_json summarize(const Experiment& experiment, const RunResults& results);

/// relative_l2 as a quantity: noise-corrected, with its standard error.
[[nodiscard]] Quantity quantity_of(const Estimate& estimate);

}  // namespace mezzotint
