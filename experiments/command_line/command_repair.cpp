#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "experiments/command_line/command.h"
#include "experiments/command_line/option_checks.h"
#include "experiments/command_line/part_arguments.h"
#include "fabrication/repair/repair.h"
#include "forward/base/quantity.h"

namespace mezzotint {

namespace {

using Json = nlohmann::ordered_json;

struct Arguments {
  std::string input, output, unit;
};

Json describe(const RepairSummary& summary) {
  Json json = {{"changed", summary.changed()},
               {"collapsed_removed", summary.collapsed_removed},
               {"duplicates_removed", summary.duplicates_removed},
               {"vertices_joined", summary.vertices_joined},
               {"triangles_turned", summary.triangles_turned},
               {"shells_turned", summary.shells_turned},
               {"edges_stitched", summary.edges_stitched},
               {"holes_filled", summary.holes_filled},
               {"triangles_added", summary.triangles_added},
               {"scraps_removed", summary.scraps_removed},
               {"self_intersections", summary.self_intersections.value_or(0)}};
  json["before"] = describe(summary.before);
  json["after"] = describe(summary.after);
  return json;
}

std::string in_words(const RepairSummary& summary, const std::string& output) {
  std::string text;
  for (const std::string& sentence : summary.sentences()) text += sentence + "\n";
  if (!summary.changed()) text += "nothing to mend\n";
  const MeshFacts& after = summary.after;
  text += fmt::format("{} triangles, {} {}, {:.9g} mm³, {:.9g} mm²\n", after.triangles, after.bodies,
                      after.bodies == 1 ? "body" : "bodies", after.volume_mm3, after.area_mm2);
  return text + "wrote " + output;
}

ExitStatus repair(const Arguments& arguments, const CommandContext& context) {
  require_folder_of(arguments.output);
  PartFile file = read_part(arguments.input, {.unit = unit_named(arguments.unit)});
  context.warn(file.notes);
  const RepairedPart part = repair_part(std::move(file.mesh), {.count_self_intersections = true});
  write_stl(part.mesh, arguments.output);
  Json json = {{"written", arguments.output}, {"format", file.format}};
  json.update(describe(part.summary));
  json["warnings"] = file.notes;
  context.print(json, in_words(part.summary, arguments.output));
  return ExitStatus::Done;
}

}  // namespace

void add_unit(CLI::App& app, std::string& unit) {
  app.add_option("--unit", unit, "What a number in a mesh file is worth (default: what the file says, else 1 mm)")
      ->check(CLI::IsMember({"um", "mm", "cm", "in", "m"}));
}

std::optional<Length> unit_named(const std::string& unit) {
  if (unit == "um") return Length::from_um(1.0);
  if (unit == "mm") return Length::from_mm(1.0);
  if (unit == "cm") return Length::from_mm(10.0);
  if (unit == "in") return Length::from_mm(25.4);
  if (unit == "m") return Length::from_m(1.0);
  return std::nullopt;
}

Json describe(const MeshFacts& facts) {
  const auto length = [](double mm) { return Quantity{mm, "mm", {}}; };
  return {{"triangles", facts.triangles},
          {"vertices", facts.vertices},
          {"width", length(facts.high_mm[0] - facts.low_mm[0])},
          {"depth", length(facts.high_mm[1] - facts.low_mm[1])},
          {"height", length(facts.high_mm[2] - facts.low_mm[2])},
          {"low_x", length(facts.low_mm[0])},
          {"low_y", length(facts.low_mm[1])},
          {"low_z", length(facts.low_mm[2])},
          {"area", Quantity{facts.area_mm2, "mm²", {}}},
          {"volume", Quantity{facts.volume_mm3, "mm³", {}}},
          {"bodies", facts.bodies},
          {"watertight", facts.watertight()},
          {"closed", facts.closed()},
          {"boundary_edges", facts.boundary_edges},
          {"non_manifold_edges", facts.non_manifold_edges},
          {"inconsistent_edges", facts.inconsistent_edges},
          {"degenerate_triangles", facts.degenerate_triangles}};
}

Command add_repair(CLI::App& program) {
  auto* app = program.add_subcommand(
      "repair", "Mend a part (.stl, .obj, .ply, .3mf): orientation, open seams, holes; tells what was mended");
  auto arguments = std::make_shared<Arguments>();
  app->add_option("PART", arguments->input, "Part to read")->required();
  app->add_option("--output,-o", arguments->output, "STL to write (binary, millimetres)")->required();
  add_unit(*app, arguments->unit);
  return {app, [arguments](const CommandContext& context) { return repair(*arguments, context); }};
}

}  // namespace mezzotint
