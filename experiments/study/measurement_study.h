#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

#include "experiments/study/chart_point.h"
#include "forward/base/progress.h"

namespace mezzotint {

/// What one may choose between a scan and its figures.
enum class MeasurementQuestion {
  Filling,    ///< holes of a growing size; error: RMS of what was filled against what was there ÷ Sq
  Filtering,  ///< growing cut-offs; error: RMS against the filter of a field that goes on beyond its ends ÷ its own RMS
  Sampling    ///< Sq of a part of the samples, of textures of growing length; error: against all of them ÷ Sq
};
[[nodiscard]] const std::vector<MeasurementQuestion>& measurement_questions();
/// "filling", "filtering", "sampling"
[[nodiscard]] std::string_view in_words(MeasurementQuestion question);
/// The methods that answer a question, in the order of the legend.
[[nodiscard]] const std::vector<std::string>& methods_for(MeasurementQuestion question);

/// Surfaces are Gaussian textures, samples 1 µm apart, `cells` a side, under a cut-off of an eighth of that (but where
/// sampling varies it). Holes cover a fifth of the area. Filters work on the texture, and on it with a tilt that is ten
/// times as high across the field.
struct MeasurementStudyOptions {
  std::size_t cells = 512;
  int fields = 8;  ///< of each kind, with a seed each: errors and times over them
  std::uint64_t seed = 1;
};

/// One question on one surface at one length.
struct MeasurementPanel {
  MeasurementQuestion question;
  std::string surface;     ///< "texture", "tilted texture": a row of the figure each
  double length_um = 0.0;  ///< of holes, cut-off or texture: 1/64, 1/16 or 1/4 of the side
  std::vector<ChartPoint> points;
};

/// Measures all methods on one thread. A minute.
/// @throws InvalidInput for fewer than 64 cells, or no field.
[[nodiscard]] std::vector<MeasurementPanel> run_measurement_study(const MeasurementStudyOptions& options,
                                                                  const Progress& progress);

[[nodiscard]] nlohmann::json to_json(const std::vector<MeasurementPanel>& panels);

/// Error against time of one question, a panel for each length (across) and surface (down).
[[nodiscard]] std::string measurement_svg(const MeasurementStudyOptions& options,
                                          const std::vector<MeasurementPanel>& panels, MeasurementQuestion question);

}  // namespace mezzotint
