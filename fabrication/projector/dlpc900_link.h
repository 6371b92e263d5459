#pragma once

#include <memory>

#include "fabrication/device/light_engine.h"
#include "fabrication/projector/dlpc900_commands.h"
#include "fabrication/projector/report_transport.h"

namespace mezzotint::dlpc900 {

/// Questions and orders to the device, one at a time, each with its answer.
///
/// Answers  carry the number of their question: those of others came late and are dropped. An answer that is
///          shorter or longer than it can be is an error, and nothing is read beyond what came.
/// Retries  Reads are asked again, twice, where no answer came. Orders are not: `set` reads back and decides.
/// Errors   LightEngineError: Refused with the device's code and text, Timeout, Protocol, Disconnected,
///          IgnoredSetting (`set`).
class Link {
public:
  struct Timing {
    Clock::Duration reply{std::chrono::milliseconds(500)};
    int read_attempts = 3;
  };

  Link(std::unique_ptr<ReportTransport> transport, Clock& clock, Timing timing);
  Link(std::unique_ptr<ReportTransport> transport, Clock& clock);

  /// Drops what the device still had to say to whoever spoke to it before.
  void drain();

  /// Exactly `bytes` of data.
  [[nodiscard]] std::vector<std::uint8_t> read(Command command, std::size_t bytes);
  /// One attempt that ends at a moment of the clock.
  [[nodiscard]] std::vector<std::uint8_t> read_before(Command command, std::size_t bytes, Clock::Duration deadline);

  /// An order that the device acknowledges.
  void order(Command command, const std::vector<std::uint8_t>& data);

  /// An order whose value reads back; given twice where it does not.
  void set(Command command, const std::vector<std::uint8_t>& data);

private:
  struct Reply {
    bool error = false;
    std::vector<std::uint8_t> data;
  };
  [[nodiscard]] Reply exchange(Message message, std::size_t largest_reply, Clock::Duration deadline);
  [[nodiscard]] Reply receive_reply(const Message& message, std::size_t largest_reply, Clock::Duration deadline);
  [[noreturn]] void refuse(Command command);
  [[nodiscard]] Clock::Duration remaining(Clock::Duration deadline) const;

  std::unique_ptr<ReportTransport> transport_;
  Clock& clock_;
  Timing timing_;
  std::uint8_t sequence_ = 0;
};

}  // namespace mezzotint::dlpc900
