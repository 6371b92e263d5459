#include "measurement/formats/byte_reader.h"

#include <algorithm>

#include "forward/base/error.h"

namespace mezzotint {

std::string byte_place(std::size_t offset) { return "byte " + std::to_string(offset); }

bool begins_with(std::span<const std::byte> bytes, std::string_view magic) {
  return bytes.size() >= magic.size() && std::memcmp(bytes.data(), magic.data(), magic.size()) == 0;
}

void ByteReader::fail(std::string_view problem) const { throw FileError(*path_, byte_place(offset()), problem); }

std::span<const std::byte> ByteReader::take(std::uint64_t count, std::string_view what) {
  if (count > remaining()) {
    fail(std::string(what) + " needs " + std::to_string(count) + " bytes, but only " + std::to_string(remaining()) +
         " are left; the file is damaged or was cut short");
  }
  const auto taken = bytes_.subspan(position_, static_cast<std::size_t>(count));
  position_ += taken.size();
  return taken;
}

ByteReader ByteReader::take_part(std::uint64_t count, std::string_view what) {
  const std::size_t start = offset();
  ByteReader part(*path_, take(count, what));
  part.base_ = start;
  return part;
}

std::string_view ByteReader::take_text(std::string_view what) {
  const auto rest = bytes_.subspan(position_);
  const auto end = std::find(rest.begin(), rest.end(), std::byte{0});
  if (end == rest.end()) fail(std::string(what) + " has no end; a text ends in a zero byte");
  const auto length = static_cast<std::size_t>(end - rest.begin());
  position_ += length + 1;
  return {reinterpret_cast<const char*>(rest.data()), length};
}

}  // namespace mezzotint
