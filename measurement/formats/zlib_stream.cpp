#include "measurement/formats/zlib_stream.h"

#include <algorithm>
#include <limits>
#include <memory>

#include <zlib.h>

#include "forward/base/error.h"

namespace mezzotint {

namespace {

// zlib counts in 32 bits; longer streams go through in parts.
constexpr std::size_t largest_part = std::size_t{1} << 30;

uInt part_of(std::size_t bytes) { return static_cast<uInt>(std::min(bytes, largest_part)); }

int inflate_all(z_stream& stream, std::size_t packed_left, std::size_t& unpacked_left) {
  int status = Z_OK;
  while (status == Z_OK) {
    const uInt in = part_of(packed_left), out = part_of(unpacked_left);
    stream.avail_in = in;
    stream.avail_out = out;
    status = inflate(&stream, Z_NO_FLUSH);
    packed_left -= in - stream.avail_in;
    unpacked_left -= out - stream.avail_out;
  }
  return status;
}

}  // namespace

std::string inflate_exactly(std::span<const std::byte> packed, std::span<std::byte> unpacked) {
  z_stream stream{};
  if (inflateInit(&stream) != Z_OK) throw MethodError("zlib cannot be started: out of memory");
  const std::unique_ptr<z_stream, int (*)(z_stream*)> closer(&stream, &inflateEnd);
  // zlib's interface of C knows no const; it does not write there.
  stream.next_in = const_cast<Bytef*>(reinterpret_cast<const Bytef*>(packed.data()));
  stream.next_out = reinterpret_cast<Bytef*>(unpacked.data());
  std::size_t missing = unpacked.size();
  const int status = inflate_all(stream, packed.size(), missing);
  if (status == Z_STREAM_END && missing == 0) return "";
  if (status == Z_STREAM_END) return "unpacks to " + std::to_string(missing) + " bytes less than promised";
  if (status == Z_BUF_ERROR && missing == 0) return "unpacks to more than promised";
  return stream.msg != nullptr ? std::string("is damaged: ") + stream.msg : "is damaged or was cut short";
}

}  // namespace mezzotint
