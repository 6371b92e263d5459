#include <filesystem>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "experiments/command_line/command.h"
#include "experiments/command_line/option_checks.h"
#include "experiments/command_line/surface_arguments.h"
#include "experiments/configuration/pattern_table.h"
#include "forward/base/quantity.h"
#include "measurement/formats/surface_output.h"
#include "measurement/instrument/virtual_profilometer.h"

namespace mezzotint {

namespace {

struct Arguments : SurfaceArguments {
  std::string output;
  double pitch_um = 0.0, bandwidth_um = 0.0, noise_nm = 0.0, dropouts = 0.0, aperture = 0.0, turn_deg = 0.0,
         offset_mm = 0.0;
  std::vector<double> outliers = {0.0, 0.0}, holes = {0.0, 0.0}, tilt = {0.0, 0.0}, shift = {0.0, 0.0};
};

HeightField relief_of(const Arguments& arguments) {
  if (std::filesystem::path(arguments.input).extension() != ".toml") return arguments.read().field;
  const PatternFile file = read_pattern_file(arguments.input);
  return synthesize(file.pattern, file.grid, {}, file.continuation);
}

VirtualProfilometer instrument_of(const Arguments& a, const HeightField& relief, std::int64_t seed) {
  VirtualProfilometer instrument;
  instrument.pitch = a.pitch_um > 0.0 ? Length::from_um(a.pitch_um) : relief.grid().pitch_x;
  instrument.shift_x = Length::from_um(a.shift[0]);
  instrument.shift_y = Length::from_um(a.shift[1]);
  instrument.rotation = Angle::from_degrees(a.turn_deg);
  instrument.tilt_x = a.tilt[0];
  instrument.tilt_y = a.tilt[1];
  instrument.offset = Length::from_mm(a.offset_mm);
  instrument.bandwidth = Length::from_um(a.bandwidth_um);
  instrument.noise = Length::from_nm(a.noise_nm);
  instrument.missing_share = a.dropouts;
  instrument.hole_share = a.holes[0];
  instrument.hole_diameter = Length::from_um(a.holes[1]);
  instrument.outlier_share = a.outliers[0];
  instrument.outlier_size = Length::from_um(a.outliers[1]);
  instrument.aperture = a.aperture;
  if (seed >= 0) instrument.seed = static_cast<std::uint64_t>(seed);
  return instrument;
}

std::string in_words(const VirtualProfilometer& i) {
  return fmt::format(
      "virtual profilometer: pitch {} um, bandwidth {} um, aperture {}, noise {} um, dropouts {}, holes {} of {} um, "
      "outliers {} within {} um, tilt {}, {}, turned by {} degrees, seed {}",
      i.pitch.um(), i.bandwidth.um(), i.aperture, i.noise.um(), i.missing_share, i.hole_share, i.hole_diameter.um(),
      i.outlier_share, i.outlier_size.um(), i.tilt_x, i.tilt_y, i.rotation.degrees(), i.seed);
}

void add_options(CLI::App& app, Arguments& a) {
  const auto number = [&](const char* name, double& value, const char* help, double low, double high) {
    app.add_option(name, value, help)->check(in_range(low, high));
  };
  const auto pair = [&](const char* name, std::vector<double>& values, const char* help, double low, double high) {
    app.add_option(name, values, help)->delimiter(',')->expected(2)->check(in_range(low, high));
  };
  number("--pitch", a.pitch_um, "Spacing of the samples in um (default: the relief's)", 1e-3, 1e5);
  number("--bandwidth", a.bandwidth_um,
         "Wavelength in um of which half of the amplitude passes the optics (default 0: no optics)", 0.0, 1e5);
  number("--aperture", a.aperture,
         "Numerical aperture: nothing is seen beyond its angle, and less that is right short of it (default 0: all "
         "slopes are seen alike)",
         0.0, 1.0);
  number("--noise", a.noise_nm, "Standard deviation of each height in nm (default 0)", 0.0, 1e6);
  pair("--outliers", a.outliers, "SHARE,UM: this share of level samples are spikes within +-UM (default none)", 0.0,
       1e5);
  number("--dropouts", a.dropouts, "Share of level samples that are not seen, one by one (default 0)", 0.0, 0.5);
  pair("--holes", a.holes, "SHARE,UM: this share of the area is not seen, in round holes of UM across (default none)",
       0.0, 1e5);
  pair("--tilt", a.tilt, "X,Y: slope of the sample along either axis (default 0,0)", -1.0, 1.0);
  number("--turn", a.turn_deg, "The sample lies turned counter-clockwise by so many degrees (default 0)", -360.0,
         360.0);
  pair("--shift", a.shift, "X,Y in um: the sample lies shifted (default 0,0)", -1e6, 1e6);
  number("--offset", a.offset_mm, "Height of the relief's zero on the instrument's scale in mm (default 0)", -1e4, 1e4);
}

}  // namespace

Command add_measure(CLI::App& program) {
  auto* app =
      program.add_subcommand("measure", "Measure a relief with the virtual profilometer: a scan of known truth");
  auto arguments = std::make_shared<Arguments>();
  add_surface_input(*app, "RELIEF", *arguments, "; or a pattern file (.toml)");
  app->add_option("--output,-o", arguments->output, fmt::format("Scan to write ({})", written_surface_formats))
      ->required();
  add_options(*app, *arguments);
  return {app, [arguments](const CommandContext& context) {
            report(context.progress, "measure", 0.0, "reading");
            const HeightField relief = relief_of(*arguments);
            const VirtualProfilometer instrument = instrument_of(*arguments, relief, context.common.seed);
            report(context.progress, "measure", 0.2, "measuring");
            const SurfaceFile scan{
                measure_virtually(relief, instrument), "", "scan", {{"instrument", in_words(instrument)}}, ""};
            report(context.progress, "measure", 0.8, "writing");
            write_surface(scan, arguments->output);
            report(context.progress, "measure", 1.0);
            const HeightField& field = scan.field;
            const std::size_t missing = field.missing_count();
            context.print({{"written", arguments->output},
                           {"columns", field.columns()},
                           {"rows", field.rows()},
                           {"pitch", Quantity{instrument.pitch.um(), "µm", {}}},
                           {"missing", missing},
                           {"instrument", in_words(instrument)}},
                          fmt::format("wrote {}: {} x {} samples, {:.3g} % of them missing", arguments->output,
                                      field.columns(), field.rows(),
                                      100.0 * static_cast<double>(missing) / static_cast<double>(field.grid().size())));
            return ExitStatus::Done;
          }};
}

}  // namespace mezzotint
