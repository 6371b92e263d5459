#include "fabrication/calibration/cure_table.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>

#include <fmt/format.h>

#include "forward/base/error.h"
#include "forward/base/file_input.h"
#include "measurement/formats/text_scanner.h"
#include "measurement/formats/text_values.h"

namespace mezzotint {

namespace {

enum class Meaning { Gray, Level, Height, Exposure, StandardError, Deviation, Repeats };

struct Column {
  Meaning meaning;
  double factor;  ///< from the column's unit to µm or s
};

struct Name {
  std::string_view name;
  Meaning meaning;
  bool has_length = false, has_time = false;
};
constexpr std::array names{Name{"gray", Meaning::Gray},
                           Name{"grey", Meaning::Gray},
                           Name{"gray_value", Meaning::Gray},
                           Name{"level", Meaning::Level},
                           Name{"gray_level", Meaning::Level},
                           Name{"grey_level", Meaning::Level},
                           Name{"gray_255", Meaning::Level},
                           Name{"height", Meaning::Height, true},
                           Name{"exposure", Meaning::Exposure, false, true},
                           Name{"exposure_time", Meaning::Exposure, false, true},
                           Name{"standard_error", Meaning::StandardError, true},
                           Name{"height_standard_error", Meaning::StandardError, true},
                           Name{"error", Meaning::StandardError, true},
                           Name{"se", Meaning::StandardError, true},
                           Name{"standard_deviation", Meaning::Deviation, true},
                           Name{"sd", Meaning::Deviation, true},
                           Name{"repeats", Meaning::Repeats},
                           Name{"n", Meaning::Repeats}};

constexpr std::string_view expected =
    "height_um, gray (or level), and if known exposure_s, standard_error_um, standard_deviation_um, repeats";

// "Height [µm]" to "height_um".
std::string plain_name(std::string_view cell) {
  std::string text = utf8_or_latin1(trimmed(cell)), plain;
  if (text.size() >= 2 && text.front() == '"' && text.back() == '"') text = text.substr(1, text.size() - 2);
  for (const std::string_view micro : {"µ", "μ"}) {
    for (std::size_t at = text.find(micro); at != std::string::npos; at = text.find(micro))
      text.replace(at, micro.size(), "u");
  }
  for (const char c : text) {
    const bool is_gap = c == ' ' || c == '-' || c == '_' || c == '/' || c == '[' || c == '(' || c == ']' || c == ')';
    if (!is_gap)
      plain += static_cast<char>(c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c);
    else if (!plain.empty() && plain.back() != '_')
      plain += '_';
  }
  while (!plain.empty() && plain.back() == '_') plain.pop_back();
  return plain;
}

// The unit that ends a name, taken off it: µm and s are 1.
std::optional<double> take_unit(std::string& name, const std::map<std::string, double>& units) {
  const std::size_t at = name.rfind('_');
  if (at == std::string::npos) return {};
  const auto found = units.find(name.substr(at + 1));
  if (found == units.end()) return {};
  name.resize(at);
  return found->second;
}

const Name* known_name(std::string_view name) {
  const auto* found = std::find_if(names.begin(), names.end(), [&](const Name& known) { return known.name == name; });
  return found == names.end() ? nullptr : found;
}

Column column_of(std::string_view cell, const TextScanner& scanner) {
  const std::string whole = plain_name(cell);
  if (const Name* known = known_name(whole)) {
    if (known->has_length)
      scanner.fail(fmt::format("the column \"{0}\" has no unit: name it {0}_um (or _nm, _mm)", whole));
    if (known->has_time) scanner.fail(fmt::format("the column \"{0}\" has no unit: name it {0}_s (or _ms)", whole));
    return {known->meaning, 1.0};
  }
  std::string stem = whole;
  if (const auto length = take_unit(stem, {{"um", 1.0}, {"nm", 1e-3}, {"mm", 1e3}})) {
    const Name* known = known_name(stem);
    if (known != nullptr && known->has_length) return {known->meaning, *length};
  }
  stem = whole;
  if (const auto time = take_unit(stem, {{"s", 1.0}, {"ms", 1e-3}})) {
    const Name* known = known_name(stem);
    if (known != nullptr && known->has_time) return {known->meaning, *time};
  }
  scanner.fail(fmt::format("a column \"{}\" is not known; known are {}", clean_text(trimmed(cell)), expected));
}

class Table {
public:
  Table(TextScanner& scanner, std::string_view header) : scanner_(scanner), separator_(separator_of(header)) {
    while (!trimmed(header).empty()) {
      columns_.push_back(column_of(take_cell(header, separator_), scanner));
      const Meaning last = columns_.back().meaning;
      if (std::count_if(columns_.begin(), columns_.end(), [&](const Column& c) { return c.meaning == last; }) > 1)
        scanner.fail("two columns mean the same");
    }
    if (!has(Meaning::Height)) scanner.fail(fmt::format("there is no column of heights; expected are {}", expected));
    if (has(Meaning::Gray) == has(Meaning::Level))
      scanner.fail("one column of gray values is needed: gray (0 … 1 or 0 … 255) or level (0 … 255)");
    if (has(Meaning::Deviation) && !has(Meaning::Repeats))
      scanner.fail(
          "a standard deviation needs the number of repeats beside it (repeats), or name it standard_error_um");
  }

