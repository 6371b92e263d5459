#include <cmath>

#include "experiments/run/design_file.h"
#include "experiments/run/run_experiment.h"
#include "experiments/run/run_files.h"
#include "experiments/run/stages.h"
#include "experiments/run/target_lobes.h"
#include "experiments/run/target_relief.h"
#include "forward/base/error.h"
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

template <class Maps>
Target make_target(const StageContext& context, const Maps&, std::vector<std::string>&) {
  return target_of_lobes(context.experiment.target, context.experiment.simulation);
}

[[noreturn]] Target make_target(const StageContext&, const WantedRegions&, std::vector<std::string>&) {
  throw InvalidInput("a run prints and measures one patch, and this target has regions: use mezzotint design");
}

}  // namespace

std::vector<std::string> run_target(const StageContext& context) {
  std::vector<std::string> outputs = {"target.json"};
  Target target = std::visit([&](const auto& wanted) { return make_target(context, wanted, outputs); },
                             context.experiment.target.wanted);
  target.tolerance =
      context.experiment.target.tolerance.value_or(is_by_light(context.experiment) ? HUGE_VAL : target.tolerance);
  target.rotation_tolerance = context.experiment.target.rotation_tolerance;
  write_json(to_json(target), context.folder / "target.json");
  return outputs;
}

}  // namespace mezzotint
