#pragma once

#include <memory>

#include "fabrication/device/light_engine.h"
#include "fabrication/projector/report_transport.h"
#include "tests/fabrication/projector/emulator/device_model.h"

namespace mezzotint {

/// Reports straight into the emulated device, without USB: one a millisecond of a clock that moves by itself.
class EmulatedTransport final : public dlpc900::ReportTransport {
public:
  EmulatedTransport(emulator::DeviceModel& model, Clock& clock) : model_(model), clock_(clock) {}

  void send(const dlpc900::Report& report, Clock::Duration) override {
    clock_.sleep_for(frame);
    for (int attempt = 1;; ++attempt) {
      const auto taken = model_.receive_report({report.begin(), report.end()});
      if (settled(taken, attempt)) return;
    }
  }

  std::optional<dlpc900::ReceivedReport> receive(Clock::Duration timeout) override {
    std::optional<emulator::Bytes> bytes;
    for (int attempt = 1;; ++attempt) {
      if (settled(model_.next_report(bytes), attempt)) break;
    }
    clock_.sleep_for(bytes ? std::min<Clock::Duration>(frame, timeout) : timeout);
    if (!bytes) return {};
    dlpc900::ReceivedReport report;
    report.size = bytes->size();
    std::copy(bytes->begin(), bytes->end(), report.bytes.begin());
    return report;
  }

private:
  static constexpr auto frame = std::chrono::milliseconds(1);

  static bool settled(emulator::DeviceModel::Taken taken, int attempt) {
    using Taken = emulator::DeviceModel::Taken;
    if (taken == Taken::Gone) throw LightEngineError(LightFault::Disconnected, "the emulated cable is pulled");
    if (taken == Taken::Stalled && attempt > 1) throw LightEngineError(LightFault::Protocol, "stalled twice");
    return taken == Taken::Yes;
  }

  emulator::DeviceModel& model_;
  Clock& clock_;
};

}  // namespace mezzotint
