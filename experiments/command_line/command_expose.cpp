#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "experiments/command_line/command.h"
#include "experiments/command_line/json_words.h"
#include "experiments/command_line/option_checks.h"
#include "experiments/configuration/pattern_table.h"
#include "experiments/configuration/printer_file.h"
#include "experiments/run/gray_file.h"
#include "forward/base/quantity.h"
#include "forward/process/proximity_correction.h"
#include "measurement/formats/surface_file.h"

namespace mezzotint {

namespace {

using Json = nlohmann::ordered_json;

struct ExposeArguments {
  std::string pattern, output, printer, residual, surround = "dark";
  std::vector<std::string> settings;
  std::vector<int> pixels;
  std::size_t subsamples = 4, steps = 40;
  bool correct = false;
};

void add_options(CLI::App& app, ExposeArguments& arguments) {
  app.add_option("PATTERN", arguments.pattern, "Pattern file (TOML); examples under experiments/patterns")->required();
  app.add_option("--output,-o", arguments.output, "Gray picture to write (.png), white is full light")->required();
  app.add_option("--printer", arguments.printer, "Printer profile (TOML; default: the slides' printer)");
  app.add_option("--pixels", arguments.pixels, "W,H: pixels of the picture (default: as large as the pattern's grid)")
      ->delimiter(',')
      ->expected(2)
      ->check(CLI::Range(1, 16384));
  app.add_flag("--proximity-correction", arguments.correct,
               "Gray whose print, with the projector's blur, comes closest to the pattern");
  app.add_option("--steps", arguments.steps, "Of the correction, at most (default 40)")->check(CLI::Range(1, 1000));
  app.add_option("--residual", arguments.residual,
                 "What the correction cannot reach: RMS error of every pixel in um, negative where too low (.gwy)");
  app.add_option("--subsamples", arguments.subsamples, "Heights that count, a pixel and axis (default 4)")
      ->check(CLI::Range(1, 16));
  app.add_option("--surround", arguments.surround, "Beyond the picture: dark, repeat or mirror (default dark)")
      ->check(CLI::IsMember({"dark", "repeat", "mirror"}));
  app.add_option("--set", arguments.settings, "Change a setting: --set pattern.scale_um=80")->allow_extra_args(false);
}

Surround surround_of(const std::string& name) {
  if (name == "dark") return Surround::Dark;
  return name == "repeat" ? Surround::Repeat : Surround::Mirror;
}

// A pattern over a printer's pixels, lifted so that its top is the top of what one layer reaches, as in a run.
struct Wanted {
  Pattern pattern;
  PrinterProfile printer;
  std::size_t columns, rows;
  Length lift;

