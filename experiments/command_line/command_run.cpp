#include <mutex>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "experiments/command_line/command.h"
#include "experiments/run/run_experiment.h"
#include "experiments/sweep/ranks.h"
#include "forward/base/error.h"

namespace mezzotint {

namespace {

struct RunArguments {
  std::string file;
  std::string out;
  std::vector<std::string> settings;
  bool resume = false;
};

Experiment read_with_seed(const std::string& file, std::vector<std::string> settings, const CommonOptions& common) {
  if (common.seed >= 0) settings.push_back("search.seed=" + std::to_string(common.seed));
  return read_experiment(file, settings);
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

struct DesignArguments {
  std::vector<std::string> files;
  std::string out;
  std::vector<std::string> settings;
  bool resume = false;
};

ExitStatus design_one(const DesignArguments& arguments, const CommandContext& context) {
  require(context.ranks.count() == 1,
          "one design does not spread over ranks; start it without mpirun, or name several experiment files");
  const Experiment experiment = read_with_seed(arguments.files.front(), arguments.settings, context.common);
  const std::string folder = arguments.out.empty() ? "runs/" + experiment.name : arguments.out;
  const RunOutcome outcome = run_experiment(
      experiment, {.folder = folder, .resume = arguments.resume, .design_only = true, .say = teller(context)},
      context.progress);
  context.print(outcome.summary,
                fmt::format("{}\ndesign: {}\nreport: {}", outcome.verdict, (outcome.folder / "design.json").string(),
                            (outcome.folder / "report.html").string()));
  return outcome.met ? ExitStatus::Done : ExitStatus::ToleranceMissed;
}

// Files of one name in several folders would write into one.
std::vector<Experiment> read_all(const DesignArguments& arguments, const CommonOptions& common) {
  std::vector<Experiment> experiments;
  for (const std::string& file : arguments.files) {
    experiments.push_back(read_with_seed(file, arguments.settings, common));
    for (std::size_t i = 0; i + 1 < experiments.size(); ++i) {
      require(experiments[i].name != experiments.back().name,
              fmt::format("two experiment files are named \"{}\", and their designs would have one folder",
                          experiments[i].name));
    }
  }
  return experiments;
}

// Tasks come from several threads at once; the display takes one after the other.
ExitStatus design_all(const DesignArguments& arguments, const CommandContext& context) {
  const std::vector<Experiment> experiments = read_all(arguments, context.common);
  const std::filesystem::path folder = arguments.out.empty() ? "runs" : arguments.out;
  std::mutex display;
  const Progress one_by_one = [&](const ProgressEvent& event) {
    const std::lock_guard lock(display);
    context.progress(event);
  };
  const auto design = [&](std::size_t index) {
    const Experiment& experiment = experiments[index];
    const Progress named = [&](const ProgressEvent& event) {
      ProgressEvent own = event;
      own.stage = experiment.name + " " + event.stage;
      one_by_one(own);
    };
    std::string told;
    const RunOutcome outcome = run_experiment(experiment,
                                              {.folder = folder / experiment.name,
                                               .resume = arguments.resume,
                                               .design_only = true,
                                               .say = [&](const std::string& text) { told += text + "\n"; }},
                                              named);
    const nlohmann::ordered_json result = {{"name", experiment.name},
                                           {"folder", outcome.folder.string()},
                                           {"met", outcome.met},
                                           {"verdict", outcome.verdict},
                                           {"told", told}};
    return result.dump();
  };
  const auto results = sweep(context.ranks, experiments.size(), design, one_by_one, "designs");
  if (!context.ranks.is_first()) return ExitStatus::Done;
  nlohmann::ordered_json json = {{"designs", nlohmann::ordered_json::array()}};
  std::string text;
  bool met = true;
  for (const std::string& bytes : results) {
    const auto result = nlohmann::ordered_json::parse(bytes);
    met = met && result.at("met").get<bool>();
    text += fmt::format("{}{}: {}", text.empty() ? "" : "\n", result.at("name").get<std::string>(),
                        result.at("told").get<std::string>() + result.at("verdict").get<std::string>());
    json["designs"].push_back(result);
  }
  context.print(json, text);
  return met ? ExitStatus::Done : ExitStatus::ToleranceMissed;
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
            const Experiment experiment = read_with_seed(arguments->file, arguments->settings, context.common);
            const std::string folder = arguments->out.empty() ? "runs/" + experiment.name : arguments->out;
            const RunOutcome outcome = run_experiment(
                experiment, {.folder = folder, .resume = arguments->resume, .say = teller(context)}, context.progress);
            context.print(outcome.summary, in_words(outcome));
            return outcome.met ? ExitStatus::Done : ExitStatus::ToleranceMissed;
          }};
}

Command add_design(CLI::App& program) {
  auto* app =
      program.add_subcommand("design", "Search a design for a target, or for several; several spread over MPI ranks");
  auto arguments = std::make_shared<DesignArguments>();
  app->add_option("EXPERIMENT", arguments->files, "Experiment files (TOML)")->required();
  app->add_option("--out,-o", arguments->out,
                  "Folder for the design (default: runs/NAME), or of several files for a folder NAME each (default: "
                  "runs); an earlier one becomes FOLDER.previous");
  app->add_option("--set", arguments->settings,
                  "Change a setting: --set target.alpha_x=0.3; paths are relative to the working folder")
      ->allow_extra_args(false);
  app->add_flag("--resume", arguments->resume, "Go on where an interrupted search stopped");
  return {app,
          [arguments](const CommandContext& context) {
            return arguments->files.size() == 1 ? design_one(*arguments, context) : design_all(*arguments, context);
          },
          true};
}

}  // namespace mezzotint
