#include "measurement/formats/text_scanner.h"

#include <limits>

#include <fmt/format.h>

#include "forward/base/error.h"
#include "measurement/formats/text_values.h"

namespace mezzotint {

namespace {

constexpr std::string_view blanks = " \t\r\n";
constexpr std::size_t longest_quotation = 40;

bool is_blank(char c) { return blanks.find(c) != std::string_view::npos; }

}  // namespace

void TextScanner::fail(const std::string& problem) const {
  throw FileError(*path_, "line " + std::to_string(line_), problem);
}

void TextScanner::skip_line_end() {
  const bool pair = rest_.starts_with("\r\n");
  rest_.remove_prefix(pair ? 2 : 1);
  within_line_ = false;
}

std::string_view TextScanner::take_line() {
  if (rest_.empty()) return {};
  if (!within_line_) ++line_;
  const std::string_view line = rest_.substr(0, rest_.find_first_of("\r\n"));
  rest_.remove_prefix(line.size());
  if (!rest_.empty()) skip_line_end();
  return line;
}

std::string_view TextScanner::take_word() {
  while (!rest_.empty() && is_blank(rest_.front())) {
    if (rest_.front() == '\n' || rest_.front() == '\r') {
      if (!within_line_) ++line_;
      skip_line_end();
    } else {
      rest_.remove_prefix(1);
    }
  }
  if (!rest_.empty() && !within_line_) {
    ++line_;
    within_line_ = true;
  }
  const std::string_view word = rest_.substr(0, rest_.find_first_of(blanks));
  rest_.remove_prefix(word.size());
  return word;
}

std::string_view take_cell(std::string_view& line, char separator) {
  if (separator != ' ') {
    const std::size_t end = line.find(separator);
    const std::string_view cell = line.substr(0, end);
    line = end == std::string_view::npos ? std::string_view{} : line.substr(end + 1);
    return trimmed(cell);
  }
  const std::string_view cell = line.substr(0, line.find_first_of(" \t"));
  line.remove_prefix(cell.size());
  line = trimmed(line);
  return cell;
}

char separator_of(std::string_view line) {
  for (const char separator : {';', '\t', ','}) {
    if (line.find(separator) != std::string_view::npos) return separator;
  }
  return ' ';
}

double height_of_cell(std::string_view cell, const TextScanner& scanner) {
  if (cell.empty() || cell == "BAD") return std::numeric_limits<double>::quiet_NaN();
  const auto value = to_number(cell);
  if (!value) {
    scanner.fail(fmt::format("\"{}\" is no number{}", clean_text(cell.substr(0, longest_quotation)),
                             cell.find(',') == std::string_view::npos ? "" : "; a decimal comma is not read"));
  }
  return *value;
}

}  // namespace mezzotint
