#include <algorithm>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "experiments/command_line/command.h"
#include "experiments/command_line/mesh_simulation.h"
#include "experiments/command_line/option_checks.h"
#include "experiments/report/bsdf_page.h"
#include "experiments/version.h"
#include "forward/base/quantity.h"
#include "forward/ladder/ladder.h"
#include "forward/optics/bsdf_warnings.h"
#include "forward/scattering/path_tracing.h"
#include "forward/surface/mesh_file.h"
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
  MeshArguments mesh;
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

// The channel is "R", "G", "B", or empty where there is one.
std::filesystem::path state_file(const BsdfArguments& arguments, const std::string& channel) {
  return arguments.output + (channel.empty() ? "" : "." + channel) + ".state";
}

PathTracingOptions tracing_options(const BsdfArguments& arguments, const Material& material, const std::string& channel,
                                   std::uint64_t seed) {
  PathTracingOptions options;
  options.incidence = {Angle::from_degrees(arguments.incidence[0]), Angle::from_degrees(arguments.incidence[1])};
  options.grid = {arguments.resolution, arguments.resolution};
  options.material = material;
  options.samples = static_cast<std::uint64_t>(arguments.samples > 0.0 ? arguments.samples : most_samples);
  options.tolerance = tolerance_of(arguments);
  options.seconds = arguments.seconds;
  options.max_bounces = arguments.model == "single" ? 1 : arguments.max_bounces;
  options.bounce_orders = arguments.bounce_orders;
  options.estimator = arguments.estimator == "slides" ? Estimator::Slides : Estimator::Flux;
  options.normals = arguments.normals == "interpolated" ? NormalKind::Interpolated : NormalKind::Geometric;
  options.tracer = arguments.tracer == "embree" ? TracerKind::Embree : TracerKind::HeightField;
  if (arguments.resume) options.state = state_file(arguments, channel);
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

void require_usable(const BsdfArguments& arguments) {
  const bool traces = arguments.model == "paths" || arguments.model == "single";
  const bool budget = arguments.samples > 0.0 || arguments.seconds > 0.0 || arguments.resume;
  require(!budget || traces, "--samples, --time and --resume are for the models paths and single; " + arguments.model +
                                 " knows by itself how much work it needs");
  require(std::filesystem::path(arguments.output).extension() == ".exr",
          arguments.output + ": a BSDF is written as .exr");
  require(arguments.incidence[0] >= 0.0 && arguments.incidence[0] <= 89.0,
          "--incidence: the light comes from above, THETA from 0 to 89; a lower ray would cross the relief for ever");
  const bool is_mesh = is_mesh_path(arguments.input);
  require(!is_mesh || traces,
          "a mesh is traced: --model paths or single; " + arguments.model + " is for height fields");
  require(is_mesh || (arguments.mesh.period_um.empty() && arguments.mesh.unit.empty()),
          "--periodic and --mesh-unit are for meshes (.obj, .ply, .stl); a height field knows both by itself");
  require_folder_of(arguments.output);
  if (arguments.report.empty()) return;
  require_folder_of(arguments.report);
  require(parse_materials(arguments.material).size() == 1, "--report shows one channel: give one index of refraction");
}

Simulation simulation_of(const BsdfArguments& arguments) {
  if (is_mesh_path(arguments.input)) return simulation_of_mesh(arguments.input, arguments.mesh);
  const auto relief = std::make_shared<const HeightField>(read_surface(arguments.input).field);
  return [relief, &arguments](const PathTracingOptions& tracing, const Progress& progress) {
    return by_model(arguments, *relief, tracing, progress);
  };
}

// One BSDF for each channel, by the same random numbers; one after the other, since each index refracts its own way.
std::vector<Bsdf> compute(const BsdfArguments& arguments, const CommandContext& context) {
  require_usable(arguments);
  const std::vector<Material> materials = parse_materials(arguments.material);
  const Simulation simulate = simulation_of(arguments);
  const std::uint64_t seed = context.common.seed >= 0 ? static_cast<std::uint64_t>(context.common.seed) : 1;
  std::vector<Bsdf> channels;
  for (const Material& material : materials) {
    const std::string channel = channel_name(channels.size(), materials.size());
    const auto done = static_cast<double>(channels.size()), all = static_cast<double>(materials.size());
    const Progress progress = [&](const ProgressEvent& event) {
      report(context.progress, event.stage, (done + event.fraction) / all,
             channel.empty() ? event.note : channel + ": " + event.note);
    };
    channels.push_back(simulate(tracing_options(arguments, material, channel, seed), progress));
    channels.back().provenance["program"] = std::string("mezzotint ") + program_version;
    channels.back().provenance["source"] = std::filesystem::path(arguments.input).filename().string();
  }
  return channels;
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
  app.add_option("HEIGHT", arguments.input,
                 "Surface file without missing samples, levelled; or a mesh (.obj, .ply, .stl)")
      ->required();
  app.add_option("--output,-o", arguments.output, "EXR to write")->required();
  app.add_option("--report", arguments.report, "HTML page to write too: maps, energy, error while tracing, choice");
  app.add_option("--incidence", arguments.incidence, "THETA,PHI of the light in degrees")
      ->delimiter(',')
      ->expected(2)
      ->required();
  app.add_option(
      "--material", arguments.material,
      "mirror, dielectric:ETA[,ABSORPTION per um] or conductor:ETA,KAPPA (default dielectric:1.5); three for R, "
      "G and B: dielectric:1.51/1.52/1.53");
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
  add_mesh_arguments(app, arguments.mesh);
}

using Json = nlohmann::ordered_json;

Json figures_of(const Bsdf& bsdf) {
  const auto share = [](const Estimate& e) { return Quantity{e.value, "1", e.standard_error}; };
  return {{"albedo", share(bsdf.energy.reflected)},
          {"transmitted", share(bsdf.energy.transmitted)},
          {"absorbed", share(bsdf.energy.absorbed)},
          {"left_sideways", share(bsdf.energy.left_sideways)},
          {"cut_off", share(bsdf.energy.cut_off)},
          {"model", bsdf.provenance.at("model")},
          {"choice", entry_of(bsdf, "choice")},
          {"assumption", entry_of(bsdf, "assumption")},
          {"warnings", warnings_of(bsdf.provenance)},
          {"relative_standard_error", relative_error(bsdf.grid, bsdf.reflection)}};
}

Json json_of(const std::vector<Bsdf>& channels, const std::string& output) {
  Json json = {{"written", output}};
  if (channels.size() == 1) {
    json.update(figures_of(channels[0]));
    return json;
  }
  for (std::size_t c = 0; c < channels.size(); ++c)
    json["channels"][channel_name(c, channels.size())] = figures_of(channels[c]);
  return json;
}

std::string text_of(const std::vector<Bsdf>& channels, const std::string& output) {
  std::string text = fmt::format("wrote {}:", output);
  for (std::size_t c = 0; c < channels.size(); ++c) {
    const Bsdf& bsdf = channels[c];
    text +=
        fmt::format("{}{} albedo {:.5f} ± {:.2g}, relative standard error of the map {:.2g}{}",
                    channels.size() == 1 ? "" : "\n", channel_name(c, channels.size()), bsdf.energy.reflected.value,
                    bsdf.energy.reflected.standard_error, relative_error(bsdf.grid, bsdf.reflection), words_of(bsdf));
  }
  const std::string assumption = entry_of(channels[0], "assumption");
  return assumption.empty() ? text : text + "\nassumed: " + assumption;
}

// What is wrong with which channel.
std::vector<std::string> warnings_by_channel(const std::vector<Bsdf>& channels) {
  std::vector<std::string> sentences;
  for (std::size_t c = 0; c < channels.size(); ++c) {
    const std::string name = channel_name(c, channels.size());
    for (const std::string& sentence : warnings_of(channels[c].provenance))
      sentences.push_back(name.empty() ? sentence : name + ": " + sentence);
  }
  return sentences;
}

ExitStatus write_and_tell(const BsdfArguments& arguments, const CommandContext& context) {
  const std::vector<Bsdf> channels = compute(arguments, context);
  channels.size() == 1 ? write_exr(channels[0], arguments.output) : write_channels_exr(channels, arguments.output);
  write_page(arguments, channels[0], relative_error(channels[0].grid, channels[0].reflection));
  context.print(json_of(channels, arguments.output), text_of(channels, arguments.output));
  context.warn(warnings_by_channel(channels));
  const bool fell_short =
      has_tolerance(arguments) && std::any_of(channels.begin(), channels.end(), [&](const Bsdf& bsdf) {
        return relative_error(bsdf.grid, bsdf.reflection) > tolerance_of(arguments);
      });
  return fell_short ? ExitStatus::ToleranceMissed : ExitStatus::Done;
}

}  // namespace

Command add_bsdf(CLI::App& program) {
  auto* app = program.add_subcommand(
      "bsdf",
      "The BSDF of a relief or a mesh by path tracing (with a standard error for every bin), or from slope moments");
  auto arguments = std::make_shared<BsdfArguments>();
  add_arguments(*app, *arguments);
  return {app, [arguments](const CommandContext& context) { return write_and_tell(*arguments, context); }};
}

}  // namespace mezzotint
