#pragma once

#include <span>

#include "experiments/command_line/command.h"

namespace mezzotint {

/// The commands of this program; each of the two programs has its own table.
[[nodiscard]] std::span<const AddCommand> command_table();

/// Parses the command line, runs the command, complains where it fails. @return the exit status
int run_program(int count, char** arguments);

}  // namespace mezzotint
