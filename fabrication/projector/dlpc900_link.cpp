#include "fabrication/projector/dlpc900_link.h"

#include <fmt/format.h>

#include <algorithm>

namespace mezzotint::dlpc900 {
namespace {

constexpr auto quiet_time = std::chrono::milliseconds(20);
constexpr int most_stale_reports = 64;
constexpr std::size_t error_text_bytes = 128;

std::string told(Command command) {
  return fmt::format("{} (0x{:04X})", command_name(command), static_cast<unsigned>(command));
}

LightEngineError protocol_error(std::uint16_t command, const std::string& what) {
  return {LightFault::Protocol, "the projector's answer to " + told(Command{command}) + " " + what};
}

}  // namespace

Link::Link(std::unique_ptr<ReportTransport> transport, Clock& clock, Timing timing)
    : transport_(std::move(transport)), clock_(clock), timing_(timing) {}

Link::Link(std::unique_ptr<ReportTransport> transport, Clock& clock) : Link(std::move(transport), clock, Timing{}) {}

void Link::drain() {
  for (int i = 0; i < most_stale_reports; ++i) {
    if (!transport_->receive(quiet_time)) return;
  }
  throw LightEngineError(LightFault::Protocol, "the projector talks without being asked");
}

Clock::Duration Link::remaining(Clock::Duration deadline) const {
  return std::max(deadline - clock_.now(), Clock::Duration(0));
}

Link::Reply Link::exchange(Message message, std::size_t largest_reply, Clock::Duration deadline) {
  if (++sequence_ == 0) ++sequence_;  // 0 is what the rest of a long, late answer looks like
  message.sequence = sequence_;
  for (const auto& report : encode_message(message)) transport_->send(report, remaining(deadline));
  return receive_reply(message, largest_reply, deadline);
}

Link::Reply Link::receive_reply(const Message& message, std::size_t largest_reply, Clock::Duration deadline) {
  const auto receive = [&] {
    auto report = remaining(deadline).count() > 0 ? transport_->receive(remaining(deadline)) : std::nullopt;
    if (report) return *report;
    throw LightEngineError(LightFault::Timeout,
                           "the projector did not answer " + told(Command{message.command}) + " in time");
  };
  ReceivedReport report = receive();
  auto header = parse_reply_header(report.view());
  while (header && header->sequence != message.sequence) {  // late answers to earlier questions
    report = receive();
    header = parse_reply_header(report.view());
  }
  if (!header) throw protocol_error(message.command, fmt::format("has {} bytes, less than a header", report.size));
  // An error answers with fewer bytes than the question asked for, or with none.
  const std::size_t bytes = header->data_bytes;
  if (bytes > std::max<std::size_t>(largest_reply, report_bytes - header_bytes)) {
    throw protocol_error(message.command, fmt::format("claims {} bytes, more than {}", bytes, largest_reply));
  }
  Reply reply{header->error, {}};
  auto part = report.view().subspan(header_bytes);
  for (;;) {
    const std::size_t taken = std::min(part.size(), bytes - reply.data.size());
    reply.data.insert(reply.data.end(), part.begin(), part.begin() + static_cast<std::ptrdiff_t>(taken));
    if (reply.data.size() == bytes) return reply;
    if (part.size() < (reply.data.size() == taken ? report_bytes - header_bytes : report_bytes)) {
      throw protocol_error(message.command, fmt::format("ends after {} of {} bytes", reply.data.size(), bytes));
    }
    report = receive();
    part = report.view();
  }
}

std::vector<std::uint8_t> Link::read_before(Command command, std::size_t bytes, Clock::Duration deadline) {
  Reply reply = exchange({.read = true, .command = static_cast<std::uint16_t>(command)}, bytes, deadline);
  if (reply.error) refuse(command);
  if (reply.data.size() != bytes) {
    throw protocol_error(static_cast<std::uint16_t>(command),
                         fmt::format("has {} bytes of data; it should have {}", reply.data.size(), bytes));
  }
  return std::move(reply.data);
}

std::vector<std::uint8_t> Link::read(Command command, std::size_t bytes) {
  for (int attempt = 1;; ++attempt) {
    try {
      return read_before(command, bytes, clock_.now() + timing_.reply);
    } catch (const LightEngineError& error) {
      if (error.fault() != LightFault::Timeout || attempt == timing_.read_attempts) throw;
    }
  }
}

void Link::order(Command command, const std::vector<std::uint8_t>& data) {
  const Reply reply = exchange({.command = static_cast<std::uint16_t>(command), .data = data},
                               report_bytes - header_bytes, clock_.now() + timing_.reply);
  if (reply.error) refuse(command);
}

void Link::set(Command command, const std::vector<std::uint8_t>& data) {
  for (int attempt = 1;; ++attempt) {
    bool answered = true;
    try {
      order(command, data);
    } catch (const LightEngineError& error) {
      if (error.fault() != LightFault::Timeout) throw;
      answered = false;  // the order or its answer was lost: what reads back tells
    }
    const auto back = read(command, data.size());
    if (back == data) return;
    if (attempt < 2) continue;
    throw LightEngineError(answered ? LightFault::IgnoredSetting : LightFault::Timeout,
                           fmt::format("the projector reads back {:02X} for {}, which was set to {:02X}",
                                       fmt::join(back, " "), told(command), fmt::join(data, " ")));
  }
}

void Link::refuse(Command command) {
  std::optional<int> code;
  std::string text;
  // Some firmware refuses the question for the reason too.
  const auto ask = [&](Command question, std::size_t bytes) -> std::vector<std::uint8_t> {
    try {
      Reply reply = exchange({.read = true, .command = static_cast<std::uint16_t>(question)}, bytes,
                             clock_.now() + timing_.reply);
      if (!reply.error && reply.data.size() <= bytes) return std::move(reply.data);
    } catch (const LightEngineError& error) {
      if (error.fault() == LightFault::Disconnected) throw;
    }
    return {};
  };
  if (const auto data = ask(Command::ErrorCode, 1); data.size() == 1) code = data[0];
  for (const auto byte : ask(Command::ErrorText, error_text_bytes)) {
    if (byte == 0) break;
    text += byte >= 0x20 && byte < 0x7f ? static_cast<char>(byte) : '?';
  }
  std::string message = "the projector refuses " + told(command);
  if (code) message += fmt::format(": code {}, {}", *code, error_code_text(*code));
  if (!text.empty()) message += fmt::format(" (\"{}\")", text);
  throw LightEngineError(LightFault::Refused, message, code);
}

}  // namespace mezzotint::dlpc900
