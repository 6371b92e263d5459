#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

#include "tests/loop/program.h"
#include "tests/test_data.h"

namespace mezzotint::test {

/// Files by their path within a folder, with their bytes.
using Files = std::map<std::string, std::string>;

/// An empty folder to work in, but for small inputs:
///   small.toml    an experiment whose whole loop takes about a second, and whose target can be met
///   pattern.toml  a pattern of 64 × 64 samples
///   printer.toml  the slides' printer
class Workplace {
public:
  Workplace();

  /// Runs `mezzotint ARGUMENTS` here, to its end.
  [[nodiscard]] Ending mezzotint(const std::vector<std::string>& arguments, const Conditions& conditions = {}) const;
  void write(const char* name, std::string_view text) const;
  [[nodiscard]] std::string read(const char* name) const;
  [[nodiscard]] nlohmann::json read_json(const char* name) const;
  /// Every file of a folder and of the folders in it, temporary ones too.
  [[nodiscard]] Files files(const char* folder = ".") const;
  [[nodiscard]] std::filesystem::path operator/(const char* name) const { return folder_ / name; }
  [[nodiscard]] const std::filesystem::path& path() const { return folder_.path(); }

private:
  TemporaryFolder folder_;
};

/// The text of small.toml with a part of it replaced; the part must be there.
[[nodiscard]] std::string small_experiment(std::string_view part = "", std::string_view by = "");

/// Names of the files that differ between two runs or that one of them lacks, but for timing.json; "" for none.
[[nodiscard]] std::string differences(Files a, Files b);

/// A line of arguments, split at its spaces.
[[nodiscard]] std::vector<std::string> words(const std::string& line);

}  // namespace mezzotint::test
