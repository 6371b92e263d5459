#include "forward/surface/text_words.h"

#include <charconv>

namespace mezzotint {

namespace {

bool blank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f'; }

template <class Number>
std::optional<Number> number_in(std::string_view word) {
  if (word.starts_with('+')) word.remove_prefix(1);  // from_chars does not know it
  Number value{};
  const auto [end, problem] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (problem != std::errc{} || end != word.data() + word.size()) return std::nullopt;
  return value;
}

}  // namespace

TextWords::TextWords(std::span<const std::byte> bytes)
    : text_(reinterpret_cast<const char*>(bytes.data()), bytes.size()) {}

bool TextWords::next_line(bool joined) {
  joined_.clear();
  for (;;) {
    if (position_ >= text_.size()) {
      line_ = joined_;
      return !joined_.empty();
    }
    const std::size_t end = std::min(text_.find('\n', position_), text_.size());
    line_ = text_.substr(position_, end - position_);
    position_ = std::min(end + 1, text_.size());
    ++line_number_;
    if (line_.ends_with('\r')) line_.remove_suffix(1);
    if (!joined) return true;
    if (!line_.ends_with('\\')) break;
    line_.remove_suffix(1);
    joined_.append(line_).append(" ");
  }
  if (!joined_.empty()) line_ = joined_.append(line_);
  return true;
}

std::string_view TextWords::word() {
  while (!line_.empty() && blank(line_.front())) line_.remove_prefix(1);
  std::size_t length = 0;
  while (length < line_.size() && !blank(line_[length])) ++length;
  const std::string_view found = line_.substr(0, length);
  line_.remove_prefix(length);
  return found;
}

std::string_view TextWords::word_of_text() {
  for (;;) {
    const std::string_view found = word();
    if (!found.empty()) return found;
    if (!next_line()) return {};
  }
}

std::optional<double> real_in(std::string_view word) { return number_in<double>(word); }

std::optional<long long> integer_in(std::string_view word) { return number_in<long long>(word); }

}  // namespace mezzotint
