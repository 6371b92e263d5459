#include "fabrication/projector/run_length.h"

#include <algorithm>
#include <cstring>

namespace mezzotint::dlpc900 {
namespace {

bool same_pixel(const std::uint8_t* a, const std::uint8_t* b) { return std::memcmp(a, b, 3) == 0; }

/// One line, and the one above where there is one.
struct Line {
  const std::uint8_t* pixels;
  const std::uint8_t* above;
  std::size_t columns;

  [[nodiscard]] std::size_t run_at(std::size_t x) const {
    std::size_t end = x + 1;
    while (end < columns && same_pixel(pixels + 3 * end, pixels + 3 * x)) ++end;
    return end - x;
  }
  [[nodiscard]] std::size_t copy_at(std::size_t x) const {
    if (above == nullptr) return 0;
    std::size_t end = x;
    while (end < columns && same_pixel(pixels + 3 * end, above + 3 * end)) ++end;
    return end - x;
  }
};

// A raw stretch is interrupted where that saves more than the two bytes of a new beginning: a run of three pixels
// takes 4 bytes for 9, a copy of two 3 for 6.
constexpr std::size_t worthy_run = 3;
constexpr std::size_t worthy_copy = 2;

void append_line(RunLengthWords& words, const Line& line) {
  const std::size_t longest = words.longest();
  std::size_t x = 0, raw_from = 0;
  const auto flush_raw = [&] {
    for (; raw_from < x; raw_from += std::min(x - raw_from, longest)) {
      words.raw(std::min(x - raw_from, longest), line.pixels + 3 * raw_from);
    }
  };
  while (x < line.columns) {
    const std::size_t copied = line.copy_at(x), run = line.run_at(x);
    if (copied >= worthy_copy && copied >= run) {
      flush_raw();
      const std::size_t count = std::min(copied, longest);
      words.copy_from_above(count);
      raw_from = x += count;
    } else if (run >= worthy_run) {
      flush_raw();
      const std::size_t count = std::min(run, longest);
      words.repeat(count, line.pixels + 3 * x);
      raw_from = x += count;
    } else {
      ++x;
    }
  }
  flush_raw();
}

}  // namespace

void RunLengthWords::length(std::size_t count) {
  if (!enhanced_ || count < 0x80) {
    bytes_.push_back(static_cast<std::uint8_t>(count));
  } else {
    bytes_.push_back(static_cast<std::uint8_t>((count & 0x7f) | 0x80));
    bytes_.push_back(static_cast<std::uint8_t>(count >> 7));
  }
}

void RunLengthWords::fill_up(std::size_t multiple) {
  while ((bytes_.size() - start_) % multiple != 0) bytes_.push_back(0);
}

void RunLengthWords::repeat(std::size_t count, const std::uint8_t* pixel) {
  length(count);
  bytes_.insert(bytes_.end(), pixel, pixel + 3);
}

void RunLengthWords::raw(std::size_t count, const std::uint8_t* pixels) {
  if (count == 1) return repeat(1, pixels);
  bytes_.push_back(0);
  length(count);
  bytes_.insert(bytes_.end(), pixels, pixels + 3 * count);
}

void RunLengthWords::copy_from_above(std::size_t count) {
  bytes_.push_back(0);
  bytes_.push_back(1);
  length(count);
}

void RunLengthWords::end_line() {
  bytes_.resize(bytes_.size() + 2, 0);
  if (!enhanced_) fill_up(4);
}

void RunLengthWords::end_image() {
  bytes_.push_back(0);
  bytes_.push_back(1);
  if (enhanced_) bytes_.push_back(0);
  fill_up(enhanced_ ? 4 : 16);
}

void append_run_lengths(std::vector<std::uint8_t>& bytes, const PackedImage& image, bool enhanced) {
  RunLengthWords words(bytes, enhanced);
  const std::size_t stride = 3 * image.columns;
  for (std::size_t row = 0; row < image.rows; ++row) {
    const std::uint8_t* pixels = image.bytes.data() + row * stride;
    append_line(words, {pixels, enhanced && row > 0 ? pixels - stride : nullptr, image.columns});
    // The enhanced code knows where lines end; the guide's example separates them, and ends the last with the image.
    if (!enhanced || row + 1 < image.rows) words.end_line();
  }
  words.end_image();
}

}  // namespace mezzotint::dlpc900
