#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "experiments/command_line/command.h"
#include "experiments/command_line/option_checks.h"
#include "experiments/run/simulate.h"
#include "experiments/version.h"
#include "forward/base/quantity.h"
#include "forward/optics/microfacet.h"
#include "forward/scattering/path_tracing.h"
#include "forward/surface/slope_covariance.h"
#include "measurement/formats/surface_file.h"

namespace mezzotint {

namespace {

struct BsdfArguments {
  std::string input;
  std::string output;
  std::vector<double> incidence;
  std::string material = "dielectric:1.5";
  std::string model = "paths";
  std::string normals = "geometric";
  std::string estimator = "flux";
  std::size_t resolution = 64;
  double samples = 0.0;
  double tolerance = 0.02;
};

Bsdf trace_samples(const HeightField& relief, const BsdfArguments& arguments, const SimulationSpecification& simulation,
                   const DirectionAngles& incidence, std::uint64_t seed, const Progress& progress) {
  return trace_bsdf(relief,
                    {.incidence = incidence,
                     .grid = {simulation.resolution, simulation.resolution},
                     .material = simulation.material,
                     .samples = static_cast<std::uint64_t>(arguments.samples),
                     .estimator = arguments.estimator == "slides" ? Estimator::Slides : Estimator::Flux,
                     .normals = arguments.normals == "interpolated" ? NormalKind::Interpolated : NormalKind::Geometric,
                     .seed = seed},
                    progress);
}

// The lowest rung: Gaussian slopes of the relief's own covariance. Exact maps, so no standard error.
Bsdf from_moments(const HeightField& relief, const SimulationSpecification& simulation,
                  const DirectionAngles& incidence) {
  Bsdf bsdf{.incidence = incidence, .grid = {simulation.resolution, simulation.resolution}};
  const BeckmannLobe lobe = lobe_of(principal_axes(slope_covariance(relief)));
  DirectionMap map = reflection_map(lobe, simulation.material, incidence, bsdf.grid);
  const DirectionMap none(bsdf.grid.size(), 0.0);
  bsdf.reflection = {map, none, map, map};
  bsdf.transmission = {none, none, none, none};
  const auto areas = projected_solid_angles(bsdf.grid);
  for (std::size_t bin = 0; bin < map.size(); ++bin) bsdf.energy.reflected.value += areas[bin] * map[bin];
  bsdf.energy.cut_off.value = 1.0 - bsdf.energy.reflected.value;
  bsdf.provenance["model"] =
      "moments: anisotropic Beckmann, height-correlated Smith, single reflection; the rest is cut off";
  return bsdf;
}

Bsdf simulate_once(const HeightField& relief, const SimulationSpecification& simulation,
                   const DirectionAngles& incidence, std::uint64_t seed, const Progress& progress) {
  PathTracer tracer(relief);
  return simulate(tracer, simulation, incidence, seed, progress);
}

Bsdf compute(const BsdfArguments& arguments, const CommandContext& context) {
  require(arguments.model != "moments" || arguments.samples <= 0.0,
          "the moments are a closed form: --samples and what goes with it mean nothing there");
  require(std::filesystem::path(arguments.output).extension() == ".exr",
          arguments.output + ": a BSDF is written as .exr");
  require(arguments.incidence[0] >= 0.0 && arguments.incidence[0] <= 89.0,
          "--incidence: the light comes from above, THETA from 0 to 89; a lower ray would cross the relief for ever");
  require_folder_of(arguments.output);
  const SurfaceFile surface = read_surface(arguments.input);
  SimulationSpecification simulation;
  simulation.material = parse_material(arguments.material);
  simulation.resolution = arguments.resolution;
  simulation.tolerance = arguments.tolerance;
  const DirectionAngles incidence{Angle::from_degrees(arguments.incidence[0]),
                                  Angle::from_degrees(arguments.incidence[1])};
  const std::uint64_t seed = context.common.seed >= 0 ? static_cast<std::uint64_t>(context.common.seed) : 1;
  Bsdf bsdf = arguments.model == "moments" ? from_moments(surface.field, simulation, incidence)
              : arguments.samples > 0.0
                  ? trace_samples(surface.field, arguments, simulation, incidence, seed, context.progress)
                  : simulate_once(surface.field, simulation, incidence, seed, context.progress);
  bsdf.provenance["program"] = std::string("mezzotint ") + program_version;
  bsdf.provenance["source"] = std::filesystem::path(arguments.input).filename().string();
  return bsdf;
}

void add_arguments(CLI::App& app, BsdfArguments& arguments) {
  app.add_option("HEIGHT", arguments.input, "Surface file (.al3d, .x3p, .gwy) without missing samples; levelled")
      ->required();
  app.add_option("--output,-o", arguments.output, "EXR to write")->required();
  app.add_option("--incidence", arguments.incidence, "THETA,PHI of the light in degrees")
      ->delimiter(',')
      ->expected(2)
      ->required();
  app.add_option("--material", arguments.material,
                 "mirror, dielectric:ETA or conductor:ETA,KAPPA (default dielectric:1.5)");
  app.add_option("--model", arguments.model, "paths (default; auto means it too so far) or moments")
      ->check(CLI::IsMember({"auto", "paths", "moments"}));
  app.add_option("--resolution", arguments.resolution, "Bins a side of the direction map (default 64)")
      ->check(CLI::Range(8, 1024));
  auto* samples = app.add_option("--samples", arguments.samples,
                                 "Number of paths, for example 1e6 (rounded up to at most twice that)")
                      ->check(in_range(1.0, 6.8e10));
  app.add_option("--tolerance", arguments.tolerance, "Relative standard error to reach (default 0.02)")
      ->check(in_range(1e-4, 1.0))
      ->excludes(samples);
  app.add_option("--normals", arguments.normals, "geometric (default) or interpolated; with --samples")
      ->check(CLI::IsMember({"geometric", "interpolated"}))
      ->needs(samples);
  app.add_option("--estimator", arguments.estimator, "flux (default) or slides, for comparison only; with --samples")
      ->check(CLI::IsMember({"flux", "slides"}))
      ->needs(samples);
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
            const Estimate& albedo = bsdf.energy.reflected;
            context.print(
                {{"written", arguments->output},
                 {"albedo", Quantity{albedo.value, "1", albedo.standard_error}},
                 {"transmitted", Quantity{bsdf.energy.transmitted.value, "1", bsdf.energy.transmitted.standard_error}},
                 {"left_sideways",
                  Quantity{bsdf.energy.left_sideways.value, "1", bsdf.energy.left_sideways.standard_error}},
                 {"cut_off", Quantity{bsdf.energy.cut_off.value, "1", bsdf.energy.cut_off.standard_error}},
                 {"relative_standard_error", error}},
                fmt::format("wrote {}: albedo {:.5f} ± {:.2g}, relative standard error of the map {:.2g}",
                            arguments->output, albedo.value, albedo.standard_error, error));
            const bool fell_short = arguments->samples <= 0.0 && error > arguments->tolerance;
            return fell_short ? ExitStatus::ToleranceMissed : ExitStatus::Done;
          }};
}

}  // namespace mezzotint
