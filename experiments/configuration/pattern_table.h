#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "experiments/configuration/toml_table.h"
#include "forward/pattern/pattern.h"
#include "inverse/design/design.h"
#include "inverse/free_form/free_form.h"

namespace mezzotint {

/// A pattern, and which of its numbers a search may change.
struct PatternSpecification {
  Pattern pattern;
  std::vector<FreeParameter> free;
  std::string reason;  ///< why this kind, where the user left it open
  /// Kind "free_form": every pixel is free, and there is no pattern.
  std::optional<FreeFormOptions> free_form;
};

/// A search draws the seeds of its patterns itself (`[search] seed`); a pattern to synthesize has one of its own.
enum class PatternUse { Search, Synthesis };

/// Reads a `[pattern]` table, with the parts of a composition. Where the table or its kind is left out, stretched noise
/// is taken, and `reason` says why; a parameter that is left out of an experiment keeps its default and is not free,
/// unless the whole table is left out: then all that matter are. What is free in a part has its path before its name
/// (all_parameters).
/// A search may ask for the kind "free_form", with `pixels`, `evaluations`, `traced_corrections` and `algorithm`.
/// @throws ConfigurationError for a whole number that is free, and for any that is where nothing is searched.
[[nodiscard]] PatternSpecification read_pattern(TomlTable table, bool table_is_there, PatternUse use);

/// A pattern and the grid to evaluate it on: the file of `mezzotint synthesize`.
struct PatternFile {
  Pattern pattern;
  Grid grid;
  Continuation continuation = Continuation::Mirrored;
};
/// @throws ConfigurationError
[[nodiscard]] PatternFile read_pattern_file(const std::filesystem::path& path,
                                            const std::vector<std::string>& settings = {});

/// A pattern as the text of such a file.
[[nodiscard]] std::string pattern_file_text(const PatternFile& file, const std::string& comment);

}  // namespace mezzotint
