#include <cmath>

#include "experiments/run/run_files.h"
#include "experiments/run/stages.h"
#include "experiments/run/target_maps.h"
#include "experiments/run/target_relief.h"
#include "measurement/formats/surface_file.h"

namespace mezzotint {

namespace {

Target make_target(const StageContext&, const BeckmannLobe& wanted, std::vector<std::string>&) {
  return beckmann_target(wanted);
}

Target make_target(const StageContext&, const WantedAnisotropy& wanted, std::vector<std::string>&) {
  return anisotropy_target(wanted.ratio, wanted.mean_alpha);
}

Target make_target(const StageContext& context, const WantedScan& wanted, std::vector<std::string>& outputs) {
  report(context.progress, "target", 0.1, "reading and correcting " + wanted.scan.filename().string());
  const TargetRelief relief = read_target_relief(wanted.scan, wanted.outliers);
  write_gwy(relief.field, "target", relief.provenance, context.folder / "target.gwy");
  outputs.emplace_back("target.gwy");
  return scan_target(relief.field);
}

// Read and judged, but the search of a run takes no maps yet.
[[noreturn]] void refuse(const TargetSpecification& target) {
  throw InvalidInput("a target of kind \"" + target.kind +
                     "\" is read and found sound, but a run cannot search for one yet; \"beckmann\", \"anisotropy\" "
                     "and \"scan\" can be searched for");
}

template <class Maps>
Target make_target(const StageContext& context, const Maps&, std::vector<std::string>&) {
  static_cast<void>(wanted_maps(context.experiment.target, context.experiment.simulation));
  refuse(context.experiment.target);
}

Target make_target(const StageContext& context, const WantedRegions& wanted, std::vector<std::string>&) {
  for (const TargetRegion& region : wanted.regions) {
    if (is_lobe_alone(region.target)) static_cast<void>(wanted_maps(region.target, context.experiment.simulation));
  }
  refuse(context.experiment.target);
}

}  // namespace

std::vector<std::string> run_target(const StageContext& context) {
  std::vector<std::string> outputs = {"target.json"};
  Target target = std::visit([&](const auto& wanted) { return make_target(context, wanted, outputs); },
                             context.experiment.target.wanted);
  const bool is_lobe = context.experiment.objective == SearchObjective::LobeCubeRoot;
  target.tolerance = context.experiment.target.tolerance.value_or(is_lobe ? HUGE_VAL : target.tolerance);
  target.rotation_tolerance = context.experiment.target.rotation_tolerance;
  write_json(to_json(target), context.folder / "target.json");
  return outputs;
}

}  // namespace mezzotint
