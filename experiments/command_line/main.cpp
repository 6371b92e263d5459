#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <string_view>

#include "experiments/command_line/program.h"
#include "experiments/command_line/program_names.h"
#include "experiments/command_line/slice_appearance.h"

// The program that a user starts. It has the commands that must start at once, and becomes the program with all
// commands for everything else: that one loads some 250 libraries for pictures of all formats, which alone takes 0.2 s
// and 140 MB, more than a part takes to be sliced.

namespace mezzotint {

namespace {

constexpr std::string_view own_commands[] = {"slice", "job", "repair"};

int become_all_commands(char** arguments) {
  std::error_code problem;
  const std::filesystem::path self = std::filesystem::read_symlink("/proc/self/exe", problem);
  const std::filesystem::path all = self.parent_path() / program_with_all_commands;
  ::execv(all.c_str(), arguments);
  std::fprintf(stderr, "mezzotint: cannot start %s (%s); it belongs beside this program\n", all.c_str(),
               std::strerror(errno));
  return static_cast<int>(ExitStatus::Failed);
}

// Under mpirun or srun the other program speaks for all ranks; this one knows nothing of them.
bool is_one_of_many() {
  return std::getenv("OMPI_COMM_WORLD_SIZE") != nullptr || std::getenv("PMI_SIZE") != nullptr ||
         std::getenv("PMIX_RANK") != nullptr;
}

bool is_own(std::string_view command) {
  return std::find(std::begin(own_commands), std::end(own_commands), command) != std::end(own_commands);
}

// An appearance may hold pictures, which the other program alone can read.
bool asks_for_appearance(int count, char** arguments) {
  return std::any_of(arguments, arguments + count, [](std::string_view argument) {
    return std::any_of(std::begin(appearance_options), std::end(appearance_options),
                       [argument](std::string_view option) { return argument.starts_with(option); });
  });
}

}  // namespace

std::span<const AddCommand> command_table() {
  static constexpr AddCommand commands[] = {add_slice, add_job, add_repair};
  return commands;
}

ReadAppearance appearance_reader() { return nullptr; }

}  // namespace mezzotint

int main(int count, char** arguments) {
  using namespace mezzotint;
  const bool own = count > 1 && is_own(arguments[1]) && !is_one_of_many() && !asks_for_appearance(count, arguments);
  return own ? run_program(count, arguments) : become_all_commands(arguments);
}
