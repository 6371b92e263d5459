#pragma once

#include "fabrication/projector/dlpc900.h"
#include "fabrication/projector/dlpc900_link.h"

namespace mezzotint::dlpc900 {

/// What stands at the other end.
struct Hardware {
  LightEngineIdentity identity;
  FirmwareVersion firmware;
  std::size_t controllers = 1;
};

/// @throws LightEngineError Incompatible for mirrors that the driver does not know.
[[nodiscard]] Hardware identify(Link& link);

/// Out of standby. A projector that has just gone there parks its mirrors first, for two minutes, and hears nothing
/// else.
/// @throws LightEngineError Timeout where it does not wake.
void wake(Link& link, Clock& clock);

struct Setting {
  Command command;
  std::vector<std::uint8_t> data;
};

/// Everything that reads back, in the order in which it is set: currents before polarity before the LEDs come on.
[[nodiscard]] std::vector<Setting> settings_that_read_back(const LightSettings& settings,
                                                           const Dlpc900Options& options);

/// @throws LightEngineError IgnoredSetting naming what reads back otherwise.
void require_unchanged(Link& link, const std::vector<Setting>& settings);

/// @throws LightEngineError Sequencer, MissingSecondary, Incompatible: what the status byte complains of.
void require_healthy(const HardwareStatus& status, std::size_t controllers);
[[nodiscard]] HardwareStatus read_hardware_status(Link& link);
[[nodiscard]] MainStatus read_main_status(Link& link);

/// Chooses where pictures come from. Video waits for the signal.
void enter_display_mode(Link& link, Clock& clock, const Dlpc900Options& options, const FirmwareVersion& firmware);

}  // namespace mezzotint::dlpc900
