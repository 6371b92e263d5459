#include <algorithm>
#include <cstdio>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "experiments/command_line/command.h"
#include "experiments/command_line/option_checks.h"
#include "experiments/command_line/surface_arguments.h"
#include "experiments/configuration/pattern_table.h"
#include "experiments/run/run_files.h"
#include "forward/surface/mesh.h"
#include "measurement/correction/fill.h"
#include "measurement/correction/outliers.h"
#include "measurement/correction/plane.h"
#include "measurement/formats/surface_file.h"
#include "measurement/formats/surface_output.h"
#include "measurement/texture/roughness.h"

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

std::string in_words(const AreaRoughness& roughness) {
  std::string text;
  const auto line = [&](const char* name, const Quantity& q) {
    const std::string error =
        q.standard_error && *q.standard_error == *q.standard_error ? fmt::format(" ± {:.2g}", *q.standard_error) : "";
    text += fmt::format("{:<4}{:>12.6g}{} {}\n", name, q.value, error, q.unit == "1" ? "" : q.unit);
  };
  line("Sa", roughness.Sa);
  line("Sq", roughness.Sq);
  line("Sz", roughness.Sz);
  line("Ssk", roughness.Ssk);
  line("Sku", roughness.Sku);
  line("Sdq", roughness.Sdq);
  line("Sdr", roughness.Sdr);
  return text + fmt::format("{} samples, {} of them missing", roughness.samples + roughness.missing, roughness.missing);
}

struct CorrectArguments : FileArguments {
  double outliers = 0.0;
  bool fill = false;
  std::string level;
  std::vector<std::size_t> crop;
};

// The order of the Gwyddion chain on the slides: crop, level, outliers, fill.
HeightField corrected(HeightField field, const CorrectArguments& arguments) {
  if (!arguments.crop.empty()) {
    field = crop(field, arguments.crop[0], arguments.crop[1], arguments.crop[2], arguments.crop[3]);
  }
  if (arguments.level == "plane") field = level(field);
  if (arguments.outliers > 0.0) field = mask_outliers(field, arguments.outliers).field;
  if (arguments.fill) field = fill_missing(field);
  return field;
}

std::string correction_in_words(const CorrectArguments& arguments) {
  std::string text;
  const auto add = [&](const std::string& step) { text += (text.empty() ? "" : "; ") + step; };
  if (!arguments.crop.empty()) {
    add(fmt::format("cropped to {} x {} samples from ({}, {})", arguments.crop[2], arguments.crop[3], arguments.crop[0],
                    arguments.crop[1]));
  }
  if (arguments.level == "plane") add("levelled by the least-squares plane");
  if (arguments.outliers > 0.0)
    add(fmt::format("outliers beyond {:g} standard deviations taken out", arguments.outliers));
  if (arguments.fill) add("missing samples filled by Laplace's equation");
  return text.empty() ? "none" : text;
}

}  // namespace

Command add_convert(CLI::App& program) {
  auto* app = program.add_subcommand("convert", "Convert a surface to another format, or to a mesh (.obj)");
  auto arguments = std::make_shared<FileArguments>();
  add_surface_input(*app, "IN", *arguments);
  app->add_option("OUT", arguments->output, written_help("File to write; its ending names the format"))->required();
  return {app, [arguments](const CommandContext& context) {
            write_surface(arguments->read(), arguments->output);
            context.print(written(arguments->output), "wrote " + arguments->output);
            return ExitStatus::Done;
          }};
}

Command add_correct(CLI::App& program) {
  auto* app =
      program.add_subcommand("correct", "Correct a scan: crop, level, take out outliers, fill holes (in this order)");
  auto arguments = std::make_shared<CorrectArguments>();
  add_surface_input(*app, "SCAN", *arguments);
  app->add_option("--output,-o", arguments->output, written_help("File to write"))->required();
  app->add_option("--outliers", arguments->outliers, "Mask samples further than K standard deviations from the plane")
      ->check(in_range(1.0, 100.0));
  app->add_flag("--fill", arguments->fill, "Fill missing samples by Laplace's equation");
  app->add_option("--level", arguments->level, "plane: subtract the least-squares plane")
      ->check(CLI::IsMember({"plane"}));
  app->add_option("--crop", arguments->crop, "X,Y,W,H in samples")->delimiter(',')->expected(4);
  return {app, [arguments](const CommandContext& context) {
            SurfaceFile surface = arguments->read();
            const std::size_t missing = surface.field.missing_count();
            surface.field = corrected(std::move(surface.field), *arguments);
            surface.provenance["correction"] = correction_in_words(*arguments);
            write_surface(surface, arguments->output);
            Json json = written(arguments->output);
            json["missing_before"] = missing;
            json["missing_after"] = surface.field.missing_count();
            context.print(json, fmt::format("wrote {}: {} samples missing before, {} after", arguments->output, missing,
                                            surface.field.missing_count()));
            return ExitStatus::Done;
          }};
}

Command add_roughness(CLI::App& program) {
  auto* app = program.add_subcommand("roughness", "Areal parameters of ISO 25178-2, each with its standard error");
  struct Arguments : SurfaceArguments {
    std::string level = "plane";
  };
  auto arguments = std::make_shared<Arguments>();
  add_surface_input(*app, "SCAN", *arguments);
  app->add_option("--level", arguments->level, "plane (default) or none")->check(CLI::IsMember({"plane", "none"}));
  return {app, [arguments](const CommandContext& context) {
            const SurfaceFile surface = arguments->read();
            const AreaRoughness roughness =
                area_roughness(arguments->level == "plane" ? level(surface.field) : surface.field);
            Json json = to_json(roughness);
            json["assumption"] = surface.assumption;
            const std::string note = surface.assumption.empty() ? "" : "\nassumed: " + surface.assumption;
            context.print(json, in_words(roughness) + note);
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
