#include <algorithm>
#include <map>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <CLI/CLI.hpp>

#include "experiments/command_line/command.h"
#include "experiments/command_line/direction_store.h"
#include "experiments/command_line/option_checks.h"
#include "experiments/version.h"
#include "forward/base/quantity.h"
#include "forward/bsdf_table/bsdf_table_file.h"
#include "forward/bsdf_table/build_bsdf_table.h"
#include "forward/bsdf_table/reciprocity.h"
#include "forward/bsdf_table/symmetry_check.h"
#include "forward/ladder/ladder.h"
#include "forward/surface/relief_warnings.h"
#include "measurement/formats/surface_file.h"

namespace mezzotint {

namespace {

struct BsdfTableArguments {
  std::string input;
  std::string output;
  std::string material = "dielectric:1.5";
  std::string model = "auto";
  std::string symmetry = "none";
  double axis_deg = 0.0;
  double largest_theta_deg = 85.0;
  double tolerance = 0.1;
  double noise = 0.0;  // 0: a fourth of the tolerance
  std::size_t most_incidences = 64;
  std::size_t resolution = 64;
  bool resume = false;
};

const std::map<std::string, SymmetryKind>& symmetry_kinds() {
  static const std::map<std::string, SymmetryKind> kinds = {{"none", SymmetryKind::None},
                                                            {"point", SymmetryKind::Point},
                                                            {"mirror", SymmetryKind::Mirror},
                                                            {"point_and_mirror", SymmetryKind::PointAndMirror},
                                                            {"isotropic", SymmetryKind::Isotropic}};
  return kinds;
}

struct Result {
  BuiltBsdfTable built;
  double asymmetry = 0.0;  ///< by one direction of the light that the asserted symmetry made unnecessary
  std::vector<std::string> warnings;
};

double noise_of(const BsdfTableArguments& arguments) {
  return arguments.noise > 0.0 ? arguments.noise : arguments.tolerance / 4.0;
}

BsdfTableOptions table_options(const BsdfTableArguments& arguments, const Material& material) {
  BsdfTableOptions options;
  options.symmetry = {symmetry_kinds().at(arguments.symmetry), Angle::from_degrees(arguments.axis_deg)};
  options.largest_theta = Angle::from_degrees(arguments.largest_theta_deg);
  options.tolerance = arguments.tolerance;
  options.most_incidences = arguments.most_incidences;
  if (const auto* dielectric = std::get_if<Dielectric>(&material)) options.relative_index = dielectric->eta;
  return options;
}

// One direction of the light: by the ladder, or by paths alone.
class DirectionByDirection {
public:
  DirectionByDirection(const BsdfTableArguments& arguments, const HeightField& relief, const Material& material,
                       std::uint64_t seed)
      : arguments_(arguments), relief_(relief), material_(material), tracer_(relief), seed_(seed) {}

