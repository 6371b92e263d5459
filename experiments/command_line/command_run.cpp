#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "experiments/command_line/command.h"
#include "experiments/run/run_experiment.h"

namespace mezzotint {

namespace {

struct RunArguments {
  std::string file;
  std::string out;
  std::vector<std::string> settings;
  bool resume = false;
};

Experiment read_with_seed(const RunArguments& arguments, const CommonOptions& common) {
  auto settings = arguments.settings;
  if (common.seed >= 0) settings.push_back("search.seed=" + std::to_string(common.seed));
  return read_experiment(arguments.file, settings);
}

// With --json it stands in the summary.
std::function<void(const std::string&)> teller(const CommandContext& context) {
  return [&context](const std::string& text) {
    if (!context.common.json && !context.common.quiet) context.print({}, text);
  };
}

std::string in_words(const RunOutcome& outcome) {
  return outcome.verdict + "\nreport: " + (outcome.folder / "report.html").string();
}

void add_arguments(CLI::App& app, RunArguments& arguments) {
  app.add_option("EXPERIMENT", arguments.file, "Experiment file (TOML)")->required();
  app.add_option("--out,-o", arguments.out,
                 "Folder for the results (default: runs/NAME); an earlier run in it becomes FOLDER.previous");
  app.add_option("--set", arguments.settings,
                 "Change a setting: --set target.alpha_x=0.3; paths are relative to the working folder")
      ->allow_extra_args(false);
  app.add_flag("--resume", arguments.resume, "Go on after the last finished stage");
}

}  // namespace

Command add_run(CLI::App& program) {
  auto* app = program.add_subcommand("run", "Run an experiment: the whole loop, with a report page");
  auto arguments = std::make_shared<RunArguments>();
  add_arguments(*app, *arguments);
  return {app, [arguments](const CommandContext& context) {
            const Experiment experiment = read_with_seed(*arguments, context.common);
            const std::string folder = arguments->out.empty() ? "runs/" + experiment.name : arguments->out;
            const RunOutcome outcome = run_experiment(
                experiment, {.folder = folder, .resume = arguments->resume, .say = teller(context)}, context.progress);
            context.print(outcome.summary, in_words(outcome));
            return outcome.met ? ExitStatus::Done : ExitStatus::ToleranceMissed;
          }};
}

Command add_design(CLI::App& program) {
  auto* app = program.add_subcommand("design", "Search a design for a target: a run that ends before the print");
  auto arguments = std::make_shared<RunArguments>();
  add_arguments(*app, *arguments);
  return {app, [arguments](const CommandContext& context) {
            const Experiment experiment = read_with_seed(*arguments, context.common);
            const std::string folder = arguments->out.empty() ? "runs/" + experiment.name : arguments->out;
            const RunOutcome outcome = run_experiment(
                experiment,
                {.folder = folder, .resume = arguments->resume, .design_only = true, .say = teller(context)},
                context.progress);
            context.print(outcome.summary, fmt::format("{}\ndesign: {}\npattern: {}", outcome.verdict,
                                                       (outcome.folder / "design.json").string(),
                                                       (outcome.folder / "pattern.toml").string()));
            return outcome.met ? ExitStatus::Done : ExitStatus::ToleranceMissed;
          }};
}

}  // namespace mezzotint
