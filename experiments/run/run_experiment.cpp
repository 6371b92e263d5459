#include "experiments/run/run_experiment.h"

#include <algorithm>
#include <chrono>
#include <span>

#include <fmt/format.h>

#include "experiments/run/design_file.h"
#include "experiments/run/region_designs.h"
#include "experiments/run/run_files.h"
#include "experiments/run/search_free_form.h"
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

// Of the last run in the folder: its summary where it went on beyond the design.
RunOutcome outcome_of(const RunFolder& folder) {
  const auto json = read_json(folder / "design.json");
  const auto summary_file = folder / "summary.json";
  auto summary = std::filesystem::exists(summary_file) ? read_json(summary_file) : json;
  const bool met = json.at("met").get<bool>() && summary.value("simulation_tolerance_met", true);
  const std::string verdict =
      json.contains("free_form")
          ? free_form_verdict(json)
          : verdict_sentence(target_from_json(read_json(folder / "target.json")), design_from_json(json));
  return {folder.path(), met, verdict, std::move(summary)};
}

}  // namespace

const std::vector<Stage>& all_stages() {
  static const std::vector<Stage> stages = {
      {"target", run_target},   {"gamut", run_gamut},     {"search", run_search},   {"print", run_print},
      {"measure", run_measure}, {"compare", run_compare}, {"scatter", run_scatter}, {"report", run_report}};
  return stages;
}

const std::vector<Stage>& design_stages() {
  static const std::vector<Stage> stages = {
      {"target", run_target}, {"gamut", run_gamut}, {"search", run_search}, {"page", run_page}};
  return stages;
}

bool is_by_light(const Experiment& experiment) {
  if (is_lobe_alone(experiment.target) || experiment.pattern.free_form) return true;
  return experiment.search.by_light() || (experiment.search.objective.empty() && experiment.target.kind == "scan");
}

std::string experiment_digest(const Experiment& experiment) {
  std::string text =
      std::string(program_version) + "\n" + experiment.canonical_text + "\n" + printer_text(experiment.printer);
  for (const auto& named : files_of(experiment.target)) {
    // A measured surface may lie in several files.
    const auto files = experiment.target.kind == "scan" ? files_of_surface(named) : std::vector{named};
    for (const auto& file : files) text += "\n" + file_digest(file);
  }
  return sha256_hex(std::as_bytes(std::span(text)));
}

RunOutcome run_experiment(const Experiment& experiment, const RunOptions& options, const Progress& progress) {
  if (std::holds_alternative<WantedRegions>(experiment.target.wanted))
    return design_regions(experiment, options, progress);
  require(options.design_only || !experiment.pattern.free_form,
          "a run draws, prints and measures a pattern, and a free form is none: use mezzotint design");
  RunFolder folder(options.folder, experiment_digest(experiment), options.resume);
  Timing timing(folder);
  bool earlier_stage_ran = false;
  for (const auto& stage : options.design_only ? design_stages() : all_stages()) {
    if (!earlier_stage_ran && folder.is_finished(stage.name)) {
      report(progress, stage.name, 1.0, "finished before");
      continue;
    }
    earlier_stage_ran = true;
    report(progress, stage.name, 0.0);
    const auto begin = std::chrono::steady_clock::now();
    folder.finish(stage.name, stage.run({experiment, folder, progress, options.say}));
    timing.add(stage.name, std::chrono::steady_clock::now() - begin);
    timing.save(folder);
    report(progress, stage.name, 1.0);
  }
  return outcome_of(folder);
}

}  // namespace mezzotint
