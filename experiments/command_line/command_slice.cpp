#include <chrono>
#include <cmath>
#include <filesystem>
#include <optional>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "experiments/command_line/command.h"
#include "experiments/command_line/json_words.h"
#include "experiments/command_line/option_checks.h"
#include "experiments/command_line/part_arguments.h"
#include "experiments/command_line/slice_appearance.h"
#include "experiments/configuration/printer_file.h"
#include "fabrication/appearance/slice_clothed.h"
#include "fabrication/job/job_file.h"
#include "fabrication/job/layer_png.h"
#include "fabrication/part/part_file.h"
#include "fabrication/repair/repair.h"
#include "fabrication/slicing/slice.h"
#include "forward/base/quantity.h"

namespace mezzotint {

namespace {

using Json = nlohmann::ordered_json;

struct SliceArguments {
  std::string part, unit, output, printer, mode = "volume";
  double layer_mm = 0.0, rotate_deg = 0.0;
  std::vector<double> offset_mm = {0.0, 0.0};
  int supersample = 0;
  bool linear = false, as_it_is = false, proximity = false;
  AppearanceArguments appearance;
};

void add_options(CLI::App& app, SliceArguments& arguments) {
  app.add_option("PART", arguments.part, "Mesh: STL, OBJ, PLY or 3MF")->required();
  add_unit(app, arguments.unit);
  app.add_option("--output,-o", arguments.output, "Job to write: .uvj, .sl1, or a folder (ends in /)")->required();
  app.add_option("--printer", arguments.printer, "Printer profile (TOML; default: the slides' printer)");
  app.add_option("--layer-mm", arguments.layer_mm, "Layer thickness (default: the profile's)")
      ->check(in_range(1e-4, 10.0));
  app.add_option("--offset-mm", arguments.offset_mm, "X,Y: away from the middle of the projector's field")
      ->delimiter(',')
      ->expected(2);
  app.add_option("--rotate-deg", arguments.rotate_deg, "Turn about z, counter-clockwise seen from above")
      ->check(in_range(-360.0, 360.0));
  app.add_option("--mode", arguments.mode,
                 "volume: the share of a pixel's box that the part fills; midplane: the share of its square half-way "
                 "up the layer, as other slicers do")
      ->check(CLI::IsMember({"volume", "midplane"}));
  app.add_option("--supersample", arguments.supersample,
                 "N x N samples a pixel half-way up the layer instead of exact coverage, for comparison")
      ->check(CLI::Range(1, most_supersamples));
  app.add_flag("--no-repair", arguments.as_it_is, "Slice the triangles as they are; holes and turned ones show");
  auto* linear = app.add_flag("--linear", arguments.linear, "Gray is the coverage, as other slicers do; no cure curve");
  app.add_flag("--proximity-correction", arguments.proximity,
               "Gray whose print, with the projector's blur, gives each pixel its share of the layer")
      ->excludes(linear);
  auto* file = app.add_option("--appearance", arguments.appearance.file,
                              "Patterns on the part's surface (TOML); examples under experiments/appearances");
  app.add_option("--design", arguments.appearance.design,
                 "Folder of a design (mezzotint design): its pattern goes on the part's surface")
      ->excludes(file);
}

SliceOptions options_of(const SliceArguments& arguments) {
  SliceOptions options;
  options.coverage.mode = arguments.mode == "volume" ? CoverageMode::Volume : CoverageMode::Midplane;
  options.coverage.supersample = arguments.supersample;
  if (arguments.layer_mm > 0.0) options.layer = Length::from_mm(arguments.layer_mm);
  options.placement = {Angle::from_degrees(arguments.rotate_deg), Length::from_mm(arguments.offset_mm[0]),
                       Length::from_mm(arguments.offset_mm[1])};
  options.linear = arguments.linear;
  options.proximity_correction = arguments.proximity;
  return options;
}

Job frame_of(const SliceArguments& arguments, const PrinterProfile& printer, Length layer) {
  Job frame;
  frame.name = std::filesystem::path(arguments.part).stem().string();
  frame.printer = printer.name;
  frame.columns = printer.pixels_x;
  frame.rows = printer.pixels_y;
  frame.pixel_pitch = printer.pixel_pitch;
  frame.layer = layer;
  frame.led_amplitude = printer.led_amplitude;
  return frame;
}

// The triangles to slice; what had to be assumed or mended goes to `notes`.
PartMesh part_to_slice(const SliceArguments& arguments, std::vector<std::string>& notes) {
  PartFile file = read_part(arguments.part, {.unit = unit_named(arguments.unit)});
  notes = std::move(file.notes);
  if (arguments.as_it_is) return std::move(file.mesh);
  RepairedPart repaired = repair_part(std::move(file.mesh));
  for (std::string& sentence : repaired.summary.sentences()) notes.push_back(std::move(sentence));
  return std::move(repaired.mesh);
}

// What must be known before the job is printed.
std::vector<std::string> warnings_of(const SliceSummary& summary, const SliceOptions& options) {
  std::vector<std::string> warnings;
  if (summary.total.lit_pixels == 0)
    warnings.emplace_back("every layer is dark: is the part turned inside out, or too fine for the pixels?");
  if (summary.total.open_rows > 0) {
    warnings.push_back(fmt::format("the surface does not close in {} rows of pixels; material may be missing there",
                                   summary.total.open_rows));
  }
  if (!options.linear && summary.total.saturated > 0) {
    warnings.push_back(fmt::format("{} pixels ask for more than full gray cures, which is {:.2f} % of a layer",
                                   summary.total.saturated, 100.0 * summary.largest_coverage));
  }
  return warnings;
}

Json to_json(const SliceSummary& summary, const SliceArguments& arguments, const PartMesh& part, Length layer) {
  const double lit = static_cast<double>(std::max<std::uint64_t>(summary.total.lit_pixels, 1));
  return {
      {"written", arguments.output},
      {"format", format_name(job_format(arguments.output))},
      {"triangles", part.triangles.size()},
      {"mode", arguments.supersample > 0 ? fmt::format("{0} x {0} samples", arguments.supersample) : arguments.mode},
      {"gray", arguments.linear ? "coverage" : "through the cure curve"},
      {"layer", Quantity{layer.um(), "µm", {}}},
      {"layers", summary.layers},
      {"height", Quantity{summary.height_mm, "mm", {}}},
      {"volume", Quantity{summary.volume_mm3, "mm³", {}}},
      {"lit_pixels", summary.total.lit_pixels},
      {"saturated_pixels", summary.total.saturated},
      {"saturated_share", Quantity{static_cast<double>(summary.total.saturated) / lit, "1", {}}},
      {"open_rows", summary.total.open_rows}};
}

// What proximity correction brought: RMS errors of the partly covered pixels' mean heights.
Json to_json(const ProximityFigures& figures) {
  const double edges = static_cast<double>(std::max<std::uint64_t>(figures.edge_pixels, 1));
  return {{"edge_pixels", figures.edge_pixels},
          {"error_before", Quantity{std::sqrt(figures.squares_before / edges), "µm", {}}},
          {"error_after", Quantity{std::sqrt(figures.squares_after / edges), "µm", {}}},
          {"needs_more_light", figures.needs_more_light},
          {"too_much_light", figures.too_much_light},
          {"finer_than_blur", figures.finer_than_blur}};
}

Json to_json(const ClothedPart& clothed) {
  Json json = {{"highest", Quantity{clothed.relief.highest.um(), "µm", {}}},
               {"surface_triangles", clothed.surface.corners.size()}};
  if (clothed.has_field) json["field_singularities"] = clothed.singularities;
  for (const PhaseFigures& waves : clothed.waves) {
    json["waves"].push_back(
        {{"wavelength_error", Quantity{waves.wavelength_error, "1", {}}}, {"defects", waves.defects}});
  }
  return json;
}

SliceSummary slice_to_file(const SliceArguments& arguments, const PartMesh& part, ClothedPart* clothed,
                           const PrinterProfile& printer, const SliceOptions& options, const Progress& progress) {
  const Length layer = options.layer.value_or(printer.layer);
  JobWriter writer(frame_of(arguments, printer, layer), arguments.output);
  const TakeLayer take = [&](SlicedLayer&& sliced) {
    writer.add(std::move(sliced.picture), sliced.packed, printer.exposure_s, sliced.top);
  };
  const SliceSummary summary = clothed != nullptr
                                   ? slice_clothed(part, std::move(clothed->surface), std::move(clothed->relief),
                                                   printer, options, encode_layer_png, take, progress)
                                   : slice_part(part, printer, options, encode_layer_png, take, progress);
  report(progress, "archive", 0.0, "putting the layers together");
  writer.close();
  return summary;
}

ExitStatus slice(const SliceArguments& arguments, const CommandContext& context) {
  const auto begin = std::chrono::steady_clock::now();
  const PrinterProfile printer = arguments.printer.empty() ? PrinterProfile{} : read_printer(arguments.printer);
  const SliceOptions options = options_of(arguments);
  (void)job_format(arguments.output);  // complains before the part is read
  std::vector<std::string> warnings;
  std::optional<Appearance> appearance;
  if (arguments.appearance.given()) appearance = appearance_reader()(arguments.appearance);
  const PartMesh part = part_to_slice(arguments, warnings);
  std::optional<ClothedPart> clothed;
  Json relief;
  if (appearance) {
    report(context.progress, "appearance", 0.0, "laying the patterns on the part");
    clothed = clothe(part, *appearance);
    relief = to_json(*clothed);
  }
  const SliceSummary summary =
      slice_to_file(arguments, part, clothed ? &*clothed : nullptr, printer, options, context.progress);
  for (std::string& warning : warnings_of(summary, options)) warnings.push_back(std::move(warning));
  Json json = to_json(summary, arguments, part, options.layer.value_or(printer.layer));
  if (clothed) json["relief"] = relief;
  if (options.proximity_correction) json["proximity_correction"] = to_json(summary.total.proximity);
  json["seconds"] = Quantity{std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count(), "s", {}};
  context.warn(warnings);
  const std::string words = in_words(json);
  json["warnings"] = warnings;
  context.print(json, words);
  return ExitStatus::Done;
}

}  // namespace

Command add_slice(CLI::App& program) {
  auto* app = program.add_subcommand(
      "slice",
      "Slice a part into gray layers: exact coverage of every pixel, through the printer's cure curve. The part stands "
      "in the middle of the projector's field, its lowest point on the platform.");
  auto arguments = std::make_shared<SliceArguments>();
  add_options(*app, *arguments);
  return {app, [arguments](const CommandContext& context) { return slice(*arguments, context); }};
}

}  // namespace mezzotint
