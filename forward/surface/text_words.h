#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>

/// Inside of forward/surface.

namespace mezzotint {

/// A text file line by line and word by word, as the text formats of meshes have it.
class TextWords {
public:
  explicit TextWords(std::span<const std::byte> bytes);
  /// Goes to the next line; false at the end. A line that ends in '\' goes on with the next, if `joined`.
  [[nodiscard]] bool next_line(bool joined = false);
  /// The next word of the line; empty at its end.
  [[nodiscard]] std::string_view word();
  /// The next word of the text, on whatever line; empty at the end of the text.
  [[nodiscard]] std::string_view word_of_text();
  /// "line 7"
  [[nodiscard]] std::string place() const { return "line " + std::to_string(line_number_); }
  /// What is left of the line.
  [[nodiscard]] std::string_view rest() const { return line_; }
  /// Bytes from the beginning of the text to the end of the current line.
  [[nodiscard]] std::size_t end_of_line() const { return position_; }

private:
  std::string_view text_;
  std::string_view line_;
  std::string joined_;
  std::size_t position_ = 0;
  std::size_t line_number_ = 0;
};

/// The whole word as a number; nothing else. NaN and infinity are numbers here.
[[nodiscard]] std::optional<double> real_in(std::string_view word);
[[nodiscard]] std::optional<long long> integer_in(std::string_view word);

}  // namespace mezzotint
