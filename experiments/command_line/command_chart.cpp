#include <sys/resource.h>
#include <algorithm>
#include <filesystem>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "experiments/command_line/command.h"
#include "experiments/command_line/option_checks.h"
#include "experiments/study/measurement_study.h"
#include "experiments/study/scene.h"
#include "experiments/study/study.h"
#include "experiments/study/study_page.h"
#include "experiments/study/study_svg.h"
#include "forward/base/file_output.h"
#include "forward/base/quantity.h"
#include "measurement/formats/surface_file.h"

namespace mezzotint {

namespace {

struct ChartArguments {
  std::string subject = "all";
  std::string output = "chart";
  std::string material = "dielectric:1.5";
  std::string scan;
  std::vector<std::string> families;
  std::vector<double> gradients;
  std::vector<double> thetas_deg;
  std::vector<double> auto_tolerances;
  std::size_t cells = 512;
  std::size_t resolution = 64;
};

// The scan that is asked for by file or by name; where nothing is asked for, all is charted.
std::optional<StudyRelief> scan_of(const ChartArguments& arguments) {
  if (!arguments.scan.empty()) return scan_relief(read_surface(arguments.scan).field);
  const auto& families = arguments.families;
  const bool wanted = families.empty() || std::find(families.begin(), families.end(), "scan") != families.end();
  if (!wanted) return std::nullopt;
  return scan_relief(virtual_scan(arguments.cells));
}

StudyOptions options_of(const ChartArguments& arguments, std::int64_t seed) {
  StudyOptions options;
  if (!arguments.families.empty()) {
    options.families = arguments.families;
    options.families.erase(std::remove(options.families.begin(), options.families.end(), "scan"),
                           options.families.end());
  }
  if (!arguments.gradients.empty()) options.gradients = arguments.gradients;
  if (!arguments.thetas_deg.empty()) options.thetas_deg = arguments.thetas_deg;
  if (!arguments.auto_tolerances.empty()) options.auto_tolerances = arguments.auto_tolerances;
  options.scan = scan_of(arguments);
  options.cells = arguments.cells;
  options.resolution = arguments.resolution;
  options.material = parse_material(arguments.material);
  if (seed >= 0) options.seed = static_cast<std::uint64_t>(seed);
  return options;
}

// The most that the process has held.
double peak_memory_mib() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024.0;
}

std::string file_name_of(const std::string& relief) {
  std::string name = "chart_" + relief + ".svg";
  std::replace(name.begin(), name.end(), ' ', '_');
  return name;
}

void write_figures(const StudyOptions& options, const std::vector<StudyPoint>& points,
                   const std::filesystem::path& folder) {
  std::vector<std::string> reliefs = options.families;
  if (options.scan) reliefs.push_back(options.scan->family);
  for (const std::string& relief : reliefs)
    write_file(folder / file_name_of(relief), study_svg(options, points, relief));
  write_file(folder / "chart_choices.svg", study_choices_svg(options, points));
}

/// What a part of the chart left.
struct ChartPart {
  std::size_t points = 0;
  nlohmann::json numbers;
};

ChartPart chart_scattering(const ChartArguments& arguments, const CommandContext& context) {
  const std::filesystem::path folder = arguments.output;
  const StudyOptions options = options_of(arguments, context.common.seed);
  const auto points = run_study(options, context.progress);
  write_report(study_page(options, points), folder / "chart.html");
  write_figures(options, points, folder);
  return {points.size(), to_json(options, points)};
}

ChartPart chart_measurement(const ChartArguments& arguments, const CommandContext& context) {
  // Relaxation of wide holes takes the fourth power of the side.
  constexpr std::size_t most_cells = 512;
  MeasurementStudyOptions options{.cells = std::min(arguments.cells, most_cells)};
  if (context.common.seed >= 0) options.seed = static_cast<std::uint64_t>(context.common.seed);
  const auto panels = run_measurement_study(options, context.progress);
  for (const MeasurementQuestion question : measurement_questions())
    write_file(std::filesystem::path(arguments.output) / fmt::format("chart_{}.svg", in_words(question)),
               measurement_svg(options, panels, question));
  std::size_t points = 0;
  for (const MeasurementPanel& panel : panels) points += panel.points.size();
  return {points, to_json(panels)};
}

CLI::Validator known_relief() {
  std::vector<std::string> names = relief_families();
  names.emplace_back("scan");
  return CLI::IsMember(names);
}

void add_arguments(CLI::App& app, ChartArguments& arguments) {
  app.add_option("--output,-o", arguments.output, "Folder for chart.html, chart.json and the figures (default chart)");
  app.add_option("--subject", arguments.subject,
                 "scattering, measurement (filling, filtering, roughness of a part of the samples), or all (default)")
      ->check(CLI::IsMember({"all", "scattering", "measurement"}));
  app.add_option("--material", arguments.material, "As for bsdf (default dielectric:1.5)");
  app.add_option("--families", arguments.families,
                 "Reliefs, comma separated: gaussian, noise, sinusoid, ridges, scan (these by default), bumps, "
                 "skewed ridges, folds, plateaus, patch")
      ->delimiter(',')
      ->check(known_relief());
  app.add_option("--scan", arguments.scan,
                 "Surface file for the scan: levelled, filled, at its own gradient (default: a relief measured by the "
                 "virtual profilometer)");
  app.add_option("--gradients", arguments.gradients, "RMS gradients, comma separated (default 0.05,0.3,1)")
      ->delimiter(',')
      ->check(in_range(0.001, 4.0));
  app.add_option("--incidences", arguments.thetas_deg, "Angles from the normal in degrees (default 0,30,60,85)")
      ->delimiter(',')
      ->check(in_range(0.0, 89.0));
  app.add_option("--cells", arguments.cells, "Cells a side of the reliefs (default 512; measurement takes 512 at most)")
      ->check(CLI::Range(64, 8192));
  app.add_option("--resolution", arguments.resolution, "Bins a side of the maps (default 64)")
      ->check(CLI::Range(8, 1024));
  app.add_option("--tolerance", arguments.auto_tolerances,
                 "For the points that auto chooses, comma separated (default 0.05,0.01)")
      ->delimiter(',')
      ->check(in_range(1e-4, 1.0));
}

}  // namespace

Command add_chart(CLI::App& program) {
  auto* app = program.add_subcommand(
      "chart",
      "Error against time for every method, of scattering on a set of reliefs and of measurement; takes minutes");
  auto arguments = std::make_shared<ChartArguments>();
  add_arguments(*app, *arguments);
  return {
      app, [arguments](const CommandContext& context) {
        const std::filesystem::path folder = arguments->output;
        std::filesystem::create_directories(folder);
        nlohmann::json numbers = nlohmann::json::object();
        std::size_t points = 0;
        if (arguments->subject != "measurement") {
          const ChartPart part = chart_scattering(*arguments, context);
          numbers = part.numbers;
          points += part.points;
        }
        if (arguments->subject != "scattering") {
          const ChartPart part = chart_measurement(*arguments, context);
          numbers["measurement"] = part.numbers;
          points += part.points;
        }
        numbers["peak_memory_mib"] = peak_memory_mib();
        write_file(folder / "chart.json", numbers.dump(1) + "\n");
        context.print(
            {{"written", folder.string()}, {"points", points}, {"peak_memory", Quantity{peak_memory_mib(), "MiB", {}}}},
            fmt::format("wrote {} points as figures and chart.json into {}; at most {:.0f} MiB held", points,
                        folder.string(), peak_memory_mib()));
        return ExitStatus::Done;
      }};
}

}  // namespace mezzotint
