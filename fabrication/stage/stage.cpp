#include "fabrication/stage/stage.h"

namespace mezzotint {

std::string_view fault_name(StageFault fault) {
  switch (fault) {
    case StageFault::Silent:
      return "silent";
    case StageFault::Refused:
      return "refused";
    case StageFault::Garbled:
      return "garbled";
    case StageFault::PositionLost:
      return "position lost";
    case StageFault::WrongPosition:
      return "wrong position";
    case StageFault::NoEndstop:
      return "no end switch";
    case StageFault::Disconnected:
      return "disconnected";
  }
  return "unknown";
}

}  // namespace mezzotint
