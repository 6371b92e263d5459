#include "experiments/command_line/surface_arguments.h"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "experiments/command_line/option_checks.h"
#include "forward/base/quantity.h"

namespace mezzotint {

SurfaceFile SurfaceArguments::read() const {
  ReadOptions options;
  if (min_quality > 0) options.min_quality = min_quality;
  return read_surface(input, options);
}

void add_surface_input(CLI::App& app, const char* name, SurfaceArguments& arguments, const char* besides) {
  app.add_option(
         name, arguments.input,
         fmt::format("Surface: {}; FILE.gwy#/N/data for one of several channels{}", read_surface_formats, besides))
      ->required();
  app.add_option("--min-quality", arguments.min_quality,
                 "Take samples below this gray level of qualitymap.bmp as missing (Alicona's folders)")
      ->check(CLI::Range(1, 255));
}

nlohmann::ordered_json contents(const HeightField& field) {
  const Grid& grid = field.grid();
  const auto missing = static_cast<double>(field.missing_count());
  return {{"columns", grid.columns},
          {"rows", grid.rows},
          {"pitch_x", Quantity{grid.pitch_x.um(), "µm", {}}},
          {"pitch_y", Quantity{grid.pitch_y.um(), "µm", {}}},
          {"missing", field.missing_count()},
          {"missing_share", Quantity{missing / static_cast<double>(grid.size()), "1", {}}}};
}

}  // namespace mezzotint
