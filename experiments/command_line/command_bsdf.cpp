#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "experiments/command_line/command.h"
#include "experiments/command_line/option_checks.h"
#include "experiments/report/bsdf_page.h"
#include "experiments/version.h"
#include "forward/base/quantity.h"
#include "forward/ladder/ladder.h"
#include "forward/optics/bsdf_warnings.h"
#include "forward/scattering/path_tracing.h"
#include "measurement/formats/surface_file.h"

namespace mezzotint {

namespace {

struct BsdfArguments {
  std::string input;
  std::string output;
  std::string report;
  std::vector<double> incidence;
  std::string material = "dielectric:1.5";
  std::string model = "paths";
  std::string normals = "geometric";
  std::string estimator = "flux";
  std::string tracer = "height-field";
  std::size_t resolution = 64;
  double samples = 0.0;
  double tolerance = 0.0;
  double seconds = 0.0;
  double wavelength_nm = 550.0;
  std::uint32_t max_bounces = 64;
  std::uint32_t bounce_orders = 0;
  bool resume = false;
};

constexpr double default_tolerance = 0.02;
// Enough for 0.2 % of nearly any map; a run that wants more says so by --samples.
constexpr double most_samples = 0x1p30;

bool has_tolerance(const BsdfArguments& arguments) {
  return arguments.tolerance > 0.0 || (arguments.samples <= 0.0 && arguments.seconds <= 0.0);
}

double tolerance_of(const BsdfArguments& arguments) {
  if (arguments.tolerance > 0.0) return arguments.tolerance;
  return has_tolerance(arguments) ? default_tolerance : 0.0;
}

std::filesystem::path state_file(const BsdfArguments& arguments) { return arguments.output + ".state"; }

PathTracingOptions tracing_options(const BsdfArguments& arguments, std::uint64_t seed) {
  PathTracingOptions options;
  options.incidence = {Angle::from_degrees(arguments.incidence[0]), Angle::from_degrees(arguments.incidence[1])};
  options.grid = {arguments.resolution, arguments.resolution};
  options.material = parse_material(arguments.material);
  options.samples = static_cast<std::uint64_t>(arguments.samples > 0.0 ? arguments.samples : most_samples);
  options.tolerance = tolerance_of(arguments);
  options.seconds = arguments.seconds;
  options.max_bounces = arguments.model == "single" ? 1 : arguments.max_bounces;
  options.bounce_orders = arguments.bounce_orders;
  options.estimator = arguments.estimator == "slides" ? Estimator::Slides : Estimator::Flux;
  options.normals = arguments.normals == "interpolated" ? NormalKind::Interpolated : NormalKind::Geometric;
  options.tracer = arguments.tracer == "embree" ? TracerKind::Embree : TracerKind::HeightField;
  if (arguments.resume) options.state = state_file(arguments);
  options.seed = seed;
  return options;
}

LadderOptions ladder_options(const BsdfArguments& arguments, const PathTracingOptions& tracing) {
  return {.incidence = tracing.incidence,
          .grid = tracing.grid,
          .material = tracing.material,
          .tolerance = tolerance_of(arguments),
          .wavelength = Length::from_nm(arguments.wavelength_nm),
          .seed = tracing.seed};
}

Bsdf by_rays(const BsdfArguments& arguments, const HeightField& relief, PathTracer& tracer,
             const PathTracingOptions& tracing, const Progress& progress) {
  if (arguments.model == "slopes") return tracer.splat(tracing);
  if (arguments.model == "auto") return simulate_auto(relief, tracer, ladder_options(arguments, tracing), progress);
  return tracer.trace(tracing, progress);
}

Bsdf by_model(const BsdfArguments& arguments, const HeightField& relief, const PathTracingOptions& tracing,
              const Progress& progress) {
  const LadderOptions ladder = ladder_options(arguments, tracing);
  if (arguments.model == "moments" && relief.missing_count() > 0) return bsdf_from_moments(relief, ladder);
  PathTracer tracer(relief);
  Bsdf bsdf = arguments.model == "moments" ? bsdf_from_moments(relief, ladder)
                                           : by_rays(arguments, relief, tracer, tracing, progress);
  add_warnings(bsdf, geometric_optics_warnings(tracer.facts(), ladder));
  return bsdf;
}

Bsdf compute(const BsdfArguments& arguments, const CommandContext& context) {
  const bool budget = arguments.samples > 0.0 || arguments.seconds > 0.0 || arguments.resume;
  require(!budget || arguments.model == "paths" || arguments.model == "single",
          "--samples, --time and --resume are for the models paths and single; " + arguments.model +
              " knows by itself how much work it needs");
  require(std::filesystem::path(arguments.output).extension() == ".exr",
          arguments.output + ": a BSDF is written as .exr");
  require(arguments.incidence[0] >= 0.0 && arguments.incidence[0] <= 89.0,
          "--incidence: the light comes from above, THETA from 0 to 89; a lower ray would cross the relief for ever");
  require_folder_of(arguments.output);
  if (!arguments.report.empty()) require_folder_of(arguments.report);
  const SurfaceFile surface = read_surface(arguments.input);
  const std::uint64_t seed = context.common.seed >= 0 ? static_cast<std::uint64_t>(context.common.seed) : 1;
  Bsdf bsdf = by_model(arguments, surface.field, tracing_options(arguments, seed), context.progress);
  bsdf.provenance["program"] = std::string("mezzotint ") + program_version;
  bsdf.provenance["source"] = std::filesystem::path(arguments.input).filename().string();
  return bsdf;
}

std::string entry_of(const Bsdf& bsdf, const std::string& key) {
  const auto found = bsdf.provenance.find(key);
  return found == bsdf.provenance.end() ? "" : found->second;
}

// Why `auto` chose what it chose.
std::string words_of(const Bsdf& bsdf) {
  const std::string choice = entry_of(bsdf, "choice");
  return choice.empty() ? "" : "\n" + choice;
}

void write_page(const BsdfArguments& arguments, const Bsdf& bsdf, double error) {
  if (arguments.report.empty()) return;
  const BsdfPageOptions options{std::filesystem::path(arguments.input).filename().string(), tolerance_of(arguments),
                                error};
  write_report(bsdf_page(bsdf, options), arguments.report);
}

void add_arguments(CLI::App& app, BsdfArguments& arguments) {
  app.add_option("HEIGHT", arguments.input, "Surface file without missing samples; levelled")->required();
  app.add_option("--output,-o", arguments.output, "EXR to write")->required();
  app.add_option("--report", arguments.report, "HTML page to write too: maps, energy, error while tracing, choice");
  app.add_option("--incidence", arguments.incidence, "THETA,PHI of the light in degrees")
      ->delimiter(',')
      ->expected(2)
      ->required();
  app.add_option("--material", arguments.material,
                 "mirror, dielectric:ETA[,ABSORPTION per um] or conductor:ETA,KAPPA (default dielectric:1.5)");
  app.add_option(
         "--model", arguments.model,
         "paths (default), single (no second interaction), slopes (all facets, no rays), moments (a Gaussian lobe), "
         "or auto: the cheapest that meets the tolerance")
      ->check(CLI::IsMember({"auto", "paths", "single", "slopes", "moments"}));
  app.add_option("--wavelength", arguments.wavelength_nm,
                 "Of the light in nm, for the verdict on geometric optics (default 550)")
      ->check(in_range(200.0, 20000.0));
  app.add_option("--resolution", arguments.resolution, "Bins a side of the direction map (default 64)")
      ->check(CLI::Range(8, 1024));
  app.add_option("--samples", arguments.samples,
                 "At most so many paths, for example 1e6 (rounded up to at most twice that)")
      ->check(in_range(1.0, 6.8e10));
  app.add_option("--tolerance", arguments.tolerance,
                 "Stop at this relative standard error (default 0.02, where neither --samples nor --time is given)")
      ->check(in_range(1e-5, 1.0));
  app.add_option("--time", arguments.seconds, "Stop after so many seconds")->check(in_range(0.01, 1e6));
  app.add_flag("--resume", arguments.resume,
               "Keep what was traced in OUT.exr.state, and go on from there: after Ctrl-C, or to refine");
  app.add_option("--max-bounces", arguments.max_bounces, "Interactions a path may have (default 64)")
      ->check(CLI::Range(1, 65536));
  app.add_option("--bounce-orders", arguments.bounce_orders,
                 "Keep the reflection apart by order of interaction: so many maps, the last for all higher orders")
      ->check(CLI::Range(1, 64));
  app.add_option("--normals", arguments.normals, "geometric (default) or interpolated")
      ->check(CLI::IsMember({"geometric", "interpolated"}));
  app.add_option("--tracer", arguments.tracer, "height-field (default) or embree, the independent reference")
      ->check(CLI::IsMember({"height-field", "embree"}));
  app.add_option("--estimator", arguments.estimator, "flux (default) or slides, for comparison only")
      ->check(CLI::IsMember({"flux", "slides"}));
}

}  // namespace

Command add_bsdf(CLI::App& program) {
  auto* app = program.add_subcommand(
      "bsdf", "The BSDF of a relief by path tracing (with a standard error for every bin), or from its slope moments");
  auto arguments = std::make_shared<BsdfArguments>();
  add_arguments(*app, *arguments);
  return {app, [arguments](const CommandContext& context) {
            const Bsdf bsdf = compute(*arguments, context);
            write_exr(bsdf, arguments->output);
            const double error = relative_error(bsdf.grid, bsdf.reflection);
            write_page(*arguments, bsdf, error);
            const Estimate& albedo = bsdf.energy.reflected;
            context.print(
                {{"written", arguments->output},
                 {"albedo", Quantity{albedo.value, "1", albedo.standard_error}},
                 {"transmitted", Quantity{bsdf.energy.transmitted.value, "1", bsdf.energy.transmitted.standard_error}},
                 {"absorbed", Quantity{bsdf.energy.absorbed.value, "1", bsdf.energy.absorbed.standard_error}},
                 {"left_sideways",
                  Quantity{bsdf.energy.left_sideways.value, "1", bsdf.energy.left_sideways.standard_error}},
                 {"cut_off", Quantity{bsdf.energy.cut_off.value, "1", bsdf.energy.cut_off.standard_error}},
                 {"model", bsdf.provenance.at("model")},
                 {"choice", entry_of(bsdf, "choice")},
                 {"warnings", warnings_of(bsdf.provenance)},
                 {"relative_standard_error", error}},
                fmt::format("wrote {}: albedo {:.5f} ± {:.2g}, relative standard error of the map {:.2g}{}",
                            arguments->output, albedo.value, albedo.standard_error, error, words_of(bsdf)));
            context.warn(warnings_of(bsdf.provenance));
            const bool fell_short = has_tolerance(*arguments) && error > tolerance_of(*arguments);
            return fell_short ? ExitStatus::ToleranceMissed : ExitStatus::Done;
          }};
}

}  // namespace mezzotint