  [[nodiscard]] bool has(Meaning meaning) const {
    return std::any_of(columns_.begin(), columns_.end(), [&](const Column& c) { return c.meaning == meaning; });
  }

  // One line; none where the step has no height.
  [[nodiscard]] std::optional<CurePoint> take(std::string_view line, double exposure_s) const {
    CurePoint point{.place = fmt::format("line {}", scanner_.line())};
    std::optional<double> deviation;
    for (const Column& column : columns_) {
      if (trimmed(line).empty())
        scanner_.fail(fmt::format("{} cells are needed, as in the line of names", columns_.size()));
      const std::string_view cell = trimmed(take_cell(line, separator_));
      if (column.meaning == Meaning::Height && (cell.empty() || !std::isfinite(to_number(cell).value_or(0.0))))
        return {};
      const std::optional<double> number = to_number(cell);
      if (!number || !std::isfinite(*number))
        scanner_.fail(fmt::format("\"{}\" is no number; a decimal point, no comma, is needed", clean_text(cell)));
      set(point, deviation, column, *number * column.factor, exposure_s);
    }
    if (!trimmed(line).empty())
      scanner_.fail(fmt::format("more than the {} cells of the line of names", columns_.size()));
    if (deviation) point.standard_error_um = *deviation / std::sqrt(point.repeats);
    return point;
  }

private:
  void set(CurePoint& point, std::optional<double>& deviation, const Column& column, double value,
           double exposure_s) const {
    const auto positive = [&](const char* what) {
      if (!(value > 0.0)) scanner_.fail(fmt::format("{} must be positive", what));
      return value;
    };
    switch (column.meaning) {
      case Meaning::Height:
        point.height_um = value;
        return;
      case Meaning::Exposure:
        point.exposure = positive("an exposure") / exposure_s;
        return;
      case Meaning::StandardError:
        point.standard_error_um = positive("a standard error");
        return;
      case Meaning::Deviation:
        deviation = positive("a standard deviation");
        return;
      case Meaning::Repeats:
        point.repeats = positive("the number of repeats");
        return;
      case Meaning::Gray:
      case Meaning::Level:
        if (!(value >= 0.0 && value <= 255.0)) scanner_.fail("a gray value lies between 0 and 1, or 0 and 255");
        point.gray = value;
    }
  }

  TextScanner& scanner_;
  char separator_;
  std::vector<Column> columns_;
};

std::string_view without_comment(std::string_view line) { return trimmed(line.substr(0, line.find('#'))); }

}  // namespace

std::vector<CurePoint> read_cure_table(const std::filesystem::path& path, const CureTableOptions& options) {
  const std::vector<std::byte> bytes = read_file(path);
  TextScanner scanner(path, bytes);
  std::optional<Table> table;
  std::vector<CurePoint> points;
  while (!scanner.at_end()) {
    std::string_view line = scanner.take_line();
    if (scanner.line() == 1 && line.starts_with("\xEF\xBB\xBF")) line.remove_prefix(3);  // a byte order mark
    line = without_comment(line);
    if (line.empty()) continue;
    if (!table)
      table.emplace(scanner, line);
    else if (auto point = table->take(line, options.exposure_s))
      points.push_back(std::move(*point));
  }
  if (points.empty()) scanner.fail("there are no steps; a line of names and a line for each step are expected");
  const bool is_level = table->has(Meaning::Level) ||
                        std::any_of(points.begin(), points.end(), [](const CurePoint& p) { return p.gray > 1.0; });
  if (is_level) {
    for (CurePoint& point : points) point.gray /= 255.0;
  }
  return points;
}

}  // namespace mezzotint
