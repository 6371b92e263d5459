#include "fabrication/job/run_deflate.h"

#include <algorithm>

#include "fabrication/job/deflate_block.h"

namespace mezzotint {

namespace {

constexpr std::uint64_t adler_modulus = 65521;

}  // namespace

// RFC 1950, 9: low grows by each byte, high by low after each byte. `count` equal bytes make two arithmetic series.
void RunDeflater::checksum(std::uint8_t byte, std::uint64_t count) {
  const std::uint64_t half_square = count % 2 == 0 ? count / 2 * (count + 1) : (count + 1) / 2 * count;
  high_ = (high_ + count % adler_modulus * low_ + half_square % adler_modulus * byte) % adler_modulus;
  low_ = (low_ + count % adler_modulus * byte) % adler_modulus;
  written_ += count;
}

void RunDeflater::put(std::uint8_t byte, std::size_t count) {
  if (count == 0) return;
  if (byte != byte_) {
    flush_run();
    run_goes_on_ = false;
    byte_ = byte;
  }
  run_ += count;
  checksum(byte, count);
}

void RunDeflater::put(std::span<const std::uint8_t> bytes) {
  for (std::size_t begin = 0; begin < bytes.size();) {
    std::size_t end = begin + 1;
    while (end < bytes.size() && bytes[end] == bytes[begin]) ++end;
    put(bytes[begin], end - begin);
    begin = end;
  }
}

void RunDeflater::flush_run() {
  if (run_ > 0 && !run_goes_on_) {
    tokens_.push_back(byte_);
    --run_;
  }
  for (; run_ >= 3; run_ -= std::min<std::uint64_t>(run_, longest_copy)) {
    tokens_.push_back(copy_token | static_cast<std::uint32_t>(std::min<std::uint64_t>(run_, longest_copy)));
  }
  for (; run_ > 0; --run_) tokens_.push_back(byte_);
  run_goes_on_ = true;
}

void RunDeflater::end_stretch() {
  const std::uint64_t bytes = written_ - stretch_.bytes;
  const std::uint64_t low = (low_ + adler_modulus - stretch_.low) % adler_modulus;
  const std::uint64_t before = (stretch_.high + bytes % adler_modulus * stretch_.low) % adler_modulus;
  stretch_ = {bytes, low, (high_ + adler_modulus - before) % adler_modulus};
}

void RunDeflater::repeat_stretch() {
  flush_run();
  const auto length = static_cast<std::uint32_t>(stretch_.bytes);
  const bool goes_on = !tokens_.empty() &&
                       (tokens_.back() & (copy_token | from_stretch)) == (copy_token | from_stretch) &&
                       (tokens_.back() & longest_copy) + length <= longest_copy;
  if (goes_on) {
    tokens_.back() += length;
  } else {
    tokens_.push_back(copy_token | from_stretch | length);
  }
  high_ = (high_ + stretch_.bytes % adler_modulus * low_ + stretch_.high) % adler_modulus;
  low_ = (low_ + stretch_.low) % adler_modulus;
  written_ += stretch_.bytes;
}

std::string RunDeflater::finish() {
  flush_run();
  std::string out = {'\x78', '\x01'};
  append_block(tokens_, stretch_.bytes, out);
  for (const std::uint64_t sum : {high_, low_}) {
    out.push_back(static_cast<char>(sum >> 8U));
    out.push_back(static_cast<char>(sum & 255U));
  }
  return out;
}

}  // namespace mezzotint
