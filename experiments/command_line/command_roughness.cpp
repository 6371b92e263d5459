#include <cmath>
#include <optional>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "experiments/command_line/command.h"
#include "experiments/command_line/option_checks.h"
#include "experiments/command_line/surface_arguments.h"
#include "experiments/texture/texture_page.h"
#include "experiments/version.h"

namespace mezzotint {

namespace {

struct Arguments : SurfaceArguments {
  std::string level = "plane", report;
  double s_filter = 0.0, l_filter = 0.0, lambda_s = 0.0, lambda_c = 0.0;
  std::vector<double> profile;
};

TextureRequest request_of(const Arguments& arguments) {
  TextureRequest request{.levelled = arguments.level == "plane",
                         .s_filter = Length::from_um(arguments.s_filter),
                         .l_filter = Length::from_um(arguments.l_filter),
                         .line = {},
                         .profile_filter = {Length::from_um(arguments.lambda_s), Length::from_um(arguments.lambda_c)}};
  const auto& p = arguments.profile;
  if (!p.empty()) request.line = TextureRequest::Line{{p[0], p[1]}, {p[2], p[3]}};
  return request;
}

void append(std::string& text, const std::vector<TextureParameter>& parameters) {
  for (const auto& [symbol, name, q, hangs] : parameters) {
    const bool known = q.standard_error && std::isfinite(*q.standard_error);
    const std::string error = known ? fmt::format(" ± {:.2g}", *q.standard_error) : "";
    const std::string value = std::isfinite(q.value) ? fmt::format("{:.6g}", q.value) : "undefined";
    text += fmt::format("{:<20} {:>12}{} {}\n", symbol, value, error, q.unit == "1" ? "" : q.unit);
  }
}

std::string in_words(const TextureFindings& found, const SurfaceFile& surface) {
  std::string text;
  append(text, areal_parameters(found));
  append(text, profile_parameters(found));
  for (const std::string& note : found.notes) text += note + "\n";
  text += fmt::format("{} samples, {} of them missing", found.field.grid().size(), found.field.missing_count());
  return surface.assumption.empty() ? text : text + "\nassumed: " + surface.assumption;
}

void write_page(const Arguments& arguments, const TextureFindings& found, const TextureRequest& request,
                const SurfaceFile& surface) {
  if (arguments.report.empty()) return;
  TextureSource source{std::filesystem::path(arguments.input).filename().string(), surface.format, surface.title,
                       surface.assumption, surface.provenance};
  source.provenance["program"] = std::string("mezzotint ") + program_version;
  write_report(texture_page(found, request, source), arguments.report);
}

void add_arguments(CLI::App& app, Arguments& arguments) {
  add_surface_input(app, "SCAN", arguments);
  app.add_option("--level", arguments.level, "plane (default) or none")->check(CLI::IsMember({"plane", "none"}));
  const auto wavelength = [&app](const char* name, double& value, const char* help) {
    return app.add_option(name, value, help)->check(in_range(1e-3, 1e6));
  };
  wavelength("--s-filter", arguments.s_filter, "Remove wavelengths shorter than this, in um (ISO 16610-61)");
  wavelength("--l-filter", arguments.l_filter, "Remove wavelengths longer than this, in um");
  auto* profile = app.add_option("--profile", arguments.profile, "X0,Y0,X1,Y1 in um: parameters along this line too")
                      ->delimiter(',')
                      ->expected(4);
  wavelength("--lambda-s", arguments.lambda_s, "Of the profile: remove shorter wavelengths, in um")->needs(profile);
  wavelength("--lambda-c", arguments.lambda_c, "Of the profile: roughness is shorter than this, in um")->needs(profile);
  app.add_option("--report", arguments.report,
                 "HTML page to write too: relief, heights, material ratio, spectrum, autocorrelation, slopes, profile, "
                 "parameters");
}

}  // namespace

Command add_roughness(CLI::App& program) {
  auto* app = program.add_subcommand(
      "roughness", "Areal parameters of ISO 25178-2 and profile parameters, each with its standard error");
  auto arguments = std::make_shared<Arguments>();
  add_arguments(*app, *arguments);
  return {app, [arguments](const CommandContext& context) {
            if (!arguments->report.empty()) require_folder_of(arguments->report);
            const SurfaceFile surface = arguments->read();
            const TextureRequest request = request_of(*arguments);
            const TextureFindings found = texture_of(surface.field, request, context.progress);
            write_page(*arguments, found, request, surface);
            nlohmann::ordered_json json = texture_json(found, request);
            json["assumption"] = surface.assumption;
            if (!arguments->report.empty()) json["report"] = arguments->report;
            context.print(json, in_words(found, surface));
            return ExitStatus::Done;
          }};
}

}  // namespace mezzotint
