#include "experiments/run/run_experiment.h"

#include <algorithm>
#include <chrono>
#include <span>

#include <fmt/format.h>

#include "experiments/run/design_file.h"
#include "experiments/run/run_files.h"
#include "experiments/run/stages.h"
#include "experiments/version.h"
#include "forward/base/digest.h"
#include "forward/base/error.h"
#include "measurement/formats/surface_file.h"

namespace mezzotint {

namespace {

std::string printer_text(const PrinterProfile& p) {
  std::string text =
      fmt::format("{} {} {} {} {} {} {} {} {} {} {} {} {} {} {} {}", p.name, p.pixels_x, p.pixels_y, p.pixel_pitch.um(),
                  p.layer.um(), p.exposure_s, p.led_amplitude, p.gray_levels, p.cure.alpha.um(), p.cure.beta.um(),
                  p.cure.gamma, kernel_name(p.spread.kernel), p.spread.width.um(), p.spread.calibrated,
                  p.ground_amplitude.um(), p.ground_is_calibrated);
  for (const auto& octave : p.ground) text += fmt::format(" {} {}", octave.weight, octave.scale.um());
  return text;
}

std::vector<Stage> wanted_stages(const std::string& last) {
  std::vector<Stage> stages;
  for (const auto& stage : all_stages()) {
    stages.push_back(stage);
    if (stage.name == last) break;
  }
  return stages;
}

// Seconds are the one thing that differs from run to run, so they have a file of their own.
class Timing {
public:
  /// Goes on from the seconds of the stages that an earlier, interrupted run finished.
  explicit Timing(const RunFolder& folder) {
    if (std::filesystem::exists(folder / "timing.json")) seconds_ = read_json(folder / "timing.json");
    if (!seconds_.is_object()) seconds_ = nlohmann::ordered_json::object();
  }
  void add(const std::string& stage, std::chrono::steady_clock::duration duration) {
    seconds_[stage] = std::chrono::duration<double>(duration).count();
  }
  void save(const RunFolder& folder) const { write_json(seconds_, folder / "timing.json"); }

private:
  nlohmann::ordered_json seconds_;
};

}  // namespace

const std::vector<Stage>& all_stages() {
  static const std::vector<Stage> stages = {
      {"target", run_target},   {"search", run_search},   {"print", run_print},  {"measure", run_measure},
      {"compare", run_compare}, {"scatter", run_scatter}, {"report", run_report}};
  return stages;
}

bool is_by_light(const Experiment& experiment) {
  return experiment.search.by_light() || (experiment.search.objective.empty() && experiment.target.kind == "scan");
}

std::string experiment_digest(const Experiment& experiment) {
  std::string text =
      std::string(program_version) + "\n" + experiment.canonical_text + "\n" + printer_text(experiment.printer);
  if (experiment.target.kind == "scan") {
    for (const auto& file : files_of_surface(experiment.target.scan)) text += "\n" + file_digest(file);
  }
  return sha256_hex(std::as_bytes(std::span(text)));
}

RunOutcome run_experiment(const Experiment& experiment, const RunOptions& options, const Progress& progress) {
  RunFolder folder(options.folder, experiment_digest(experiment), options.resume);
  Timing timing(folder);
  bool earlier_stage_ran = false;
  for (const auto& stage : wanted_stages(options.last_stage)) {
    if (!earlier_stage_ran && folder.is_finished(stage.name)) {
      report(progress, stage.name, 1.0, "finished before");
      continue;
    }
    earlier_stage_ran = true;
    report(progress, stage.name, 0.0);
    const auto begin = std::chrono::steady_clock::now();
    folder.finish(stage.name, stage.run({experiment, folder, progress}));
    timing.add(stage.name, std::chrono::steady_clock::now() - begin);
    timing.save(folder);
    report(progress, stage.name, 1.0);
  }
  const auto design = design_from_json(read_json(folder / "design.json"));
  const auto summary_file = folder / "summary.json";
  const bool has_summary = std::filesystem::exists(summary_file);
  const auto target = target_from_json(read_json(folder / "target.json"));
  auto summary = has_summary ? read_json(summary_file) : to_json(design);
  const bool met = design.met && summary.value("simulation_tolerance_met", true);
  return {folder.path(), met, verdict_sentence(target, design), std::move(summary)};
}

}  // namespace mezzotint