  [[nodiscard]] HeightField sampled(std::size_t samples, double place_x, double place_y) const {
    const Length pitch = printer.pixel_pitch / static_cast<double>(samples);
    HeightField heights =
        synthesize(pattern, {columns * samples, rows * samples, pitch, pitch}, {pitch * place_x, pitch * place_y});
    for (float& z : heights.heights_um()) z += static_cast<float>(lift.um());
    return heights;
  }
};

Wanted read_wanted(const ExposeArguments& arguments) {
  const PatternFile file = read_pattern_file(arguments.pattern, arguments.settings);
  Wanted wanted{file.pattern, arguments.printer.empty() ? PrinterProfile{} : read_printer(arguments.printer), 0, 0, {}};
  const auto pixels = [&](std::size_t axis, std::size_t samples, Length pitch) {
    if (!arguments.pixels.empty()) return static_cast<std::size_t>(arguments.pixels[axis]);
    const double count = static_cast<double>(samples) * pitch.um() / wanted.printer.pixel_pitch.um();
    return static_cast<std::size_t>(std::max(1.0, std::floor(count + 1e-6)));
  };
  wanted.columns = pixels(0, file.grid.columns, file.grid.pitch_x);
  wanted.rows = pixels(1, file.grid.rows, file.grid.pitch_y);
  wanted.lift = std::max(Length{}, reachable_height(wanted.printer) - height_of(wanted.pattern));
  return wanted;
}

// RMS of printed − wanted at sub-pixel positions that no correction sees: 5 × 5 a pixel, moved. Without the outermost
// pixels, where the surround stands in for the pattern.
Length fresh_error(const GrayImage& image, const Wanted& wanted, Surround surround) {
  const ProcessOptions fresh{.subsamples = 5, .surround = surround, .place_x = 0.21, .place_y = 0.83};
  const HeightField printed = print_layer(image, wanted.printer, fresh),
                    ideal = wanted.sampled(fresh.subsamples, fresh.place_x, fresh.place_y);
  const std::size_t border = std::min<std::size_t>(4 * fresh.subsamples, std::min(ideal.columns(), ideal.rows()) / 4);
  double squares = 0.0, count = 0.0;
  for (std::size_t r = border; r < ideal.rows() - border; ++r) {
    for (std::size_t c = border; c < ideal.columns() - border; ++c, ++count) {
      const double error = static_cast<double>(printed.at(c, r)) - static_cast<double>(ideal.at(c, r));
      squares += error * error;
    }
  }
  return Length::from_um(std::sqrt(squares / count));
}

Json corrected(const ExposeArguments& arguments, const Wanted& wanted, GrayImage& image) {
  const Surround surround = surround_of(arguments.surround);
  const ProximityCorrection correction =
      correct_proximity(wanted.sampled(arguments.subsamples, 0.5, 0.5), wanted.printer,
                        {.subsamples = arguments.subsamples, .surround = surround}, {.steps = arguments.steps});
  image = correction.image;
  const auto counts = correction.counts();
  if (!arguments.residual.empty()) {
    const Length pitch = wanted.printer.pixel_pitch;
    write_gwy(HeightField({wanted.columns, wanted.rows, pitch, pitch}, Continuation::Mirrored, correction.residual_um),
              "residual of the proximity correction", {}, arguments.residual);
  }
  return {{"error_after", Quantity{fresh_error(image, wanted, surround).um(), "µm", {}}},
          {"needs_more_light", counts[1]},
          {"too_much_light", counts[2]},
          {"finer_than_blur", counts[3]}};
}

ExitStatus expose_pattern(const ExposeArguments& arguments, const CommandContext& context) {
  require(arguments.residual.empty() || arguments.correct,
          "--residual is a map of --proximity-correction; ask for both");
  require_folder_of(arguments.output);
  const Wanted wanted = read_wanted(arguments);
  const Exposure exposure = expose(wanted.sampled(1, 0.5, 0.5), wanted.printer);
  GrayImage image = quantize(exposure.image, wanted.printer);
  Json json = {{"written", arguments.output},
               {"columns", wanted.columns},
               {"rows", wanted.rows},
               {"lift", Quantity{wanted.lift.um(), "µm", {}}},
               {"saturated_pixels", exposure.saturated},
               {"error", Quantity{fresh_error(image, wanted, surround_of(arguments.surround)).um(), "µm", {}}}};
  if (arguments.correct) {
    report(context.progress, "correction", 0.0, "finding gray values");
    json["proximity_correction"] = corrected(arguments, wanted, image);
  }
  json["levels_used"] = write_gray_png(image, wanted.printer.gray_levels, arguments.output).levels_used;
  context.print(json, in_words(json));
  return ExitStatus::Done;
}

}  // namespace

Command add_expose(CLI::App& program) {
  auto* app = program.add_subcommand("expose",
                                     "A pattern to the gray picture of one layer, through the printer's inverse cure "
                                     "curve, with the error of its print "
                                     "at sub-pixel positions");
  auto arguments = std::make_shared<ExposeArguments>();
  add_options(*app, *arguments);
  return {app, [arguments](const CommandContext& context) { return expose_pattern(*arguments, context); }};
}

}  // namespace mezzotint
