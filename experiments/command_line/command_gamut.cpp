#include <charconv>
#include <cmath>
#include <filesystem>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "experiments/command_line/command.h"
#include "experiments/command_line/option_checks.h"
#include "experiments/configuration/printer_file.h"
#include "experiments/gamut/gamut_findings.h"
#include "experiments/gamut/gamut_page.h"
#include "experiments/gamut/gamut_svg.h"
#include "experiments/sweep/ranks.h"
#include "forward/base/file_output.h"

namespace mezzotint {

namespace {

struct Arguments {
  std::string printer, output;
  std::vector<std::string> kinds, targets;
  double wavelength_nm = 550.0, least_pixels = 4.0, longest_um = 400.0;
  std::size_t rays = 13;
};

// "0.3,0.1" to a target; either order, since the steeper axis is x by definition.
Target parse_target(const std::string& text) {
  double values[2] = {};
  const char* at = text.data();
  const char* const end = at + text.size();
  bool good = true;
  for (int i = 0; i < 2 && good; ++i) {
    const auto [rest, error] = std::from_chars(at, end, values[i]);
    good = error == std::errc() && (i == 0 ? rest != end && *rest == ',' : rest == end);
    at = rest + 1;
  }
  require(good, "--target is ALPHA_X,ALPHA_Y, such as 0.3,0.1; \"" + text + "\" is not");
  return beckmann_target({values[0], values[1], {}});
}

struct Request {
  PrinterProfile printer;
  std::vector<Target> targets;
  GamutMapOptions map;
  GamutOptions judge;
};

Request request_of(const Arguments& arguments, std::int64_t seed) {
  Request request{.printer = read_printer(arguments.printer)};
  for (const std::string& text : arguments.targets) request.targets.push_back(parse_target(text));
  if (!arguments.kinds.empty()) request.map.kinds = arguments.kinds;
  request.map.bounds.least_pixels = arguments.least_pixels;
  request.map.bounds.longest = Length::from_um(arguments.longest_um);
  request.map.wavelength = Length::from_nm(arguments.wavelength_nm);
  request.map.rays = arguments.rays;
  if (seed >= 0) request.map.patch.seed = static_cast<std::uint64_t>(seed);
  request.judge.bounds = request.map.bounds;
  request.judge.wavelength = request.map.wavelength;
  request.judge.ask_other_kinds = false;
  request.judge.patch.seed = request.map.patch.seed;
  for (const std::string& kind : request.map.kinds) (void)gamut_kind(kind, request.printer, request.map.bounds);
  return request;
}

std::vector<AskedTarget> judge_all(const Request& request) {
  std::vector<AskedTarget> asked;
  for (const Target& target : request.targets) {
    asked.push_back({alphas_of(target.slopes), {}});
    for (const std::string& kind : request.map.kinds)
      asked.back().verdicts.push_back(judge(target, request.printer, kind, request.judge));
  }
  return asked;
}

// Before the long part: formula and answers cost a moment.
void say_first(const GamutFormula& formula, const std::vector<AskedTarget>& asked, const CommandContext& context) {
  if (context.common.json) return;
  context.print({}, in_words(formula));
  for (const AskedTarget& target : asked) context.print({}, in_words(target));
}

std::vector<std::vector<double>> border_of(const Request& request, const CommandContext& context) {
  const auto bytes = sweep(
      context.ranks, gamut_task_count(request.map),
      [&](std::size_t index) { return bytes_of(run_gamut_task(request.map, request.printer, index)); },
      context.progress, "gamut", [&](std::size_t index) { return gamut_task_name(request.map, index); });
  std::vector<std::vector<double>> rows;
  for (const std::string& row : bytes) rows.push_back(doubles_of(row));
  return rows;
}

void write_all(const GamutFindings& findings, const std::filesystem::path& folder) {
  write_file(folder / "gamut.json", to_json(findings).dump(1) + "\n");
  write_file(folder / "gamut.csv", to_csv(findings.map));
  write_file(folder / "gamut.svg", gamut_svg(findings));
  write_report(gamut_page(findings), folder / "gamut.html");
}

ExitStatus run_gamut(const Arguments& arguments, const CommandContext& context) {
  const Request request = request_of(arguments, context.common.seed);
  const std::filesystem::path folder = arguments.output;
  GamutFindings findings{request.printer, {}, {}};
  if (context.ranks.is_first()) {
    std::error_code failed;
    std::filesystem::create_directories(folder, failed);
    if (failed) throw DeviceError("cannot make the folder " + folder.string() + ": " + failed.message());
    findings.targets = judge_all(request);
    say_first(gamut_formula(request.printer, request.map.wavelength, request.map.bounds), findings.targets, context);
  }
  const auto rows = border_of(request, context);
  if (!context.ranks.is_first()) return ExitStatus::Done;
  findings.map = assemble_gamut(request.map, request.printer, rows);
  write_all(findings, folder);
  nlohmann::ordered_json json = {{"written", folder.string()}, {"formula", to_json(findings.map.formula)}};
  json["targets"] = nlohmann::ordered_json::array();
  bool all_reached = true;
  for (const AskedTarget& target : findings.targets) {
    json["targets"].push_back(to_json(target));
    all_reached = all_reached && target.is_reached();
  }
  context.print(json, "wrote gamut.html, gamut.svg, gamut.json and gamut.csv into " + folder.string());
  return all_reached ? ExitStatus::Done : ExitStatus::ToleranceMissed;
}

void add_arguments(CLI::App& app, Arguments& arguments) {
  app.add_option("PRINTER", arguments.printer, "Printer profile (TOML)")->required();
  app.add_option("--output,-o", arguments.output, "Folder for gamut.html, gamut.svg, gamut.json and gamut.csv")
      ->required();
  app.add_option("--pattern", arguments.kinds,
                 "Kind of pattern, may be repeated: noise, fbm, line_integral_convolution, sinusoid, ridges, "
                 "ridges+sinusoid, ridges+sinusoid+noise (default: all)")
      ->check(CLI::IsMember(gamut_kind_names()));
  app.add_option("--target", arguments.targets,
                 "ALPHA_X,ALPHA_Y to judge, ALPHA_X the steeper; may be repeated; exit status 3 where one cannot be "
                 "printed");
  app.add_option("--wavelength-nm", arguments.wavelength_nm,
                 "Of the light; decides which octaves of the ground are geometry (default 550)")
      ->check(in_range(100.0, 20000.0));
  app.add_option("--least-pixels", arguments.least_pixels, "Shortest wavelength, in pixels (default 4)")
      ->check(in_range(2.0, 1000.0));
  app.add_option("--longest-um", arguments.longest_um, "Longest wavelength, cell or line (default 400)")
      ->check(in_range(1.0, 1e5));
  app.add_option("--rays", arguments.rays, "Ratios at which a border is sought (default 13)")
      ->check(CLI::Range(2, 200));
}

}  // namespace

Command add_gamut(CLI::App& program) {
  auto* app = program.add_subcommand(
      "gamut",
      "What a printer can reach with which pattern: formula, chart, and verdicts on targets; spreads over MPI "
      "ranks");
  auto arguments = std::make_shared<Arguments>();
  add_arguments(*app, *arguments);
  return {app, [arguments](const CommandContext& context) { return run_gamut(*arguments, context); }, true};
}

}  // namespace mezzotint
