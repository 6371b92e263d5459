#include "fabrication/device/light_engine.h"

namespace mezzotint {

std::string_view fault_name(LightFault fault) {
  switch (fault) {
    case LightFault::Refused:
      return "refused";
    case LightFault::Timeout:
      return "timeout";
    case LightFault::Protocol:
      return "protocol";
    case LightFault::Disconnected:
      return "disconnected";
    case LightFault::Sequencer:
      return "sequencer";
    case LightFault::MissingSecondary:
      return "missing secondary controller";
    case LightFault::LostSync:
      return "lost sync";
    case LightFault::IgnoredSetting:
      return "ignored setting";
    case LightFault::Incompatible:
      return "incompatible";
    case LightFault::OverTemperature:
      return "over-temperature";
  }
  return "unknown";
}

}  // namespace mezzotint
