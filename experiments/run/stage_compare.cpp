#include "experiments/run/patch.h"
#include "experiments/run/run_files.h"
#include "experiments/run/stages.h"
#include "measurement/comparison/registration.h"
#include "measurement/correction/plane.h"
#include "measurement/formats/surface_file.h"

namespace mezzotint {

std::vector<std::string> run_compare(const StageContext& context) {
  const HeightField design = read_gwy(context.folder / "design.gwy").field;
  const HeightField printed =
      inner_patch_of_picture(read_gwy(context.folder / "printed.gwy").field, context.experiment);
  const HeightField measured = level(read_gwy(context.folder / "measured.gwy").field);
  report(context.progress, "compare", 0.1, "registering the measurement to the design");
  const Registration registration = register_surfaces(design, measured, {}, context.progress);
  const HeightField registered = resample_to_design(design, measured, registration);
  const HeightField difference = residual(design, registered);
  write_gwy(registered, "registered", {}, context.folder / "registered.gwy");
  write_gwy(difference, "residual", {}, context.folder / "residual.gwy");

  const CoveredPart common = covered_part(registered);
  const auto same_part = [&](const HeightField& field) {
    return crop(field, common.inset, common.inset, common.field.columns(), common.field.rows());
  };
  const nlohmann::ordered_json comparison = {{"registration", to_json(registration)},
                                             {"residual", to_json(area_roughness(same_part(difference)))},
                                             {"roughness",
                                              {{"design", to_json(area_roughness(level(same_part(design))))},
                                               {"printed", to_json(area_roughness(level(same_part(printed))))},
                                               {"measured", to_json(area_roughness(level(common.field)))}}}};
  write_json(comparison, context.folder / "comparison.json");
  return {"registered.gwy", "residual.gwy", "comparison.json"};
}

}  // namespace mezzotint
