#pragma once

#include <cstdint>
#include <vector>

#include "fabrication/projector/dlpc900_image.h"

namespace mezzotint::dlpc900 {

/// Words of the run-length code of one flavour, appended to `bytes`. A pixel is three bytes.
class RunLengthWords {
public:
  RunLengthWords(std::vector<std::uint8_t>& bytes, bool enhanced)
      : bytes_(bytes), start_(bytes.size()), enhanced_(enhanced) {}

  [[nodiscard]] std::size_t longest() const { return enhanced_ ? 0x7fff : 255; }

  void repeat(std::size_t count, const std::uint8_t* pixel);
  /// One raw pixel is a run of one: "0 1" means something else.
  void raw(std::size_t count, const std::uint8_t* pixels);
  /// Enhanced alone.
  void copy_from_above(std::size_t count);
  void end_line();
  void end_image();

private:
  void length(std::size_t count);
  void fill_up(std::size_t multiple);

  std::vector<std::uint8_t>& bytes_;
  std::size_t start_;
  bool enhanced_;
};

/// The pixels of an image in the run-length code, without a header.
void append_run_lengths(std::vector<std::uint8_t>& bytes, const PackedImage& image, bool enhanced);

}  // namespace mezzotint::dlpc900
