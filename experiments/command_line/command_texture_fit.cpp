#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "experiments/command_line/command.h"
#include "experiments/command_line/option_checks.h"
#include "experiments/command_line/surface_arguments.h"
#include "experiments/configuration/pattern_table.h"
#include "forward/base/file_output.h"
#include "measurement/pattern_fit/pattern_fit.h"

namespace mezzotint {

namespace {

using Json = nlohmann::ordered_json;

struct Arguments : SurfaceArguments {
  std::string output;
  PatternFitOptions options;
};

std::string interval_of(const FittedParameter& found) {
  if (!found.low_95) return "";
  return fmt::format(" ± {:.2g}, 95 %: {:.6g} to {:.6g}", *found.quantity.standard_error, *found.low_95,
                     *found.high_95);
}

// Samples as wide as the scan's; a pattern file has one pitch for both axes.
PatternFile file_of(const PatternFit& fit, const Grid& scan) {
  PatternFile file{fit.pattern, scan};
  file.grid.pitch_y = scan.pitch_x;
  file.grid.rows = static_cast<std::size_t>(
      std::max<long long>(2, std::llround(static_cast<double>(scan.rows) * (scan.pitch_y / scan.pitch_x))));
  return file;
}

std::string comment_of(const PatternFit& fit, const std::string& input) {
  std::string comment = "fitted to " + std::filesystem::path(input).filename().string() + ": " + fit.verdict;
  for (const FittedParameter& found : fit.parameters) {
    if (found.low_95) comment += fmt::format("\n# {} = {:.6g}{}", found.name, found.quantity.value, interval_of(found));
  }
  for (const std::string& note : fit.notes) comment += "\n# " + note;
  return comment;
}

Json json_of(const PatternFit& fit) {
  Json json = {{"fits", fit.fits}, {"verdict", fit.verdict}, {"kind", kind_name(fit.pattern)}};
  for (const FittedParameter& found : fit.parameters) {
    Json quantity = found.quantity;
    if (found.low_95) {
      quantity["low_95"] = *found.low_95;
      quantity["high_95"] = *found.high_95;
    }
    json["parameters"][found.name] = quantity;
  }
  for (const FitTest& test : fit.tests) json["probability"][test.name] = Quantity{test.probability, "1", {}};
  json["white_noise"] = fit.white_noise;
  json["unexplained_share"] = Quantity{fit.unexplained_share, "1", {}};
  json["cells"] = Quantity{fit.cells, "1", {}};
  json["missing_share"] = Quantity{fit.missing_share, "1", {}};
  json["alternatives"] = Json::array();
  for (const FitAlternative& other : fit.alternatives)
    json["alternatives"].push_back({{"pattern", other.what}, {"log_likelihood_lost", other.log_likelihood_lost}});
  json["notes"] = fit.notes;
  return json;
}

std::string in_words(const PatternFit& fit) {
  std::string text = fit.verdict + "\n";
  for (const FittedParameter& found : fit.parameters) {
    text += fmt::format("{:<16} {:>12.6g}{}{}\n", found.name, found.quantity.value,
                        found.quantity.unit == "1" ? "" : " " + found.quantity.unit, interval_of(found));
  }
  const std::optional<double>& error = fit.white_noise.standard_error;
  text += fmt::format("white noise {:.3g}{} um RMS; {:.1f} cells or waves along the shorter side; {:.2g} % missing\n",
                      fit.white_noise.value, error ? fmt::format(" ± {:.2g}", *error) : "", fit.cells,
                      100.0 * fit.missing_share);
  for (const FitTest& test : fit.tests)
    text += fmt::format("as far off in {} are {:.2g} of such patterns\n", test.name, test.probability);
  for (const FitAlternative& other : fit.alternatives)
    text += fmt::format("{}: less likely by exp(-{:.1f})\n", other.what, other.log_likelihood_lost);
  for (const std::string& note : fit.notes) text += note + "\n";
  return text;
}

ExitStatus fit_texture(const Arguments& arguments, const CommandContext& context) {
  require_folder_of(arguments.output);
  const SurfaceFile surface = arguments.read();
  PatternFitOptions options = arguments.options;
  if (context.common.seed >= 0) options.seed = static_cast<std::uint64_t>(context.common.seed);
  const PatternFit fit = fit_pattern(surface.field, options, context.progress);
  Json json = json_of(fit);
  json["false_alarm"] = Quantity{options.false_alarm, "1", {}};
  json["assumption"] = surface.assumption;
  std::vector<std::string> warnings;
  std::string ending;
  if (fit.fits) {
    write_file(arguments.output,
               pattern_file_text(file_of(fit, surface.field.grid()), comment_of(fit, arguments.input)));
    json["written"] = arguments.output;
    ending = "wrote " + arguments.output;
  } else {
    warnings.push_back("nothing was written: the parameters are those of the nearest pattern, which is no fit");
    json["written"] = nullptr;
    ending = "no pattern was written";
  }
  json["warnings"] = warnings;
  context.warn(warnings);
  context.print(json, in_words(fit) + ending);
  return fit.fits ? ExitStatus::Done : ExitStatus::ToleranceMissed;
}

}  // namespace

Command add_texture_fit(CLI::App& program) {
  auto* app = program.add_subcommand(
      "texture-fit", "A relief to the pattern that it may be a draw of, with 95 % intervals; status 3 where none fits");
  auto arguments = std::make_shared<Arguments>();
  add_surface_input(*app, "SCAN", *arguments);
  app->add_option("--output,-o", arguments->output, "Pattern file to write (TOML); not written where nothing fits")
      ->required();
  app->add_option("--kinds", arguments->options.kinds, "Which to try: noise,fbm,sinusoid,ridges (default: all)")
      ->delimiter(',')
      ->check(CLI::IsMember({"noise", "fbm", "sinusoid", "ridges"}));
  app->add_option("--draws", arguments->options.draws,
                  "Reliefs drawn of a fitted noise, for intervals and judgement (default 40)")
      ->check(CLI::Range(24, 1000));
  app->add_option("--false-alarm", arguments->options.false_alarm,
                  "How often a texture that is such a pattern may be sent away (default 0.01)")
      ->check(in_range(1e-6, 0.5));
  return {app, [arguments](const CommandContext& context) { return fit_texture(*arguments, context); }};
}

}  // namespace mezzotint
