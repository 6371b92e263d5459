#include <algorithm>
#include <cmath>
#include <filesystem>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "experiments/command_line/command.h"
#include "experiments/command_line/machine_print.h"
#include "experiments/command_line/option_checks.h"
#include "experiments/configuration/printer_file.h"
#include "experiments/run/run_files.h"
#include "fabrication/device/virtual_printer.h"
#include "fabrication/job/job_file.h"
#include "measurement/comparison/registration.h"
#include "measurement/correction/plane.h"
#include "measurement/formats/surface_file.h"
#include "measurement/texture/roughness.h"

namespace mezzotint {

namespace {

struct PrintArguments {
  std::string job;
  std::string output;
  std::string device = "virtual";
  std::string machine;
  std::string journal;
  std::string uncertain = "stop";
  bool resume = false;
  bool dry_run = false;
  bool force_upload = false;
  double pace = 0.0;
  std::string printer;
  std::size_t subsamples = 4;
  double wavelength_nm = 550.0;
};

struct ValidateArguments {
  std::string design;
  std::string measured;
  std::string output;
};

HeightField only_where_measured(const HeightField& field, const HeightField& mask) {
  HeightField result = field;
  for (std::size_t i = 0; i < result.heights_um().size(); ++i) {
    if (std::isnan(mask.heights_um()[i])) result.heights_um()[i] = mask.heights_um()[i];
  }
  return result;
}

void add_machine_options(CLI::App& app, PrintArguments& arguments) {
  app.add_option("--device", arguments.device, "virtual (default), dlpc900")
      ->check(CLI::IsMember({"virtual", "dlpc900"}));
  app.add_option("--machine", arguments.machine, "Machine profile (TOML): print by it, layer by layer, with a journal");
  app.add_option("--journal", arguments.journal, "Journal of the print (default: JOB.journal)");
  app.add_flag("--resume", arguments.resume, "Go on with a print that was stopped, by its journal");
  app.add_option("--uncertain", arguments.uncertain,
                 "With --resume, a layer of which nobody knows how much light it got: stop (default), repeat, skip, "
                 "complete")
      ->check(CLI::IsMember({"stop", "repeat", "skip", "complete"}));
  app.add_flag("--dry-run", arguments.dry_run, "Say how long it takes; no light, no move");
  app.add_flag("--force-upload", arguments.force_upload, "dlpc900: load pictures however long it takes");
  app.add_option("--pace", arguments.pace, "virtual: so many times faster than the machine (default: takes no time)")
      ->check(in_range(0.01, 1e6));
}

void require_fitting(const PrintArguments& arguments) {
  const bool is_virtual = arguments.device == "virtual";
  require(is_virtual || !arguments.machine.empty(), "--device " + arguments.device + " needs --machine PROFILE");
  require(is_virtual || arguments.output.empty(), "--output is for the virtual printer: a real one prints the part");
  require(is_virtual || arguments.pace == 0.0, "--pace is for the virtual printer");
  require(!arguments.machine.empty() || (arguments.journal.empty() && !arguments.resume && !arguments.dry_run &&
                                         arguments.pace == 0.0 && arguments.uncertain == "stop"),
          "--journal, --resume, --uncertain, --dry-run and --pace need --machine PROFILE");
  require(!arguments.machine.empty() || !arguments.output.empty(),
          "--output OUT.gwy is missing: where the relief goes");
  require(arguments.resume || arguments.uncertain == "stop", "--uncertain belongs to --resume");
  if (arguments.output.empty()) return;
  require(std::filesystem::path(arguments.output).extension() == ".gwy",
          arguments.output + ": the printed relief is written as .gwy");
  require_folder_of(arguments.output);
}

// Every layer as the session lit it; one that was skipped without light has none to print.
Job job_as_lit(const PrintArguments& arguments, const std::vector<double>& lit_s) {
  Job job = read_job(arguments.job);
  for (std::size_t i = 0; i < lit_s.size(); ++i) {
    if (lit_s[i] > 0.0) {
      job.layers[i].exposure_s = lit_s[i];
    } else {
      std::fill(job.layers[i].gray.begin(), job.layers[i].gray.end(), std::uint8_t{0});
    }
  }
  return job;
}

ExitStatus print(const PrintArguments& arguments, const CommandContext& context) {
  require_fitting(arguments);
  nlohmann::ordered_json json;
  std::string text;
  std::vector<double> lit_s;
  if (!arguments.machine.empty()) {
    MachinePrintEnd end =
        print_on_machine({arguments.job, arguments.machine, arguments.journal, arguments.device, arguments.uncertain,
                          arguments.resume, arguments.dry_run, arguments.force_upload, arguments.pace},
                         context);
    json = std::move(end.json);
    text = std::move(end.text);
    lit_s = std::move(end.lit_s);
    if (arguments.output.empty() || arguments.dry_run || !end.finished) {
      context.print(json, text);
      return end.finished ? ExitStatus::Done : ExitStatus::Failed;
    }
    text += "\n";
  }
  const PrinterProfile printer = arguments.printer.empty() ? PrinterProfile{} : read_printer(arguments.printer);
  const std::uint64_t seed = context.common.seed >= 0 ? static_cast<std::uint64_t>(context.common.seed) : 1;
  const HeightField relief = print_virtually(
      job_as_lit(arguments, lit_s), printer,
      {.subsamples = arguments.subsamples, .wavelength = Length::from_nm(arguments.wavelength_nm), .seed = seed},
      context.progress);
  write_gwy(relief, "printed", {{"device", "virtual printer"}, {"printer", printer.name}}, arguments.output);
  json["written"] = arguments.output;
  json["columns"] = relief.columns();
  json["rows"] = relief.rows();
  context.print(json, text + "wrote " + arguments.output);
  return ExitStatus::Done;
}

}  // namespace

Command add_print(CLI::App& program) {
  auto* app = program.add_subcommand(
      "print",
      "Print a job (.uvj, .sl1, folder): on the virtual printer, whose relief becomes a .gwy, or on a machine. Ctrl-C "
      "stops after the layer, again it cuts the exposure; Ctrl-Z pauses; --resume goes on.");
  auto arguments = std::make_shared<PrintArguments>();
  app->add_option("JOB", arguments->job, "Layer archive (.uvj, .sl1) or folder")->required();
  app->add_option("--output,-o", arguments->output, "virtual: printed relief to write (.gwy)");
  add_machine_options(*app, *arguments);
  app->add_option("--printer", arguments->printer, "Printer profile (TOML; default: the slides' printer)");
  app->add_option("--wavelength-nm", arguments->wavelength_nm,
                  "Decides which octaves of the printer's ground are geometry (default 550)")
      ->check(in_range(200.0, 20000.0));
  app->add_option("--subsamples", arguments->subsamples, "Samples of the relief a pixel and axis (default 4)")
      ->check(CLI::Range(1, 16));
  return {app, [arguments](const CommandContext& context) { return print(*arguments, context); }};
}

Command add_validate(CLI::App& program) {
  auto* app = program.add_subcommand(
      "validate",
      "Register a measured surface to a design and compare them. The measurement is levelled; outliers are not "
      "taken out (see correct), and it may be turned by up to 5 degrees.");
  auto arguments = std::make_shared<ValidateArguments>();
  app->add_option("DESIGN", arguments->design, "Designed relief (.gwy)")->required();
  app->add_option("--measured", arguments->measured, "Measured surface file")->required();
  app->add_option("--output,-o", arguments->output, "Folder for registered.gwy, residual.gwy, comparison.json")
      ->required();
  return {app, [arguments](const CommandContext& context) {
            const HeightField design = read_surface(arguments->design).field;
            const HeightField measured = level(read_surface(arguments->measured).field);
            const Registration registration = register_surfaces(design, measured, {}, context.progress);
            const HeightField registered = resample_to_design(design, measured, registration);
            const HeightField difference = residual(design, registered);
            const nlohmann::ordered_json json = {
                {"registration", to_json(registration)},
                {"residual", to_json(area_roughness(difference))},
                {"roughness",
                 {{"design", to_json(area_roughness(level(only_where_measured(design, registered))))},
                  {"measured", to_json(area_roughness(level(registered)))}}}};
            const std::filesystem::path folder = arguments->output;
            std::error_code problem;
            std::filesystem::create_directories(folder, problem);
            if (problem) throw DeviceError("cannot make the folder " + folder.string() + ": " + problem.message());
            write_gwy(registered, "registered", {}, folder / "registered.gwy");
            write_gwy(difference, "residual", {}, folder / "residual.gwy");
            write_json(json, folder / "comparison.json");
            context.print(
                json, fmt::format(
                          "shift ({:.2f} ± {:.2g}, {:.2f} ± {:.2g}) µm, rotation {:.3f} ± {:.2g}°, correlation {:.4f}\n"
                          "residual {:.4f} µm RMS\nwrote {}",
                          registration.shift_x.value.um(), registration.shift_x.standard_error.um(),
                          registration.shift_y.value.um(), registration.shift_y.standard_error.um(),
                          registration.rotation.value.degrees(), registration.rotation.standard_error.degrees(),
                          registration.correlation, area_roughness(difference).Sq.value,
                          (folder / "comparison.json").string()));
            return ExitStatus::Done;
          }};
}

}  // namespace mezzotint
