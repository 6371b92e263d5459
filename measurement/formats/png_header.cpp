#include <array>

#include <fmt/format.h>
#include <zlib.h>

#include "forward/base/error.h"
#include "measurement/formats/byte_reader.h"
#include "measurement/formats/picture_header.h"
#include "measurement/formats/zlib_stream.h"

namespace mezzotint {

namespace {

using Bytes = std::span<const std::byte>;

constexpr std::string_view signature("\x89PNG\r\n\x1A\n", 8);

std::uint32_t big_endian(Bytes bytes) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < 4; ++i) value = value << 8 | std::to_integer<std::uint32_t>(bytes[i]);
  return value;
}

struct Chunk {
  std::string_view type;
  Bytes data;
  Bytes whole;  ///< with its length and its checksum
};

// Of a type, and what follows it: bytes of up to 2^31, which zlib takes at once.
std::uint32_t checksum(Bytes bytes) {
  return static_cast<std::uint32_t>(
      crc32(0, reinterpret_cast<const Bytef*>(bytes.data()), static_cast<uInt>(bytes.size())));
}

Chunk take_chunk(ByteReader& reader) {
  constexpr std::uint32_t largest_chunk = 0x7FFFFFFF;
  ByteReader ahead = reader;
  const std::uint32_t length = big_endian(ahead.take(4, "a chunk"));
  if (length > largest_chunk) reader.fail(fmt::format("a chunk of {} bytes; PNG allows 2^31 − 1", length));
  const Bytes whole = reader.take(std::uint64_t{length} + 12, "a chunk");
  const Bytes type_and_data = whole.subspan(4, std::size_t{length} + 4);
  if (checksum(type_and_data) != big_endian(whole.last(4))) {
    ahead.fail("a chunk whose checksum does not fit; the picture is damaged");
  }
  return {{reinterpret_cast<const char*>(type_and_data.data()), 4}, type_and_data.subspan(4), whole};
}

void append(std::vector<std::byte>& bytes, Bytes more) { bytes.insert(bytes.end(), more.begin(), more.end()); }

// Width, height, bits, colour type, compression, filter, interlace.
std::uint64_t checked_picture_bytes(const std::filesystem::path& path, const Chunk& header) {
  if (header.type != "IHDR" || header.data.size() != 13) {
    throw FileError(path, "byte 8", "a PNG begins with its header IHDR of 13 bytes");
  }
  const auto byte = [&](std::size_t i) { return std::to_integer<int>(header.data[i]); };
  const int bits = byte(8);
  if (byte(9) != 0) throw FileError(path, "IHDR", "the picture is in colour or has transparency; a relief is gray");
  if (bits != 8 && bits != 16) {
    throw FileError(path, "IHDR", fmt::format("{} bits a pixel; 8 or 16 are read", bits));
  }
  const std::uint64_t columns = big_endian(header.data), rows = big_endian(header.data.subspan(4));
  return (columns * static_cast<unsigned>(bits) / 8 + 1) * rows;
}

}  // namespace

bool looks_like_png(Bytes bytes) { return begins_with(bytes, signature); }

// Source   PNG specification (second edition), 5 and 11.
std::vector<std::byte> plain_png(const std::filesystem::path& path, Bytes bytes) {
  ByteReader reader(path, bytes);
  std::vector<std::byte> plain;
  plain.reserve(bytes.size());
  append(plain, reader.take(signature.size(), "the signature"));
  const Chunk header = take_chunk(reader);
  const std::uint64_t needed = checked_picture_bytes(path, header);
  append(plain, header.whole);
  std::uint64_t packed = 0;
  while (true) {
    const Chunk chunk = take_chunk(reader);
    if (chunk.type == "IDAT") packed += chunk.data.size();
    if (chunk.type == "IDAT" || chunk.type == "IEND") append(plain, chunk.whole);
    if (chunk.type == "IEND") break;
  }
  if (needed / best_deflate_ratio > packed) {
    throw FileError(path, "IHDR",
                    fmt::format("claims {} bytes from {} packed ones, which deflate cannot do", needed, packed));
  }
  return plain;
}

}  // namespace mezzotint
