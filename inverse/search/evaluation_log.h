#pragma once

#include <cstddef>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <vector>

namespace mezzotint {

/// One evaluation of a search: where, and all that came of it.
struct LoggedEvaluation {
  std::string stage;            ///< of the search
  std::vector<double> values;   ///< of the variables
  std::vector<double> results;  ///< in an order that the stage knows; not finite ones are kept too
};

/// A search's evaluations on disk, a line each (JSON Lines), written as they come. A search that was interrupted is run
/// again from its beginning and gets what it has asked before from here, so that it ends in the same bits: searches are
/// deterministic, and numbers are written so that they are read back exactly.
///
/// Format   the first line names format, program version and a digest of the problem; then {"stage", "values",
///          "results"}; numbers that are not finite are the strings "nan", "inf", "-inf".
/// Errors   FileError for a log of another problem or version, a line that is damaged (the last one may be cut off: it
///          is dropped), a full disk; InvalidInput where the search asks other questions than those in the log.
class EvaluationLog {
public:
  /// Reads what is there, if anything; `digest` stands for everything that decides the search's course.
  EvaluationLog(std::filesystem::path file, const std::string& digest);

  /// The results that the log has for this question, which must be the next one in it; none when it is at its end.
  [[nodiscard]] std::optional<std::vector<double>> replay(const std::string& stage, const std::vector<double>& values);
  /// Only at the log's end.
  void append(const LoggedEvaluation& evaluation);

  /// How many evaluations the log had when it was opened.
  [[nodiscard]] std::size_t found() const { return found_; }
  [[nodiscard]] const std::filesystem::path& file() const { return file_; }

private:
  void read(const std::string& header);

  std::filesystem::path file_;
  std::vector<LoggedEvaluation> earlier_;
  std::size_t next_ = 0, found_ = 0;
  std::ofstream stream_;
};

}  // namespace mezzotint
