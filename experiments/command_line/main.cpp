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

int become_all_commands(char** arguments) {
  std::error_code problem;
  const std::filesystem::path self = std::filesystem::read_symlink("/proc/self/exe", problem);
  const std::filesystem::path all = self.parent_path() / program_with_all_commands;
  ::execv(all.c_str(), arguments);
  std::fprintf(stderr, "mezzotint: cannot start %s (%s); it belongs beside this program\n", all.c_str(),
               std::strerror(errno));
  return static_cast<int>(ExitStatus::Failed);
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
