#pragma once

#include <functional>
#include <string>
#include <vector>

#include "experiments/configuration/experiment_file.h"
#include "experiments/run/run_folder.h"
#include "forward/base/progress.h"

namespace mezzotint {

/// Tells the user something at once, a line or two.
using Say = std::function<void(const std::string&)>;

/// What a stage may use: the experiment, the folder with what earlier stages left, and the door for progress.
struct StageContext {
  const Experiment& experiment;
  const RunFolder& folder;
  const Progress& progress;
  const Say& say;
};

/// One stage of the loop. It reads the files of earlier stages and returns the names of those that it wrote.
struct Stage {
  std::string name;
  std::vector<std::string> (*run)(const StageContext&);
};

/// target → gamut → search → print → measure → compare → scatter → report
[[nodiscard]] const std::vector<Stage>& all_stages();
/// target → gamut → search → page
[[nodiscard]] const std::vector<Stage>& design_stages();

std::vector<std::string> run_target(const StageContext& context);  ///< target.json (and target.gwy of a scan)
std::vector<std::string> run_gamut(const StageContext& context);   ///< gamut.json
/// design.json, pattern.toml, gray.png, relief.gwy, predicted_*.exr, target_*.exr; evaluations.jsonl or free_form.state
/// on the way
std::vector<std::string> run_search(const StageContext& context);
std::vector<std::string> run_page(const StageContext& context);     ///< report.html of a design
std::vector<std::string> run_print(const StageContext& context);    ///< design.gwy, predicted.gwy, job.uvj, printed.gwy
std::vector<std::string> run_measure(const StageContext& context);  ///< measured.gwy
std::vector<std::string> run_compare(const StageContext& context);  ///< registered.gwy, residual.gwy, comparison.json
std::vector<std::string> run_scatter(const StageContext& context);  ///< bsdf_*.exr
std::vector<std::string> run_report(const StageContext& context);   ///< report.html, summary.json

}  // namespace mezzotint
