#include "experiments/configuration/experiment_file.h"

#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "experiments/configuration/printer_file.h"

namespace mezzotint {

namespace {

constexpr Range direction_range{-360.0, 360.0};

PrinterProfile read_printer_table(TomlTable table) {
  PrinterProfile printer;
  if (table.has("profile")) printer = read_printer(table.file("profile"));
  table.finish();
  return printer;
}

Material read_material(TomlTable& table) {
  const std::string text = table.text("material", "dielectric:1.5");
  try {
    return parse_material(text);
  } catch (const InvalidInput& error) {
    table.complain("material", error.what());
  }
}

SimulationSpecification read_simulation(TomlTable table) {
  SimulationSpecification simulation;
  simulation.incidences_given = table.has("incidence_deg");
  for (const auto& [theta, phi] : table.pairs("incidence_deg", direction_range, {{20.0, 0.0}, {20.0, 90.0}})) {
    if (theta < 0.0 || theta > 89.0)
      table.complain("incidence_deg", "the first angle of a pair is from the normal, in [0, 89]");
    simulation.incidences.push_back({Angle::from_degrees(theta), Angle::from_degrees(phi)});
  }
  simulation.wavelength = Length::from_nm(table.number("wavelength_nm", {200.0, 20000.0}, 550.0));
  simulation.material = read_material(table);
  simulation.model = table.choice("model", {"auto", "paths"}, simulation.model);
  simulation.resolution = static_cast<std::size_t>(table.integer("resolution", 8, 1024, 64));
  simulation.tolerance = table.number("tolerance", {1e-4, 1.0}, simulation.tolerance);
  simulation.most_samples = static_cast<std::uint64_t>(
      table.integer("samples", 1 << 12, std::int64_t{1} << 34, std::int64_t(simulation.most_samples)));
  table.finish();
  return simulation;
}

void read_print(TomlTable table, Experiment& experiment) {
  experiment.patch.pixels =
      static_cast<std::size_t>(table.integer("patch_pixels", 32, 1024, std::int64_t(experiment.patch.pixels)));
  experiment.patch.subsamples =
      static_cast<std::size_t>(table.integer("subsamples", 2, 16, std::int64_t(experiment.patch.subsamples)));
  experiment.print.base_layers =
      static_cast<std::size_t>(table.integer("base_layers", 1, 1000, std::int64_t(experiment.print.base_layers)));
  experiment.print.margin_pixels =
      static_cast<std::size_t>(table.integer("margin_pixels", 2, 1000, std::int64_t(experiment.print.margin_pixels)));
  table.finish();
  const std::size_t side = experiment.patch.pixels + 2 * experiment.print.margin_pixels;
  if (side > experiment.printer.pixels_x || side > experiment.printer.pixels_y) {
    table.complain("patch_pixels", "the patch and its margin need " + std::to_string(side) +
                                       " pixels a side; the printer has " +
                                       std::to_string(experiment.printer.pixels_x) + " × " +
                                       std::to_string(experiment.printer.pixels_y));
  }
}

VirtualProfilometer read_measurement(TomlTable table) {
  VirtualProfilometer instrument;
  const auto um = [&](std::string_view key, Range range, Length fallback) {
    return Length::from_um(table.number(key, range, fallback.um()));
  };
  instrument.pitch = um("pitch_um", {0.1, 100.0}, instrument.pitch);
  instrument.shift_x = um("shift_x_um", {-1e4, 1e4}, Length::from_um(11.3));
  instrument.shift_y = um("shift_y_um", {-1e4, 1e4}, Length::from_um(-7.9));
  instrument.rotation = Angle::from_degrees(table.number("rotation_deg", {-5.0, 5.0}, 0.7));
  instrument.tilt_x = table.number("tilt_x", {-0.1, 0.1}, 0.002);
  instrument.tilt_y = table.number("tilt_y", {-0.1, 0.1}, -0.001);
  instrument.noise = Length::from_nm(table.number("noise_nm", {0.0, 1e4}, 10.0));
  instrument.missing_share = table.number("missing_share", {0.0, 0.05}, 0.001);
  instrument.seed = static_cast<std::uint64_t>(table.integer("seed", 0, INT64_MAX, 1));
  table.finish();
  return instrument;
}

// What would come to grief at the end of a long run, found at its beginning.
void require_feasible(const TomlTable& print, const TomlTable& measurement, const Experiment& experiment) {
  const double side = static_cast<double>(experiment.patch.pixels * experiment.patch.subsamples);
  const double gib = static_cast<double>(experiment.search.draws) * side * side * sizeof(float) / (1U << 30U);
  if (gib > 4.0) {
    print.complain("subsamples", fmt::format("{} draws of {} × {} samples need {:.0f} GiB; take fewer draws, pixels or "
                                             "subsamples (4 GiB at most)",
                                             experiment.search.draws, side, side, gib));
  }
  const double width_um = static_cast<double>(experiment.patch.pixels) * experiment.printer.pixel_pitch.um();
  const double samples = width_um / experiment.measurement.pitch.um();
  if (samples < 32.0 || samples > 8192.0) {
    measurement.complain("pitch_um", fmt::format("the patch of {:.0f} µm has {:.0f} samples a side at this pitch; it "
                                                 "must be 32 to 8192",
                                                 width_um, samples));
  }
  for (const auto& [key, shift] : {std::pair{"shift_x_um", experiment.measurement.shift_x},
                                   std::pair{"shift_y_um", experiment.measurement.shift_y}}) {
    if (std::abs(shift.um()) > width_um / 4.0) {
      measurement.complain(key, fmt::format("too much of the patch of {:.0f} µm would be out of sight; \"{}\" can be "
                                            "a quarter of that",
                                            width_um, key));
    }
  }
}

}  // namespace

Experiment read_experiment(const std::filesystem::path& path, const std::vector<std::string>& settings) {
  const TomlFile file(path, settings);
  TomlTable root(file);
  Experiment experiment;
  experiment.file = path;
  experiment.name = path.stem().string();
  experiment.canonical_text = file.canonical_text();
  experiment.title = root.text("title", experiment.name);
  if (!root.has("target")) root.complain("target", "an experiment needs a [target] table");
  experiment.target = read_target(root.table("target"));
  experiment.printer = read_printer_table(root.table("printer"));
  experiment.pattern = read_pattern(root.table("pattern"), root.has("pattern"), PatternUse::Search);
  experiment.simulation = read_simulation(root.table("simulation"));
  experiment.patch.wavelength = experiment.simulation.wavelength;
  experiment.search = read_search(root.table("search"), experiment.target.kind != "anisotropy");
  read_print(root.table("print"), experiment);
  experiment.measurement = read_measurement(root.table("measurement"));
  root.finish();
  require_feasible(root.table("print"), root.table("measurement"), experiment);
  if (experiment.pattern.free.empty() && !experiment.pattern.free_form) {
    root.complain("pattern",
                  "no parameter of the pattern is free; a search needs one, like scale_um = { free = [30.2, 400.0] }");
  }
  return experiment;
}

}  // namespace mezzotint
