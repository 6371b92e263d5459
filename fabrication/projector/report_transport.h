#pragma once

#include <array>
#include <optional>
#include <span>

#include "fabrication/device/clock.h"
#include "fabrication/projector/dlpc900_frame.h"

namespace mezzotint::dlpc900 {

struct ReceivedReport {
  std::array<std::uint8_t, report_bytes> bytes{};
  std::size_t size = 0;
  [[nodiscard]] std::span<const std::uint8_t> view() const { return std::span(bytes).first(size); }
};

/// Carries reports to a device and back; knows nothing of what they say.
///
/// Errors   LightEngineError: Timeout (send alone), Disconnected, Protocol (a transfer that stalls twice, or holds
///          more than a report).
class ReportTransport {
public:
  virtual ~ReportTransport() = default;
  virtual void send(const Report& report, Clock::Duration timeout) = 0;
  /// Nothing where no report came in time.
  [[nodiscard]] virtual std::optional<ReceivedReport> receive(Clock::Duration timeout) = 0;
};

}  // namespace mezzotint::dlpc900
