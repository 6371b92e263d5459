#include "experiments/command_line/mesh_simulation.h"

#include <memory>
#include <optional>

#include <CLI/CLI.hpp>

#include "experiments/command_line/option_checks.h"
#include "forward/scattering/mesh_tracing.h"
#include "forward/surface/mesh_file.h"

namespace mezzotint {

namespace {

std::optional<Length> unit_of(const MeshArguments& arguments) {
  if (arguments.unit == "um") return Length::from_um(1.0);
  if (arguments.unit == "mm") return Length::from_mm(1.0);
  if (arguments.unit == "m") return Length::from_m(1.0);
  return std::nullopt;
}

std::optional<MeshPeriod> period_of(const MeshArguments& arguments) {
  if (arguments.period_um.empty()) return std::nullopt;
  return MeshPeriod{Length::from_um(arguments.period_um[0]), Length::from_um(arguments.period_um[1])};
}

}  // namespace

void add_mesh_arguments(CLI::App& app, MeshArguments& arguments) {
  app.add_option("--periodic", arguments.period_um,
                 "X,Y in um: a mesh repeats so; its ends must fit to each other (default: an open patch)")
      ->delimiter(',')
      ->expected(2)
      ->check(in_range(1e-3, 1e9));
  app.add_option("--mesh-unit", arguments.unit,
                 "What a number in a mesh file is worth: um, mm or m (default: um for .obj and .ply, mm for .stl)")
      ->check(CLI::IsMember({"um", "mm", "m"}));
}

Simulation simulation_of_mesh(const std::string& path, const MeshArguments& arguments) {
  const MeshFile file = read_mesh(path, unit_of(arguments));
  const auto tracer = std::make_shared<const MeshPathTracer>(file.mesh, period_of(arguments));
  return [tracer, assumption = file.assumption](const PathTracingOptions& options, const Progress& progress) {
    Bsdf bsdf = tracer->trace(options, progress);
    if (!assumption.empty()) bsdf.provenance["assumption"] = assumption;
    return bsdf;
  };
}

}  // namespace mezzotint
