#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace mezzotint::dlpc900 {

/// What travels over USB: 64 bytes at a time, no report number in front.
inline constexpr std::size_t report_bytes = 64;
using Report = std::array<std::uint8_t, report_bytes>;

/// The device has one buffer of 512 bytes for a message, header included.
inline constexpr std::size_t largest_message_bytes = 512;
inline constexpr std::size_t header_bytes = 4;
inline constexpr std::size_t largest_data_bytes = largest_message_bytes - header_bytes - 2;

struct Message {
  bool read = false;
  bool wants_reply = true;
  std::uint8_t sequence = 0;  ///< comes back with the reply
  std::uint16_t command = 0;
  std::vector<std::uint8_t> data;
};

/// A message as reports: flags, sequence number, length of command and data, command, data; little-endian.
/// The first report alone has a header; the last is filled up with zeros.
/// @throws InvalidInput for more than `largest_data_bytes`.
/// Source   TI DLPU018F, section 1.2.
[[nodiscard]] std::vector<Report> encode_message(const Message& message);

struct ReplyHeader {
  bool error = false;  ///< the device will not; ask 0x0100 why
  std::uint8_t sequence = 0;
  std::size_t data_bytes = 0;  ///< as the device says; may be more than came
};

/// Nothing where a report is too short to have a header. The data begins at `header_bytes`; what does not fit the
/// first report goes on in the next, without a header.
[[nodiscard]] std::optional<ReplyHeader> parse_reply_header(std::span<const std::uint8_t> report);

/// Little-endian numbers of 1 to 4 bytes.
void append_number(std::vector<std::uint8_t>& bytes, std::uint32_t value, std::size_t count);
[[nodiscard]] std::uint32_t number_at(std::span<const std::uint8_t> bytes, std::size_t place, std::size_t count);

}  // namespace mezzotint::dlpc900
