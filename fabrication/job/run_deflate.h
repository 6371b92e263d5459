#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace mezzotint {

/// Packs bytes that come mostly as runs into a zlib stream, at a cost that grows with the number of runs and not
/// with the bytes: neither the bytes nor their checksum are gone through one by one.
///
/// Only two repetitions are looked for: a byte that goes on, and a stretch that the caller repeats.
/// Source   RFC 1950 and 1951 (one block with its own Huffman codes).
class RunDeflater {
public:
  void put(std::uint8_t byte, std::size_t count);
  void put(std::span<const std::uint8_t> bytes);

  /// What comes until `end_stretch` may be repeated once and again, directly after it. All stretches of a stream
  /// have one length, 3 to 32768 bytes.
  void begin_stretch() { stretch_ = {written_, low_, high_}; }
  void end_stretch();
  void repeat_stretch();

  /// The whole stream. The deflater is used up.
  [[nodiscard]] std::string finish();

private:
  void flush_run();
  void checksum(std::uint8_t byte, std::uint64_t count);

  std::vector<std::uint32_t> tokens_;
  std::uint64_t run_ = 0;  ///< bytes of `byte_` that are not yet a token
  std::uint8_t byte_ = 0;
  bool run_goes_on_ = false;          ///< the token before ends in `byte_`
  std::uint64_t low_ = 1, high_ = 0;  ///< the two sums of Adler-32
  std::uint64_t written_ = 0;
  /// First where it begins; then its length, and what it adds to the two sums.
  struct Stretch {
    std::uint64_t bytes, low, high;
  } stretch_ = {};
};

}  // namespace mezzotint
