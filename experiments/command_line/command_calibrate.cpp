#include <cmath>
#include <filesystem>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "experiments/calibration/calibration_findings.h"
#include "experiments/calibration/calibration_page.h"
#include "experiments/command_line/command.h"
#include "experiments/command_line/option_checks.h"
#include "fabrication/calibration/cure_table.h"
#include "fabrication/calibration/wedge_layout.h"
#include "fabrication/job/job.h"
#include "forward/base/digest.h"
#include "forward/base/file_input.h"
#include "forward/base/file_output.h"
#include "measurement/formats/surface_file.h"

namespace mezzotint {

namespace {

struct Arguments {
  std::string input, output, base, levels, along = "longer", name, wedge;
  double layer_um = 0.0, border_um = 25.0;
  std::size_t step_pixels = 40, rows = 60, frame = 30;
};

PrinterProfile base_of(const Arguments& arguments) {
  PrinterProfile base = arguments.base.empty() ? PrinterProfile{} : read_printer(arguments.base);
  if (arguments.layer_um > 0.0) base.layer = Length::from_um(arguments.layer_um);
  return base;
}

// A text table of steps, or else a surface with a wedge.
bool is_table(const std::filesystem::path& path) {
  const std::string ending = path.extension().string();
  if (ending != ".csv" && ending != ".txt" && ending != ".tsv") return false;
  std::filesystem::path sidecar = path;
  sidecar += ".toml";  // a grid of heights in text has its sizes there
  return !std::filesystem::exists(sidecar);
}

WedgeScan wedge_of(const Arguments& arguments, Length layer) {
  WedgeScanOptions options;
  options.layer = layer;
  const std::string levels = arguments.levels.empty() ? std::string(default_wedge_levels) : arguments.levels;
  for (const int level : parse_levels(levels)) options.grays.push_back(level / 255.0);
  if (arguments.along != "longer") options.along = arguments.along == "x" ? WedgeAxis::X : WedgeAxis::Y;
  options.least_border = Length::from_um(arguments.border_um);
  return measure_wedge(read_surface(arguments.input).field, options);
}

// A folder of an instrument is what its height file holds.
std::string hash_of(const std::filesystem::path& path) {
  const auto files = is_table(path) ? std::vector{path} : files_of_surface(path);
  return sha256_hex(read_file(files.front()));
}

CalibrationFindings calibrate(const Arguments& arguments) {
  const std::filesystem::path path = arguments.input;
  CalibrationFindings findings{.source = path.filename().string(), .base = base_of(arguments)};
  CureFitOptions options{.base = findings.base.cure, .layer = findings.base.layer};
  std::vector<CurePoint> points;
  if (is_table(path)) {
    require(arguments.levels.empty(), "--levels are those of a scan; a table has them in its rows");
    points = read_cure_table(path, {findings.base.exposure_s});
  } else {
    findings.wedge = wedge_of(arguments, findings.base.layer);
    points = cure_points(*findings.wedge);
    options.common_error_um = findings.wedge->base_error_um;
  }
  findings.source_sha256 = hash_of(path);
  findings.fit = fit_cure(points, options);
  findings.printer = findings.base;
  findings.printer.cure = findings.fit.curve;
  findings.printer.name =
      arguments.name.empty() ? std::filesystem::path(arguments.output).stem().string() : arguments.name;
  require_valid(findings.printer);
  findings.range = reachable_range(findings.fit, findings.printer);
  return findings;
}

std::string comment_of(const CalibrationFindings& findings) {
  std::string comment = "Printer profile by mezzotint calibrate from " + findings.source + ".\n" + in_words(findings);
  for (const std::string& warning : warnings_of(findings)) comment += "note: " + warning + "\n";
  return comment;
}

std::filesystem::path page_path(const std::string& profile) {
  return std::filesystem::path(profile).parent_path() / "calibration.html";
}

ExitStatus run_calibrate(const Arguments& arguments, const CommandContext& context) {
  require(!arguments.input.empty(), "what was measured is missing: a table of steps (.csv) or a scan of the wedge");
  require(std::filesystem::path(arguments.output).extension() == ".toml",
          arguments.output + ": a printer profile is written as .toml");
  require_folder_of(arguments.output);
  const CalibrationFindings findings = calibrate(arguments);
  write_file(arguments.output, printer_file_text(findings.printer, record_of(findings), comment_of(findings)));
  const std::filesystem::path page = page_path(arguments.output);
  write_report(calibration_page(findings), page);
  nlohmann::ordered_json json = to_json(findings);
  json["written"] = {arguments.output, page.string()};
  context.warn(warnings_of(findings));
  context.print(json, in_words(findings) + "wrote " + arguments.output + " and " + page.string());
  return ExitStatus::Done;
}

// The wedge that `calibrate` reads, as a job to print.
ExitStatus write_wedge(const Arguments& arguments, const CommandContext& context) {
  require(arguments.input.empty(), "--wedge makes a job to print; what is measured comes afterwards");
  require_folder_of(arguments.wedge);
  const std::string levels = arguments.levels.empty() ? std::string(default_wedge_levels) : arguments.levels;
  const WedgeLayout layout{parse_levels(levels), arguments.step_pixels, arguments.rows, arguments.frame};
  const PrinterProfile base = base_of(arguments);
  const Job job = make_patch_job("wedge", wedge_image(layout), base);
  write_uvj(job, arguments.wedge);
  context.print({{"written", arguments.wedge},
                 {"levels", layout.levels},
                 {"step_width", Quantity{base.pixel_pitch.um() * static_cast<double>(layout.step_pixels), "µm", {}}}},
                fmt::format("wrote {}: {} steps of {:.1f} um; scan it with its frame and calibrate with --levels {}",
                            arguments.wedge, layout.levels.size(),
                            base.pixel_pitch.um() * static_cast<double>(layout.step_pixels), levels));
  return ExitStatus::Done;
}

void add_arguments(CLI::App& app, Arguments& a) {
  app.add_option(
      "MEASURED", a.input,
      fmt::format("Table of steps (.csv: gray, height_um, optional standard_error_um, repeats, exposure_s), or a "
                  "scan of the wedge ({})",
                  read_surface_formats));
  auto* output =
      app.add_option("--output,-o", a.output, "Printer profile to write (.toml); calibration.html beside it");
  auto* wedge = app.add_option("--wedge", a.wedge, "Write the job (.uvj) of a wedge to print instead");
  output->excludes(wedge);
  app.add_option("--base", a.base, "Printer profile for all but the cure curve (default: the slides' printer)");
  app.add_option("--layer-um", a.layer_um, "Thickness that no step exceeds (default: the base profile's layer)")
      ->check(in_range(0.1, 1000.0));
  app.add_option("--name", a.name, "Name of the new profile (default: the file's)");
  app.add_option(
      "--levels", a.levels,
      fmt::format("Gray levels of a scan's steps side by side, of 8 bits: numbers and FROM:TO:STEP (default {})",
                  default_wedge_levels));
  app.add_option("--along", a.along, "Axis of the scan from step to step: x, y or longer (default longer)")
      ->check(CLI::IsMember({"x", "y", "longer"}));
  app.add_option("--border-um", a.border_um,
                 "Left out on every side of a step, at least; 15 % of its width where that is more (default 25)")
      ->check(in_range(0.0, 1000.0));
  app.add_option("--step-pixels", a.step_pixels, "Width of a step of --wedge (default 40)")->check(CLI::Range(4, 4000));
  app.add_option("--rows", a.rows, "Pixels of a step of --wedge across it (default 60)")->check(CLI::Range(4, 4000));
  app.add_option("--frame", a.frame, "Pixels of base around the steps of --wedge (default 30)")
      ->check(CLI::Range(4, 4000));
}

}  // namespace

Command add_calibrate(CLI::App& program) {
  auto* app = program.add_subcommand(
      "calibrate", "From measured steps of a printed wedge to a printer profile: the cure curve with 95 % intervals");
  auto arguments = std::make_shared<Arguments>();
  add_arguments(*app, *arguments);
  return {app, [arguments](const CommandContext& context) {
            if (!arguments->wedge.empty()) return write_wedge(*arguments, context);
            require(!arguments->output.empty(), "say with -o which printer profile (.toml) to write");
            return run_calibrate(*arguments, context);
          }};
}

}  // namespace mezzotint
