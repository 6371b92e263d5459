#include <filesystem>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "experiments/command_line/command.h"
#include "experiments/command_line/option_checks.h"
#include "experiments/study/scene.h"
#include "experiments/study/study.h"
#include "experiments/study/study_page.h"
#include "experiments/study/study_svg.h"
#include "forward/base/file_output.h"

namespace mezzotint {

namespace {

struct ChartArguments {
  std::string output = "chart";
  std::string material = "dielectric:1.5";
  std::vector<double> gradients;
  std::vector<double> thetas_deg;
  std::size_t cells = 512;
  std::size_t resolution = 64;
  double auto_tolerance = 0.05;
};

StudyOptions options_of(const ChartArguments& arguments, std::int64_t seed) {
  StudyOptions options;
  if (!arguments.gradients.empty()) options.gradients = arguments.gradients;
  if (!arguments.thetas_deg.empty()) options.thetas_deg = arguments.thetas_deg;
  options.cells = arguments.cells;
  options.resolution = arguments.resolution;
  options.material = parse_material(arguments.material);
  options.auto_tolerance = arguments.auto_tolerance;
  if (seed >= 0) options.seed = static_cast<std::uint64_t>(seed);
  return options;
}

void add_arguments(CLI::App& app, ChartArguments& arguments) {
  app.add_option("--output,-o", arguments.output, "Folder for chart.html, chart.json and the figures (default chart)");
  app.add_option("--material", arguments.material, "As for bsdf (default dielectric:1.5)");
  app.add_option("--gradients", arguments.gradients, "RMS gradients, comma separated (default 0.05,0.3,0.8)")
      ->delimiter(',')
      ->check(in_range(0.001, 4.0));
  app.add_option("--incidences", arguments.thetas_deg, "Angles from the normal in degrees (default 0,30,60,80)")
      ->delimiter(',')
      ->check(in_range(0.0, 89.0));
  app.add_option("--cells", arguments.cells, "Cells a side of the reliefs (default 512)")->check(CLI::Range(64, 8192));
  app.add_option("--resolution", arguments.resolution, "Bins a side of the maps (default 64)")
      ->check(CLI::Range(8, 1024));
  app.add_option("--tolerance", arguments.auto_tolerance, "For the point that auto chooses (default 0.05)")
      ->check(in_range(1e-4, 1.0));
}

}  // namespace

Command add_chart(CLI::App& program) {
  auto* app =
      program.add_subcommand("chart", "Error against time for every method, on a set of reliefs; takes minutes");
  auto arguments = std::make_shared<ChartArguments>();
  add_arguments(*app, *arguments);
  return {app, [arguments](const CommandContext& context) {
            const StudyOptions options = options_of(*arguments, context.common.seed);
            const std::filesystem::path folder = arguments->output;
            std::filesystem::create_directories(folder);
            const auto points = run_study(options, context.progress);
            write_file(folder / "chart.json", to_json(options, points).dump(1) + "\n");
            write_report(study_page(options, points), folder / "chart.html");
            for (const std::string& relief : study_families())
              write_file(folder / ("chart_" + relief + ".svg"), study_svg(options, points, relief));
            context.print({{"written", (folder / "chart.html").string()}, {"points", points.size()}},
                          fmt::format("wrote {} with {} points, chart.json and one SVG a relief",
                                      (folder / "chart.html").string(), points.size()));
            return ExitStatus::Done;
          }};
}

}  // namespace mezzotint
