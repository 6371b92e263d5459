#include "fabrication/projector/dlpc900_frame.h"

#include <algorithm>

#include "forward/base/error.h"

namespace mezzotint::dlpc900 {
namespace {

constexpr std::uint8_t read_flag = 0x80;
constexpr std::uint8_t reply_flag = 0x40;
constexpr std::uint8_t error_flag = 0x20;

}  // namespace

std::vector<Report> encode_message(const Message& message) {
  require(message.data.size() <= largest_data_bytes, "a DLPC900 message holds at most " +
                                                         std::to_string(largest_data_bytes) + " bytes of data, not " +
                                                         std::to_string(message.data.size()));
  std::vector<std::uint8_t> bytes;
  // A read is always answered.
  bytes.push_back(message.read ? read_flag | reply_flag : message.wants_reply ? reply_flag : 0);
  bytes.push_back(message.sequence);
  append_number(bytes, static_cast<std::uint32_t>(2 + message.data.size()), 2);
  append_number(bytes, message.command, 2);
  bytes.insert(bytes.end(), message.data.begin(), message.data.end());

  std::vector<Report> reports((bytes.size() + report_bytes - 1) / report_bytes, Report{});
  for (std::size_t i = 0; i < bytes.size(); ++i) reports[i / report_bytes][i % report_bytes] = bytes[i];
  return reports;
}

std::optional<ReplyHeader> parse_reply_header(std::span<const std::uint8_t> report) {
  if (report.size() < header_bytes) return {};
  return ReplyHeader{
      .error = (report[0] & error_flag) != 0, .sequence = report[1], .data_bytes = number_at(report, 2, 2)};
}

void append_number(std::vector<std::uint8_t>& bytes, std::uint32_t value, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) bytes.push_back(static_cast<std::uint8_t>(value >> (8 * i)));
}

std::uint32_t number_at(std::span<const std::uint8_t> bytes, std::size_t place, std::size_t count) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < count; ++i) value |= std::uint32_t{bytes[place + i]} << (8 * i);
  return value;
}

}  // namespace mezzotint::dlpc900
