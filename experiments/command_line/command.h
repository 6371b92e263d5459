#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "forward/base/error.h"
#include "forward/base/progress.h"

namespace CLI {
class App;
}

namespace mezzotint {

class Ranks;

/// What every command takes.
struct CommonOptions {
  bool json = false;  ///< one JSON object on stdout
  bool quiet = false;
  int threads = 0;         ///< 0: all cores
  std::int64_t seed = -1;  ///< −1: the command's or the file's own
};

/// What a command may use while it runs.
struct CommandContext {
  const CommonOptions& common;
  const Progress& progress;
  Ranks& ranks;  ///< the processes that mpirun started; this one alone without it
  /// Prints a result: the JSON object with `--json`, the text otherwise.
  void print(const nlohmann::ordered_json& json, const std::string& text) const;
  /// Says on stderr what must be known before the result is trusted; with `--json` it belongs into the object instead,
  /// as an array "warnings".
  void warn(const std::vector<std::string>& sentences) const;
};

/// A command's work; it returns Done or ToleranceMissed, and throws everything else.
using CommandAction = std::function<ExitStatus(const CommandContext&)>;

/// Adds a command's options to the command line and returns its work. One file a command.
struct Command {
  CLI::App* app = nullptr;
  CommandAction action;
  bool spreads = false;  ///< its work spreads over MPI ranks; the others refuse more than one
};
using AddCommand = Command (*)(CLI::App& program);

Command add_run(CLI::App& program);
Command add_design(CLI::App& program);
Command add_info(CLI::App& program);
Command add_convert(CLI::App& program);
Command add_measure(CLI::App& program);
Command add_correct(CLI::App& program);
Command add_roughness(CLI::App& program);
Command add_synthesize(CLI::App& program);
Command add_texture_fit(CLI::App& program);
Command add_mesh(CLI::App& program);
Command add_expose(CLI::App& program);
Command add_bsdf(CLI::App& program);
Command add_bsdf_table(CLI::App& program);
Command add_slice(CLI::App& program);
Command add_job(CLI::App& program);
Command add_print(CLI::App& program);
Command add_repair(CLI::App& program);
Command add_validate(CLI::App& program);
Command add_chart(CLI::App& program);
Command add_gamut(CLI::App& program);
Command add_calibrate(CLI::App& program);

}  // namespace mezzotint
