#include "forward/base/digest.h"

#include <array>
#include <cstdint>

#include <nettle/md5.h>
#include <nettle/sha2.h>

namespace mezzotint {

namespace {

std::string to_hex(std::span<const std::uint8_t> digest) {
  constexpr const char* digits = "0123456789abcdef";
  std::string text;
  text.reserve(2 * digest.size());
  for (const std::uint8_t byte : digest) {
    text.push_back(digits[byte >> 4]);
    text.push_back(digits[byte & 15]);
  }
  return text;
}

const std::uint8_t* raw(std::span<const std::byte> bytes) {
  return reinterpret_cast<const std::uint8_t*>(bytes.data());
}

}  // namespace

std::string md5_hex(std::span<const std::byte> bytes) {
  md5_ctx context;
  md5_init(&context);
  md5_update(&context, bytes.size(), raw(bytes));
  std::array<std::uint8_t, MD5_DIGEST_SIZE> digest{};
  md5_digest(&context, digest.size(), digest.data());
  return to_hex(digest);
}

std::string sha256_hex(std::span<const std::byte> bytes) {
  sha256_ctx context;
  sha256_init(&context);
  sha256_update(&context, bytes.size(), raw(bytes));
  std::array<std::uint8_t, SHA256_DIGEST_SIZE> digest{};
  sha256_digest(&context, digest.size(), digest.data());
  return to_hex(digest);
}

}  // namespace mezzotint
