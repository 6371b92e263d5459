#pragma once

#include <functional>
#include <string>
#include <vector>

#include "forward/base/progress.h"
#include "forward/scattering/path_tracing.h"

namespace CLI {
class App;
}

namespace mezzotint {

/// What a command says of a surface that is a mesh.
struct MeshArguments {
  std::vector<double> period_um;  ///< none, or x and y
  std::string unit;               ///< "um", "mm", "m"; empty: what the format means
};

void add_mesh_arguments(CLI::App& app, MeshArguments& arguments);

/// A surface that is ready to be lit: one BSDF for each call.
using Simulation = std::function<Bsdf(const PathTracingOptions& options, const Progress& progress)>;

/// Reads a mesh and builds what its rays need. What was assumed stands in the provenance as "assumption".
/// @throws what read_mesh and MeshPathTracer throw.
[[nodiscard]] Simulation simulation_of_mesh(const std::string& path, const MeshArguments& arguments);

}  // namespace mezzotint
