#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string_view>
#include <vector>

#include "measurement/formats/text_scanner.h"
#include "measurement/reflectance/measured_reflectance.h"

/// Inside of measurement/reflectance: what the text formats share.

namespace mezzotint {

/// The words of a line, between white space.
[[nodiscard]] std::vector<std::string_view> words_of(std::string_view line);

/// A word as a finite number.
/// @throws FileError at the scanner's line
[[nodiscard]] double finite_number(std::string_view word, const TextScanner& scanner);

/// A word as a count in [1, most].
[[nodiscard]] std::size_t count_of(std::string_view word, std::string_view what, std::size_t most,
                                   const TextScanner& scanner);

/// Keeps an eye on the samples of a file.
class SampleWatch {
public:
  /// @throws FileError at the scanner's line for a sample that is not finite
  void add(double sample, const TextScanner& scanner);
  /// Noise below 0 is kept, and counted in the provenance.
  /// @throws FileError where a sample lies below −5 % of the largest, or none above 0
  void finish(const std::filesystem::path& path, MeasuredReflectance& into) const;

private:
  double lowest_ = 0.0, largest_ = 0.0;
  std::size_t count_ = 0, negative_ = 0, lowest_line_ = 0;
};

/// Whether the first line that is no comment (no '#' first, not blank) begins with `word`.
[[nodiscard]] bool first_content_begins(std::span<const std::byte> bytes, std::string_view word);

/// "Sample: …", "Light source: …" and their like from comment lines, into the provenance.
void keep_comment(std::string_view line, MeasuredReflectance& into);

}  // namespace mezzotint
