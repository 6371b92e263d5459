#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

namespace mezzotint {

/// Walks through a text file once, from front to back: reading n numbers takes time of order n.
///
/// Lines end in LF, CR LF or CR. Numbers are read whatever the locale; a comma is never a decimal point.
/// Errors   FileError with the number of the line.
class TextScanner {
public:
  TextScanner(const std::filesystem::path& path, std::span<const std::byte> bytes)
      : path_(&path), rest_(reinterpret_cast<const char*>(bytes.data()), bytes.size()) {}

  [[nodiscard]] bool at_end() const { return rest_.empty(); }
  [[nodiscard]] std::size_t remaining() const { return rest_.size(); }
  /// Number of the line that was taken last, or that the next word stands in.
  [[nodiscard]] std::size_t line() const { return line_; }

  /// The next line without its end; empty at the end of the text.
  std::string_view take_line();
  /// The next word between white space, also from later lines; empty at the end of the text.
  std::string_view take_word();

  [[noreturn]] void fail(const std::string& problem) const;

private:
  void skip_line_end();

  const std::filesystem::path* path_;
  std::string_view rest_;
  std::size_t line_ = 0;
  bool within_line_ = false;
};

/// Takes the first cell off a line: up to the separator, or to white space where the separator is a blank.
std::string_view take_cell(std::string_view& line, char separator);

/// What separates the numbers of a line: ';', a tab or ',' where there is one (in this order), else a blank.
[[nodiscard]] char separator_of(std::string_view line);

/// A cell as a height: a number, or NaN for a missing one (an empty cell, NaN, "BAD").
/// @throws FileError at the scanner's line for anything else
[[nodiscard]] double height_of_cell(std::string_view cell, const TextScanner& scanner);

}  // namespace mezzotint
