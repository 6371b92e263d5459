#include <algorithm>
#include <csignal>
#include <cstdio>
#include <exception>
#include <iostream>
#include <new>
#include <vector>

#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>
#include <tbb/global_control.h>
#include <tbb/info.h>
#include <CLI/CLI.hpp>

#include "experiments/command_line/program.h"
#include "experiments/configuration/suggestion.h"
#include "experiments/sweep/ranks.h"
#include "experiments/version.h"
#include "forward/base/progress_display.h"

namespace mezzotint {

namespace {

volatile std::sig_atomic_t stop_was_asked = 0;

extern "C" void ask_to_stop(int signal) {
  stop_was_asked = 1;
  // A second Ctrl-C ends the program at once.
  std::signal(signal, SIG_DFL);
}

void add_common_options(CLI::App& app, CommonOptions& common) {
  app.add_flag("--json", common.json, "One JSON object on stdout; progress as JSON lines on stderr");
  app.add_flag("--quiet,-q", common.quiet, "No progress, no notes");
  app.add_option("--threads", common.threads, "Threads to use; results do not depend on it (default: all cores)")
      ->check(CLI::Range(1, 1024));
  app.add_option("--seed", common.seed,
                 "Seed of what the command draws at random, if it does (run, design: search.seed)")
      ->check(CLI::Range(std::int64_t{0}, std::int64_t{1} << 50));
}

ProgressStyle style_of(const CommonOptions& common) {
  if (common.quiet) return ProgressStyle::Quiet;
  return common.json ? ProgressStyle::Events : natural_style(stderr);
}

// CLI11 has no suggestion for a mistyped command.
std::string unknown_command_hint(const CLI::App& program, int count, char** arguments) {
  std::vector<std::string> names;
  for (const auto* command : program.get_subcommands({})) names.push_back(command->get_name());
  for (int i = 1; i < count; ++i) {
    const std::string word = arguments[i];
    if (word.starts_with('-')) continue;
    if (std::find(names.begin(), names.end(), word) != names.end()) return "";
    return "mezzotint: there is no command \"" + word + "\"" + suggest(word, names);
  }
  return "";
}

int complain(const std::string& message, ExitStatus status) {
  spdlog::error("{}", message);
  return static_cast<int>(status);
}

// An error of one rank ends them all. What all ranks complain of, such as a wrong file, the first one says.
int complain_and_stop(Ranks& ranks, const std::string& message, ExitStatus status) {
  ranks.stop_others(message, status);
  return ranks.is_first() ? complain(message, status) : static_cast<int>(status);
}

int run_command(const Command& command, const CommonOptions& common, Ranks& ranks) {
  ProgressDisplay display(ranks.is_first() ? style_of(common) : ProgressStyle::Quiet, stderr);
  const Progress progress = [&](const ProgressEvent& event) {
    if (stop_was_asked != 0) throw Interrupted();
    display.show(event);
  };
  try {
    require(command.spreads || ranks.count() == 1,
            "\"" + command.app->get_name() + "\" does not spread over ranks; start it without mpirun");
    const ExitStatus status = command.action({common, progress, ranks});
    display.finish();
    return static_cast<int>(status);
  } catch (const StoppedByOtherRank& stopped) {
    return static_cast<int>(stopped.status());
  } catch (const Error& error) {
    display.finish();
    return complain_and_stop(ranks, error.what(), error.status());
  } catch (const std::bad_alloc&) {
    display.finish();
    return complain_and_stop(ranks, "out of memory; use a smaller patch, a coarser pitch or fewer bins",
                             ExitStatus::Failed);
  } catch (const std::exception& error) {
    display.finish();
    return complain_and_stop(ranks, std::string("internal error, please report it: ") + error.what(),
                             ExitStatus::Failed);
  }
}

int parse_and_run(int count, char** arguments, Ranks& ranks) {
  CLI::App program{
      "Mezzotint: inverse design of surface microstructure.\n"
      "Measure, simulate, optimise, print, measure again: one loop, one program."};
  program.set_version_flag("--version", std::string("mezzotint ") + program_version);
  program.require_subcommand(1);
  program.footer("Exit status: 0 done, 1 failed, 2 bad usage or input, 3 done but a stated tolerance was not met.");
  CommonOptions common;
  std::vector<Command> added;
  for (const AddCommand add : command_table()) {
    added.push_back(add(program));
    add_common_options(*added.back().app, common);
  }
  try {
    program.parse(count, arguments);
  } catch (const CLI::ParseError& error) {
    if (!ranks.is_first()) return error.get_exit_code() == 0 ? 0 : static_cast<int>(ExitStatus::BadInput);
    if (error.get_exit_code() == 0) {
      program.exit(error);
      return std::cout.flush() ? 0 : complain("cannot write to standard output", ExitStatus::Failed);
    }
    const std::string hint = unknown_command_hint(program, count, arguments);
    if (!hint.empty()) {
      std::fprintf(stderr, "%s\n", hint.c_str());
    } else {
      program.exit(error);
    }
    return static_cast<int>(ExitStatus::BadInput);
  }
  const int cores = common.threads > 0 ? common.threads : tbb::info::default_concurrency();
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(cores));
  for (const Command& command : added) {
    if (command.app->parsed()) return run_command(command, common, ranks);
  }
  return static_cast<int>(ExitStatus::BadInput);
}

}  // namespace

void CommandContext::print(const nlohmann::ordered_json& json, const std::string& text) const {
  if (!ranks.is_first()) return;
  const std::string output = common.json ? json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) : text;
  std::fprintf(stdout, "%s\n", output.c_str());
  if (std::fflush(stdout) != 0) throw DeviceError("cannot write to standard output");
}

void CommandContext::warn(const std::vector<std::string>& sentences) const {
  if (common.json || common.quiet || !ranks.is_first()) return;
  for (const std::string& sentence : sentences) spdlog::warn("{}", sentence);
}

}  // namespace mezzotint

int mezzotint::run_program(int count, char** arguments) {
  std::signal(SIGINT, ask_to_stop);
  std::signal(SIGTERM, ask_to_stop);
  spdlog::set_default_logger(spdlog::stderr_color_mt("mezzotint"));
  spdlog::set_pattern("%^%l%$: %v");
  try {
    Ranks ranks;
    return parse_and_run(count, arguments, ranks);
  } catch (const Error& error) {
    return complain(error.what(), error.status());
  }
}
