#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "forward/base/quantity.h"
#include "forward/optics/bsdf.h"

namespace mezzotint {

/// How a stated tolerance fared; Information where none was stated.
enum class Outcome { Met, Missed, Information };

/// The sentence at the top of the page.
struct Verdict {
  Outcome outcome = Outcome::Information;
  std::string sentence;
};

/// One number of the strip under the title.
struct KeyFigure {
  std::string name;  ///< "Slope error", "albedo"
  Quantity quantity;
  std::optional<double> at_most;  ///< the tolerance, in the quantity's unit; shown, never judged here
  Outcome outcome = Outcome::Information;
  std::string note;  ///< a few words below the number; may be empty
};

enum class MessageLevel { Note, Warning, Error };

/// Something that the reader must know before believing the numbers.
struct Message {
  MessageLevel level = MessageLevel::Note;
  std::string text;
};

/// A heading, a lead text and components (see components.h and charts.h).
struct Section {
  std::string title;
  std::string text;  ///< paragraphs separated by blank lines; `code`, *emphasis*, **strong**; nothing else is markup
  std::vector<nlohmann::json> components;
};

/// The page of a run: one HTML file that opens from disk, in light and dark, without a network.
///
/// Units    every number carries its own; text is UTF-8, and no text can become markup.
/// Missing  a value that is not finite is written as null, and shown as a dash.
struct Report {
  std::string title;
  std::string subtitle;
  Verdict verdict;
  std::vector<KeyFigure> key_figures;
  std::vector<Message> messages;
  std::vector<Section> sections;
  Provenance provenance;
};

/// What stands in the page as JSON (element "report-data"): {"format": "mezzotint-report", "version": 1, …}.
/// Arrays of numbers that several components share are stored once, under "arrays".
/// @throws InvalidInput for a report or a section without a title.
[[nodiscard]] nlohmann::json to_report_json(const Report& report);

/// Writes the page; aside, then renamed.
/// @throws InvalidInput as `to_report_json`
/// @throws DeviceError where it cannot be written.
void write_report(const Report& report, const std::filesystem::path& path);

/// "met", "missed", "information".
[[nodiscard]] std::string to_string(Outcome outcome);

}  // namespace mezzotint
