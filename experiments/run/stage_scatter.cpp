#include <fmt/format.h>

#include "experiments/run/patch.h"
#include "experiments/run/simulate.h"
#include "experiments/run/stages.h"
#include "measurement/correction/fill.h"
#include "measurement/correction/plane.h"
#include "measurement/formats/surface_file.h"

namespace mezzotint {

namespace {

struct NamedRelief {
  std::string name;
  HeightField field;
};

// What is traced: the prediction, the print, the measurement, and a scan that is the target.
std::vector<NamedRelief> reliefs(const StageContext& context) {
  const auto read = [&](const char* file) { return read_gwy(context.folder / file).field; };
  std::vector<NamedRelief> list;
  list.push_back({"predicted", level(read("predicted.gwy"))});
  list.push_back({"printed", level(inner_patch_of_picture(read("printed.gwy"), context.experiment))});
  list.push_back({"measured", level(fill_missing(covered_part(read("registered.gwy")).field))});
  if (context.experiment.target.kind == "scan") list.push_back({"target", read("target.gwy")});
  return list;
}

}  // namespace

std::vector<std::string> run_scatter(const StageContext& context) {
  const SimulationSpecification& simulation = context.experiment.simulation;
  const auto list = reliefs(context);
  const auto total = static_cast<double>(list.size() * simulation.incidences.size());
  std::vector<std::string> outputs;
  for (const auto& [name, field] : list) {
    PathTracer tracer(field);
    for (std::size_t i = 0; i < simulation.incidences.size(); ++i) {
      const auto done = static_cast<double>(outputs.size());
      const std::string note = fmt::format("BSDF {} of {:.0f}: {}", outputs.size() + 1, total, name);
      const Progress inner = [&](const ProgressEvent& event) {
        report(context.progress, "scatter", (done + event.fraction) / total,
               event.note.empty() ? note : note + ", " + event.note);
      };
      report(inner, "", 0.0);
      outputs.push_back(fmt::format("bsdf_{}_{}.exr", name, i));
      // A seed of its own for every map: their errors must be independent.
      const std::uint64_t seed = context.experiment.search.minimize.seed * 1000 + outputs.size();
      write_exr(simulate(field, tracer, simulation, simulation.incidences[i], seed, inner),
                context.folder / outputs.back());
    }
  }
  return outputs;
}

}  // namespace mezzotint
