#include <algorithm>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "experiments/command_line/command.h"
#include "experiments/command_line/option_checks.h"
#include "experiments/command_line/surface_arguments.h"
#include "experiments/configuration/pattern_table.h"
#include "forward/base/quantity.h"
#include "forward/surface/mesh.h"
#include "measurement/formats/surface_file.h"
#include "measurement/formats/surface_output.h"

namespace mezzotint {

namespace {

using Json = nlohmann::ordered_json;

struct FileArguments : SurfaceArguments {
  std::string output;
};

std::string ending_of(const std::string& path) {
  std::string ending = std::filesystem::path(path).extension().string();
  std::ranges::transform(ending, ending.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return ending;
}

std::string written_help(std::string_view what) { return fmt::format("{} ({})", what, written_surface_formats); }

Json written(const std::string& path) { return {{"written", path}}; }

}  // namespace

Command add_convert(CLI::App& program) {
  auto* app = program.add_subcommand("convert", "Convert a surface to another format, or to a mesh (.obj)");
  auto arguments = std::make_shared<FileArguments>();
  add_surface_input(*app, "IN", *arguments);
  app->add_option("OUT", arguments->output, written_help("File to write; its ending names the format"))->required();
  return {app, [arguments](const CommandContext& context) {
            const SurfaceFile surface = arguments->read();
            write_surface(surface, arguments->output);
            Json json = written(arguments->output);
            json.update(contents(surface.field));
            json["assumption"] = surface.assumption;
            if (const auto rounding = rounding_of(surface.field, arguments->output))
              json["height_rounding"] = Quantity{rounding->um(), "µm", {}};
            const bool lost = surface.field.periodic() && !keeps_period(arguments->output);
            json["period_lost"] = lost;
            context.print(json, "wrote " + arguments->output +
                                    (lost ? "\nthe format cannot say that the surface is periodic" : ""));
            return ExitStatus::Done;
          }};
}

Command add_synthesize(CLI::App& program) {
  auto* app = program.add_subcommand("synthesize", "A pattern file to a relief");
  struct Arguments {
    std::string input;
    std::string output;
    std::vector<std::string> settings;
  };
  auto arguments = std::make_shared<Arguments>();
  app->add_option("PATTERN", arguments->input, "Pattern file (TOML); examples under experiments/patterns")->required();
  app->add_option("--output,-o", arguments->output, written_help("File to write"))->required();
  app->add_option("--set", arguments->settings, "Change a setting: --set pattern.scale_um=80")->allow_extra_args(false);
  return {app, [arguments](const CommandContext& context) {
            PatternFile file = read_pattern_file(arguments->input, arguments->settings);
            if (context.common.seed >= 0) {
              file.pattern = draw_instance(file.pattern, static_cast<std::uint64_t>(context.common.seed)).pattern;
            }
            const SurfaceFile surface{synthesize(file.pattern, file.grid, {}, file.continuation),
                                      "pattern",
                                      std::string(kind_name(file.pattern)),
                                      {{"pattern", pattern_file_text(file, "synthesized")}},
                                      ""};
            write_surface(surface, arguments->output);
            Json json = written(arguments->output);
            std::string text = "wrote " + arguments->output;
            if (file.continuation == Continuation::Periodic) {
              const double change = periodic_change(file.pattern, file.grid);
              json["periodic_change"] = Quantity{change, "1", {}};
              text += fmt::format("\nperiodic: the pattern was changed by {:.2g} % to fit", 100.0 * change);
            }
            context.print(json, text);
            return ExitStatus::Done;
          }};
}

Command add_mesh(CLI::App& program) {
  auto* app =
      program.add_subcommand("mesh", "A relief to a triangle mesh with angle-weighted normals and a material file");
  struct Arguments : FileArguments {
    double index = 1.5;
    bool close = false;
  };
  auto arguments = std::make_shared<Arguments>();
  add_surface_input(*app, "HEIGHT", *arguments);
  app->add_option("--output,-o", arguments->output, "OBJ to write; its MTL stands beside it")->required();
  app->add_option("--index", arguments->index, "Index of refraction (Ni of the material; default 1.5)")
      ->check(in_range(1.0, 10.0));
  app->add_flag("--close", arguments->close,
                "Of a periodic relief: with the cells that close it, so that copies fit (for bsdf --periodic)");
  return {app, [arguments](const CommandContext& context) {
            if (ending_of(arguments->output) != ".obj")
              throw InvalidInput(arguments->output + ": meshes are written as .obj");
            const HeightField field = arguments->read().field;
            const TriangleMesh mesh = arguments->close ? to_closed_mesh(field) : to_mesh(field);
            write_obj(mesh, {.index_of_refraction = arguments->index}, arguments->output);
            Json json = written(arguments->output);
            json["vertices"] = mesh.vertices_um.size();
            json["triangles"] = mesh.triangles.size();
            context.print(json, fmt::format("wrote {}: {} vertices, {} triangles", arguments->output,
                                            mesh.vertices_um.size(), mesh.triangles.size()));
            return ExitStatus::Done;
          }};
}

}  // namespace mezzotint
