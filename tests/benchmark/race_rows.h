#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace mezzotint::benchmark {

/// What one method made of one target.
struct RaceRow {
  std::string family;
  int target = 0;
  std::string method;
  double evaluations = 0.0, cpu_seconds = 0.0, wall_seconds = 0.0;
  double cube_root = 0.0, cube_root_error = 0.0;  ///< held-out, traced; with its standard error over the draws
  double l2 = 0.0, l2_error = 0.0;
  double covariance_error = 0.0;  ///< largest relative error of a slope variance
};

/// Adds a line to a file of comma-separated values, with a line of names if it is new.
void append_row(const std::filesystem::path& path, const RaceRow& row);
[[nodiscard]] std::vector<RaceRow> read_rows(const std::filesystem::path& path);

/// A table a family, medians over the targets that all of its methods have run on, and how many times less time the
/// ladder takes than the plain loops.
[[nodiscard]] std::string race_table(const std::vector<RaceRow>& rows);

/// Error against time as a figure: a panel a family.
[[nodiscard]] std::string race_figure(const std::vector<RaceRow>& rows);

}  // namespace mezzotint::benchmark
