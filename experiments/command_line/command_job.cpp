#include <string>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "experiments/command_line/command.h"
#include "experiments/command_line/job_description.h"
#include "experiments/command_line/json_words.h"
#include "fabrication/job/job_file.h"
#include "forward/base/quantity.h"

namespace mezzotint {

nlohmann::ordered_json describe_job(const std::filesystem::path& path, const Progress& progress) {
  const JobReader reader(path);
  const JobFigures figures = check_job(reader, progress);
  const Job& job = reader.frame();
  const double pixel_mm2 = job.pixel_pitch.mm() * job.pixel_pitch.mm();
  const double gray_mm3 = static_cast<double>(figures.gray_sum) / 255.0 * pixel_mm2 * job.layer.mm();
  return {{"format", format_name(reader.format())},
          {"name", job.name},
          {"printer", job.printer},
          {"columns", job.columns},
          {"rows", job.rows},
          {"gray_bits", 8},
          {"pixel_pitch", Quantity{job.pixel_pitch.um(), "µm", {}}},
          {"layer", Quantity{job.layer.um(), "µm", {}}},
          {"layers", job.layers.size()},
          {"empty_layers", figures.empty_layers},
          {"height", Quantity{job.layers.back().top.mm(), "mm", {}}},
          {"led_amplitude", job.led_amplitude},
          {"shortest_exposure", Quantity{figures.shortest_exposure_s, "s", {}}},
          {"longest_exposure", Quantity{figures.longest_exposure_s, "s", {}}},
          {"light", Quantity{figures.light_s, "s", {}}},
          {"lit_pixels", figures.lit_pixels},
          {"full_pixels", figures.full_pixels},
          {"gray_volume", Quantity{gray_mm3, "mm³", {}}},
          {"hashes", reader.has_hashes() ? "SHA-256 of every member verified" : "none in the file"}};
}

Command add_job(CLI::App& program) {
  auto* app = program.add_subcommand(
      "job", "Check a job (.uvj, .sl1, folder) whole (layers, sizes, bit depth, exposures, hashes) and sum it up");
  auto file = std::make_shared<std::string>();
  app->add_option("JOB", *file, "Layer archive or folder")->required();
  return {app, [file](const CommandContext& context) {
            const nlohmann::ordered_json json = describe_job(*file, context.progress);
            context.print(json, in_words(json));
            return ExitStatus::Done;
          }};
}

}  // namespace mezzotint
