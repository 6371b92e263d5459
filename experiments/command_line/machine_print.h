#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "experiments/command_line/command.h"

namespace mezzotint {

/// A print on a machine, real or virtual.
struct MachinePrint {
  std::filesystem::path job;
  std::filesystem::path machine;
  std::filesystem::path journal;  ///< empty: beside the job
  std::string device;             ///< "virtual", "dlpc900"
  std::string uncertain = "stop";
  bool resume = false;
  bool dry_run = false;
  bool force_upload = false;
  double pace = 0.0;  ///< of the virtual machine's time; 0: it takes none
};

/// How it ended.
struct MachinePrintEnd {
  nlohmann::ordered_json json;
  std::string text;
  bool finished = false;
  std::vector<double> lit_s;  ///< light that each layer got
};

/// Prints a job by a session. Ctrl-C finishes the layer and stops, again it cuts the exposure; Ctrl-Z pauses.
[[nodiscard]] MachinePrintEnd print_on_machine(const MachinePrint& print, const CommandContext& context);

}  // namespace mezzotint
