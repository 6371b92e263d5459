#include "experiments/command_line/slice_appearance.h"

#include "experiments/configuration/appearance_file.h"
#include "experiments/configuration/pattern_table.h"
#include "experiments/run/pattern_json.h"
#include "experiments/run/run_files.h"

namespace mezzotint {

namespace {

Pattern pattern_of_design(const std::filesystem::path& folder) {
  const nlohmann::ordered_json design = read_json(folder / "design.json");
  if (design.contains("pattern")) return pattern_from_json(design.at("pattern"));
  if (std::filesystem::exists(folder / "pattern.toml")) return read_pattern_file(folder / "pattern.toml").pattern;
  throw InvalidInput(folder.string() +
                     ": this design has no pattern (a free form is a tile of pixels); a part needs a pattern");
}

// Regions of a plane become a picture that is laid on from above.
Appearance regions_of(const PatternRegions& regions) {
  Appearance appearance;
  appearance.picture =
      ProjectedLabels{Eigen::Vector3d::UnitZ(), regions.pixel, regions.columns, regions.rows, regions.labels, {}, {}};
  for (const PatternPart& part : regions.parts) appearance.regions.push_back({part.pattern, part.label, ""});
  return appearance;
}

}  // namespace

Appearance read_slice_appearance(const AppearanceArguments& arguments) {
  if (!arguments.file.empty()) return read_appearance(arguments.file);
  const Pattern pattern = pattern_of_design(arguments.design);
  if (const auto* regions = std::get_if<PatternRegions>(&pattern)) return regions_of(*regions);
  Appearance appearance;
  appearance.pattern = pattern;
  return appearance;
}

}  // namespace mezzotint
