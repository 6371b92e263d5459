#include "measurement/reflectance/text_samples.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "forward/base/error.h"
#include "measurement/formats/text_values.h"

namespace mezzotint {

namespace {

constexpr double noise_share = 0.05;
constexpr std::size_t longest_quotation = 40, most_comments = 32;

std::string quoted(std::string_view word) { return "\"" + clean_text(word.substr(0, longest_quotation)) + "\""; }

}  // namespace

std::vector<std::string_view> words_of(std::string_view line) {
  std::vector<std::string_view> words;
  line = trimmed(line);
  while (!line.empty()) words.push_back(take_cell(line, ' '));
  return words;
}

double finite_number(std::string_view word, const TextScanner& scanner) {
  const auto value = to_number(word);
  if (!value) scanner.fail(quoted(word) + " is no number");
  if (!std::isfinite(*value)) scanner.fail(quoted(word) + " is not finite; leave out what was not measured");
  return *value;
}

std::size_t count_of(std::string_view word, std::string_view what, std::size_t most, const TextScanner& scanner) {
  const auto count = to_count(word);
  if (!count || *count == 0 || *count > most)
    scanner.fail(fmt::format("{} is no number of {}; 1 to {} are read", quoted(word), what, most));
  return static_cast<std::size_t>(*count);
}

void SampleWatch::add(double sample, const TextScanner& scanner) {
  if (!std::isfinite(sample) || std::abs(sample) > 1e30) scanner.fail("a sample is not finite, or beyond 1e30");
  ++count_;
  negative_ += sample < 0.0 ? 1 : 0;
  largest_ = std::max(largest_, sample);
  if (sample >= lowest_) return;
  lowest_ = sample;
  lowest_line_ = scanner.line();
}

void SampleWatch::finish(const std::filesystem::path& path, MeasuredReflectance& into) const {
  if (largest_ <= 0.0) throw FileError(path, "", "holds no sample above 0");
  if (lowest_ < -noise_share * largest_) {
    throw FileError(
        path, fmt::format("line {}", lowest_line_),
        fmt::format("holds a sample of {:.6g}; that is below −5 % of the largest, {:.6g}, and no noise about "
                    "0",
                    lowest_, largest_));
  }
  into.provenance["samples"] = std::to_string(count_);
  if (negative_ > 0) into.provenance["negative_samples"] = std::to_string(negative_);
}

bool first_content_begins(std::span<const std::byte> bytes, std::string_view word) {
  std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  while (!text.empty()) {
    const std::string_view line = trimmed(text.substr(0, text.find_first_of("\r\n")));
    if (!line.empty() && line.front() != '#') return line.starts_with(word);
    const auto end = text.find_first_of("\r\n");
    if (end == std::string_view::npos) return false;
    text.remove_prefix(end + 1);
  }
  return false;
}

void keep_comment(std::string_view line, MeasuredReflectance& into) {
  line = trimmed(line);
  while (!line.empty() && line.front() == '#') line.remove_prefix(1);
  line = trimmed(line);
  const auto colon = line.find(": ");
  if (colon == std::string_view::npos || colon == 0 || colon > 60 || into.provenance.size() >= most_comments) return;
  into.provenance.emplace(clean_text(line.substr(0, colon)), clean_text(line.substr(colon + 2)));
}

}  // namespace mezzotint
