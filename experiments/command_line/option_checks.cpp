#include "experiments/command_line/option_checks.h"

#include <filesystem>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "forward/base/error.h"

namespace mezzotint {

std::function<std::string(const std::string&)> in_range(double low, double high) {
  return [low, high](const std::string& text) {
    double value = 0.0;
    const bool is_inside = CLI::detail::lexical_cast(text, value) && value >= low && value <= high;
    return is_inside ? std::string() : fmt::format("{} is no number from {:g} to {:g}", text, low, high);
  };
}

void require_folder_of(const std::string& file) {
  const std::filesystem::path path(file), folder = path.has_parent_path() ? path.parent_path() : ".";
  std::error_code ignored;
  if (!std::filesystem::is_directory(folder, ignored)) {
    throw DeviceError("cannot write " + file + ": there is no folder " + folder.string());
  }
  if (std::filesystem::is_directory(path, ignored)) throw DeviceError("cannot write " + file + ": it is a folder");
}

}  // namespace mezzotint
