#include <cmath>

#include "experiments/run/design_file.h"
#include "experiments/run/run_experiment.h"
#include "experiments/run/run_files.h"
#include "experiments/run/stages.h"
#include "experiments/run/target_relief.h"
#include "measurement/formats/surface_file.h"

namespace mezzotint {

namespace {

Target make_target(const StageContext& context, std::vector<std::string>& outputs) {
  const TargetSpecification& wanted = context.experiment.target;
  if (wanted.kind == "beckmann") return beckmann_target({wanted.alpha_x, wanted.alpha_y, wanted.rotation});
  if (wanted.kind == "anisotropy") return anisotropy_target(wanted.ratio, wanted.mean_alpha);
  report(context.progress, "target", 0.1, "reading and correcting " + wanted.scan.filename().string());
  const TargetRelief relief = read_target_relief(wanted.scan, wanted.outliers);
  write_gwy(relief.field, "target", relief.provenance, context.folder / "target.gwy");
  outputs.emplace_back("target.gwy");
  return scan_target(relief.field);
}

}  // namespace

std::vector<std::string> run_target(const StageContext& context) {
  std::vector<std::string> outputs = {"target.json"};
  Target target = make_target(context, outputs);
  target.tolerance =
      context.experiment.target.tolerance.value_or(is_by_light(context.experiment) ? HUGE_VAL : target.tolerance);
  target.rotation_tolerance = context.experiment.target.rotation_tolerance;
  write_json(to_json(target), context.folder / "target.json");
  return outputs;
}

}  // namespace mezzotint
