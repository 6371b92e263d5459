#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <string_view>

#include "experiments/command_line/program.h"
#include "experiments/command_line/program_names.h"

// The program that a user starts. It has the commands that must start at once, and becomes the program with all
// commands for everything else: that one loads some 250 libraries for pictures of all formats, which alone takes 0.2 s
// and 140 MB, more than a part takes to be sliced.

namespace mezzotint {

namespace {

constexpr std::string_view own_commands[] = {"slice", "job"};

<<<<<<< HEAD
int become_all_commands(char** arguments) {
  std::error_code problem;
  const std::filesystem::path self = std::filesystem::read_symlink("/proc/self/exe", problem);
  const std::filesystem::path all = self.parent_path() / program_with_all_commands;
  ::execv(all.c_str(), arguments);
  std::fprintf(stderr, "mezzotint: cannot start %s (%s); it belongs beside this program\n", all.c_str(),
               std::strerror(errno));
  return static_cast<int>(ExitStatus::Failed);
=======
extern "C" void ask_to_stop(int signal) {
  stop_was_asked = 1;
  // A second Ctrl-C ends the program at once.
  std::signal(signal, SIG_DFL);
}

constexpr AddCommand commands[] = {add_run,      add_design,     add_info,       add_convert,     add_measure,
                                   add_correct,  add_roughness,  add_synthesize, add_texture_fit, add_mesh,
                                   add_bsdf,     add_bsdf_table, add_job,        add_print,       add_repair,
                                   add_validate, add_chart,      add_gamut};

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
  for (const AddCommand add : commands) {
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
>>>>>>> part
}

}  // namespace

std::span<const AddCommand> command_table() {
  static constexpr AddCommand commands[] = {add_slice, add_job};
  return commands;
}

}  // namespace mezzotint

int main(int count, char** arguments) {
  using namespace mezzotint;
  const bool is_own = count > 1 && std::find(std::begin(own_commands), std::end(own_commands),
                                             std::string_view(arguments[1])) != std::end(own_commands);
  return is_own ? run_program(count, arguments) : become_all_commands(arguments);
}
