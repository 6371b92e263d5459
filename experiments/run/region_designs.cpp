#include "experiments/run/region_designs.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "experiments/configuration/pattern_table.h"
#include "experiments/report/components.h"
#include "experiments/report/report.h"
#include "experiments/run/design_answer.h"
#include "experiments/run/design_file.h"
#include "experiments/run/run_files.h"
#include "experiments/run/run_folder.h"
#include "experiments/version.h"
#include "forward/base/error.h"
#include "forward/base/file_output.h"
#include "forward/process/printed_relief.h"

namespace mezzotint {

namespace {

using Json = nlohmann::ordered_json;

// More would take minutes, and hundreds of megabytes of disk.
constexpr double most_samples = 1 << 24;

struct RegionDesign {
  int label = 0;
  std::string folder;
  RunOutcome outcome;
  Json json;
  Pattern drawn;
  Position origin;
};

const WantedRegions& regions_of(const Experiment& experiment) {
  return std::get<WantedRegions>(experiment.target.wanted);
}

// The whole picture in the printer's pixels.
Grid layer_grid(const Experiment& experiment) {
  const PatternRegions& picture = regions_of(experiment).picture;
  const PrinterProfile& printer = experiment.printer;
  const auto pixels = [&](std::size_t count) {
    return static_cast<std::size_t>(std::lround(static_cast<double>(count) * (picture.pixel / printer.pixel_pitch)));
  };
  const Grid grid{pixels(picture.columns), pixels(picture.rows), printer.pixel_pitch, printer.pixel_pitch};
  require(grid.columns >= 16 && grid.rows >= 16,
          fmt::format("the label picture covers {} × {} pixels of the printer, and 16 a side are the least; raise "
                      "[target] pixel_um",
                      grid.columns, grid.rows));
  require(grid.columns <= printer.pixels_x && grid.rows <= printer.pixels_y,
          fmt::format("the label picture covers {} × {} pixels of the printer, which has {} × {}; lower [target] "
                      "pixel_um",
                      grid.columns, grid.rows, printer.pixels_x, printer.pixels_y));
  return grid;
}

Experiment part_of(const Experiment& experiment, const TargetRegion& region) {
  Experiment part = experiment;
  part.target = region.target;
  part.title = fmt::format("{}, region {}", experiment.title, region.label);
  part.canonical_text += fmt::format("\nregion {}\n", region.label);
  return part;
}

RegionDesign designed(const Experiment& experiment, const TargetRegion& region, const RunOptions& options,
                      const Progress& progress) {
  RegionDesign design{.label = region.label, .folder = fmt::format("region_{}", region.label)};
  RunOptions own = options;
  own.folder = options.folder / design.folder;
  own.resume = true;  // what is there is of this run: the folder around it is new, or goes on
  own.say = [&](const std::string& text) { options.say(fmt::format("region {}: {}", region.label, text)); };
  const Progress within = [&](const ProgressEvent& event) {
    ProgressEvent named = event;
    named.stage = fmt::format("region {} {}", region.label, event.stage);
    progress(named);
  };
  design.outcome = run_experiment(part_of(experiment, region), own, progress ? within : progress);
  design.json = read_json(own.folder / "design.json");
  const Design found = design_from_json(design.json);
  const PatternInstance instance = draw_instance(found.pattern, found.print_seed);
  design.drawn = instance.pattern;
  design.origin = instance.origin;
  return design;
}

GrayImage whole_gray(const RegionDesign& design, const Experiment& experiment, const Grid& grid) {
  HeightField heights = synthesize(design.drawn, grid, design.origin);
  const double lift = std::max(0.0, (reachable_height(experiment.printer) - height_of(design.drawn)).um());
  for (float& z : heights.heights_um()) z += static_cast<float>(lift);
  return quantize(expose(heights, experiment.printer).image, experiment.printer);
}

int label_at(const PatternRegions& picture, double x_um, double y_um) {
  const auto cell = [&](double at_um, double corner_um, std::size_t count) {
    const double index = std::floor((at_um - corner_um) / picture.pixel.um());
    const auto n = static_cast<double>(count);
    return static_cast<std::size_t>(index - n * std::floor(index / n));
  };
  const std::size_t column = cell(x_um, picture.corner.x.um(), picture.columns),
                    row = cell(y_um, picture.corner.y.um(), picture.rows);
  return picture.labels[row * picture.columns + column];
}

GrayImage combined_gray(const std::vector<RegionDesign>& designs, const Experiment& experiment, const Grid& grid) {
  const PatternRegions& picture = regions_of(experiment).picture;
  const double pitch = grid.pitch_x.um();
  GrayImage all{grid.columns, grid.rows, std::vector<float>(grid.columns * grid.rows)};
  for (const RegionDesign& design : designs) {
    const GrayImage gray = whole_gray(design, experiment, grid);
    for (std::size_t k = 0; k < all.values.size(); ++k) {
      const double x = pitch * (static_cast<double>(k % grid.columns) + 0.5),
                   y = pitch * (static_cast<double>(k / grid.columns) + 0.5);
      if (label_at(picture, x, y) == design.label) all.values[k] = gray.values[k];
    }
  }
  return all;
}

HeightField combined_relief(const GrayImage& gray, const Experiment& experiment) {
  const double pixels = static_cast<double>(gray.values.size());
  const auto finest = static_cast<std::size_t>(std::sqrt(most_samples / pixels));
  const std::size_t subsamples = std::clamp<std::size_t>(finest, 1, experiment.patch.subsamples);
  HeightField relief = print_layer(gray, experiment.printer, {.subsamples = subsamples, .surround = Surround::Mirror});
  add_ground(relief, experiment.printer, split_ground(experiment.printer, experiment.patch.wavelength).geometric,
             experiment.search.minimize.seed);
  return relief;
}

Pattern combined_pattern(const std::vector<RegionDesign>& designs, const Experiment& experiment) {
  PatternRegions regions = regions_of(experiment).picture;
  for (const RegionDesign& design : designs) regions.parts.push_back({design.drawn, design.label});
  return regions;
}

Json summary_of(const std::vector<RegionDesign>& designs) {
  Json json = {{"met", true}, {"regions", Json::array()}};
  for (const RegionDesign& design : designs) {
    json["met"] = json["met"].get<bool>() && design.outcome.met;
    json["regions"].push_back({{"label", design.label},
                               {"folder", design.folder},
                               {"verdict", design.outcome.verdict},
                               {"met", design.outcome.met},
                               {"gamut", design.json.at("gamut")},
                               {"figures", design.json.at("figures")},
                               {"warnings", design.json.at("warnings")}});
  }
  return json;
}

std::string verdict_of(const Json& json) {
  std::size_t met = 0;
  for (const Json& region : json.at("regions")) met += region.at("met").get<bool>() ? 1 : 0;
  return fmt::format("{} of {} regions within their tolerances (those without one count).", met,
                     json.at("regions").size());
}

Report page_of(const Experiment& experiment, const Json& json, const HeightField& relief) {
  Report page{
      .title = experiment.title,
      .subtitle = fmt::format("A design of {} regions for {}.", json.at("regions").size(), experiment.printer.name),
      .verdict = {json.at("met").get<bool>() ? Outcome::Met : Outcome::Missed, verdict_of(json)}};
  std::vector<TableRow> rows;
  for (const Json& region : json.at("regions")) {
    rows.push_back({{std::to_string(region.at("label").get<int>()), region.at("verdict").get<std::string>(),
                     region.at("gamut").at("in_words").get<std::string>(),
                     region.at("folder").get<std::string>() + "/report.html"},
                    region.at("met").get<bool>() ? Outcome::Met : Outcome::Missed});
    for (const Json& warning : region.at("warnings"))
      page.messages.push_back({MessageLevel::Warning, fmt::format("region {}: {}", region.at("label").get<int>(),
                                                                  warning.get<std::string>())});
  }
  Section regions{.title = "The regions",
                  .text = "One design a region, each with a page of its own, and one layer of all of them."};
  regions.components = {table({.title = "What each came to"}, {"label", "design", "reach", "page"}, rows),
                        relief_maps({.title = "Predicted relief"}, {{"predicted", relief}})};
  page.sections = {regions};
  page.provenance = {{"program", std::string("mezzotint ") + program_version},
                     {"experiment", experiment.file.filename().string()},
                     {"printer", experiment.printer.name},
                     {"settings", experiment.canonical_text}};
  return page;
}

}  // namespace

RunOutcome design_regions(const Experiment& experiment, const RunOptions& options, const Progress& progress) {
  require(options.design_only,
          "a run prints and measures one patch, and this target has regions: use mezzotint design");
  require(!experiment.pattern.free_form,
          "regions are combined from patterns, and a free form is none; name another [pattern] kind");
  const Grid grid = layer_grid(experiment);
  RunFolder folder(options.folder, experiment_digest(experiment), options.resume);
  std::vector<RegionDesign> designs;
  for (const TargetRegion& region : regions_of(experiment).regions)
    designs.push_back(designed(experiment, region, options, progress));
  Json json = summary_of(designs);
  if (!folder.is_finished("regions")) {
    const GrayImage gray = combined_gray(designs, experiment, grid);
    const HeightField relief = combined_relief(gray, experiment);
    json["gray"] = write_layer({experiment, folder, progress, options.say}, gray, relief);
    write_json(json, folder / "design.json");
    write_file(folder / "pattern.toml",
               pattern_file_text({combined_pattern(designs, experiment), grid},
                                 "The regions of \"" + experiment.title + "\"; gray.png is what is printed"));
    write_report(page_of(experiment, json, relief), folder / "report.html");
    folder.finish("regions", {"design.json", "pattern.toml", "gray.png", "relief.gwy", "report.html"});
  }
  json = read_json(folder / "design.json");
  return {folder.path(), json.at("met").get<bool>(), verdict_of(json), json};
}

}  // namespace mezzotint