  Bsdf compute(const DirectionAngles& to_light, const Progress& progress) {
    const DirectionGrid grid = {arguments_.resolution, arguments_.resolution};
    if (arguments_.model == "auto") {
      LadderOptions options;
      options.incidence = to_light;
      options.grid = grid;
      options.material = material_;
      options.tolerance = noise_of(arguments_);
      options.seed = seed_;
      return simulate_auto(relief_, tracer_, options, progress);
    }
    PathTracingOptions options;
    options.incidence = to_light;
    options.grid = grid;
    options.material = material_;
    options.tolerance = noise_of(arguments_);
    options.samples = std::uint64_t{1} << 30;
    options.seed = seed_;
    return tracer_.trace(options, progress);
  }

private:
  const BsdfTableArguments& arguments_;
  const HeightField& relief_;
  const Material& material_;
  PathTracer tracer_;
  std::uint64_t seed_;
};

void look_at_symmetry(const BsdfTableArguments& arguments, const ComputeBsdf& ask, Result& result) {
  const SymmetryCheck check = check_symmetry(result.built.table, ask);
  result.asymmetry = check.difference;
  if (!check.is_doubtful(arguments.tolerance)) return;
  result.warnings.push_back(fmt::format(
      "the sample does not have the symmetry \"{}\" that was asserted: light from beyond the computed azimuths gives a "
      "lobe that differs by {:.2g} (relative L2) from the table's; use another --symmetry or --axis",
      arguments.symmetry, check.difference));
}

Provenance provenance_of(const BsdfTableArguments& arguments, const Result& result, const std::string& material,
                         std::uint64_t seed) {
  const BsdfTableReport& report = result.built.report;
  Provenance entries = {{"program", std::string("mezzotint ") + program_version},
                        {"source", std::filesystem::path(arguments.input).filename().string()},
                        {"material", material},
                        {"model", arguments.model},
                        {"noise", fmt::format("{}", noise_of(arguments))},
                        {"tolerance", fmt::format("{}", arguments.tolerance)},
                        {"largest_difference", fmt::format("{:.4g}", report.largest_difference)},
                        {"tolerance_met", report.met ? "yes" : "no"},
                        {"seed", std::to_string(seed)}};
  if (!result.warnings.empty()) entries["warnings"] = fmt::format("{}", fmt::join(result.warnings, "\n"));
  return entries;
}

Result compute(const BsdfTableArguments& arguments, const CommandContext& context) {
  require(std::filesystem::path(arguments.output).extension() == ".exr",
          arguments.output + ": a BSDF table is written as .exr");
  require_folder_of(arguments.output);
  const HeightField relief = read_surface(arguments.input).field;
  const std::uint64_t seed = context.common.seed >= 0 ? static_cast<std::uint64_t>(context.common.seed) : 1;
  const Material material = parse_material(arguments.material);
  const BsdfTableOptions options = table_options(arguments, material);

  std::optional<DirectionStore> store;
  if (arguments.resume) {
    store.emplace(arguments.output + ".parts", relief,
                  fmt::format("{} {} {} {:a} {} {}", program_version, arguments.model, to_string(material),
                              noise_of(arguments), arguments.resolution, seed));
  }

  DirectionByDirection directions(arguments, relief, material, seed);
  // The bar counts directions; what a direction has to say goes into the note.
  ProgressEvent latest{"bsdf table", 0.0, ""};
  const Progress overall = [&](const ProgressEvent& event) {
    latest = event;
    latest.fraction = std::min(event.fraction, 0.99);  // the symmetry is still to be looked at
    report(context.progress, latest.stage, latest.fraction, latest.note);
  };
  const auto compute_one = [&](const DirectionAngles& to_light) {
    const std::string where = fmt::format("{:.1f}°, {:.1f}°", to_light.theta.degrees(), to_light.phi.degrees());
    Bsdf bsdf = rounded(directions.compute(to_light, [&](const ProgressEvent& event) {
      report(context.progress, latest.stage, latest.fraction, where + ": " + event.note);
    }));
    if (store) store->keep(bsdf);
    return bsdf;
  };
  const auto find_one = [&](const DirectionAngles& to_light) { return store ? store->find(to_light) : std::nullopt; };

  Result result;
  BuiltBsdfTable& built = result.built;
  built = build_bsdf_table(compute_one, options, overall, find_one);
  const auto ask = [&](const DirectionAngles& to_light) {
    const std::optional<Bsdf> known = find_one(to_light);
    return known ? *known : compute_one(to_light);
  };
  result.warnings = relief_warnings(relief);
  look_at_symmetry(arguments, ask, result);
  report(context.progress, latest.stage, 1.0);
  built.table.provenance = provenance_of(arguments, result, to_string(material), seed);
  return result;
}

void add_arguments(CLI::App& app, BsdfTableArguments& arguments) {
  std::vector<std::string> symmetries;
  for (const auto& [name, kind] : symmetry_kinds()) symmetries.push_back(name);
  app.add_option("HEIGHT", arguments.input, "Surface file without missing samples; levelled")->required();
  app.add_option("--output,-o", arguments.output, "EXR to write")->required();
  app.add_option("--material", arguments.material, "As for bsdf (default dielectric:1.5)");
  app.add_option("--model", arguments.model, "auto (default: the cheapest that meets --noise) or paths")
      ->check(CLI::IsMember({"auto", "paths"}));
  app.add_option("--symmetry", arguments.symmetry,
                 "What leaves the BSDF as it is, so that fewer directions tell all: none (default), point (half a "
                 "turn), mirror (at --axis), point_and_mirror (ridges, gratings) or isotropic (any turn)")
      ->check(CLI::IsMember(symmetries));
  app.add_option("--axis", arguments.axis_deg, "Azimuth of the mirror in degrees (default 0)")
      ->check(in_range(-360.0, 360.0));
  app.add_option("--largest-theta", arguments.largest_theta_deg, "The lowest light in degrees (default 85)")
      ->check(in_range(1.0, 89.0));
  app.add_option("--tolerance", arguments.tolerance,
                 "Largest relative L2 difference, noise taken out, of a map between two directions (default 0.1)")
      ->check(in_range(1e-4, 1.0));
  app.add_option("--noise", arguments.noise,
                 "Relative standard error of every computed map (default: a fourth of --tolerance)")
      ->check(in_range(1e-5, 1.0));
  app.add_option("--most", arguments.most_incidences, "Directions of the light at most (default 64)")
      ->check(CLI::Range(3, 4096));
  app.add_option("--resolution", arguments.resolution, "Bins a side of the direction maps (default 64)")
      ->check(CLI::Range(8, 1024));
  app.add_flag("--resume", arguments.resume,
               "Keep every computed direction in OUT.exr.parts, and go on from there: after Ctrl-C, or to refine");
}

nlohmann::ordered_json in_json(const std::string& file, const Result& result, const ReciprocityCheck& reciprocity) {
  const BsdfTableReport& report = result.built.report;
  return {{"written", file},
          {"incidences", report.incidences},
          {"computed", report.computed},
          {"largest_difference", Quantity{report.largest_difference, "1", {}}},
          {"met", report.met},
          {"untried", report.untried},
          {"stalled", report.stalled},
          {"squares", report.squares},
          {"bins", report.bins},
          {"largest_join_difference", Quantity{report.largest_join_difference, "1", {}}},
          {"largest_clipped_share", Quantity{report.largest_clipped_share, "1", {}}},
          {"reciprocity",
           {{"pairs", reciprocity.pairs},
            {"lost_in_noise", reciprocity.lost_in_noise},
            {"rms_relative", Quantity{reciprocity.rms_relative, "1", {}}},
            {"rms_in_standard_errors", reciprocity.rms_in_standard_errors}}},
          {"asymmetry", Quantity{result.asymmetry, "1", {}}},
          {"warnings", result.warnings}};
}

std::string what_to_do(const BsdfTableReport& report) {
  if (report.met) return "";
  std::string text;
  if (report.untried > 0) {
    text += fmt::format("\n{} intervals were left open: allow more directions (--most)", report.untried);
  }
  if (report.stalled > 0) {
    text += fmt::format(
        "\n{} intervals stay above the tolerance however finely they are divided: the bins are coarse for the lobe "
        "(--resolution), or the maps are noisy (--noise)",
        report.stalled);
  }
  return text;
}

std::string in_words(const std::string& file, const BuiltBsdfTable& built, const ReciprocityCheck& reciprocity) {
  const BsdfTableReport& report = built.report;
  return fmt::format(
             "wrote {}: {} directions of the light ({} computed now); between them a map is off by {:.2g} at most "
             "({})\nstored {} squares for {} bins; reciprocity: {:.2g} rms over {} pairs of directions",
             file, report.incidences, report.computed, report.largest_difference,
             report.met ? "within the tolerance" : "above the tolerance", report.squares, report.bins,
             reciprocity.rms_relative, reciprocity.pairs) +
         what_to_do(report);
}

}  // namespace

Command add_bsdf_table(CLI::App& program) {
  auto* app = program.add_subcommand(
      "bsdf-table", "The BSDF of a relief for all directions of the light, as a table to evaluate and to draw from");
  auto arguments = std::make_shared<BsdfTableArguments>();
  add_arguments(*app, *arguments);
  return {app, [arguments](const CommandContext& context) {
            const Result result = compute(*arguments, context);
            const BuiltBsdfTable& built = result.built;
            write_bsdf_table(built.table, arguments->output);
            const ReciprocityCheck reciprocity = check_reciprocity(built.table);
            context.print(in_json(arguments->output, result, reciprocity),
                          in_words(arguments->output, built, reciprocity));
            context.warn(result.warnings);
            return built.report.met ? ExitStatus::Done : ExitStatus::ToleranceMissed;
          }};
}

}  // namespace mezzotint
