#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include "measurement/formats/surface_file.h"

namespace CLI {
class App;
}

namespace mezzotint {

/// The surface that a command reads, and how.
struct SurfaceArguments {
  std::string input;
  int min_quality = 0;  ///< 0: not asked for

  [[nodiscard]] SurfaceFile read() const;
};

/// The file as a positional argument, and --min-quality.
/// @param besides  what else the command takes for it, for the help text
void add_surface_input(CLI::App& app, const char* name, SurfaceArguments& arguments, const char* besides = "");

/// {"columns", "rows", "pitch_x", "pitch_y", "missing", "missing_share"}: what was written, for --json.
[[nodiscard]] nlohmann::ordered_json contents(const HeightField& field);

}  // namespace mezzotint
