#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "forward/base/error.h"

namespace mezzotint {

/// What can be wrong with a build platform, whatever its make.
enum class StageFault {
  Silent,         ///< no answer before the deadline
  Refused,        ///< the board answered that it will not
  Garbled,        ///< lines keep getting lost or damaged on the way
  PositionLost,   ///< the board restarted: it no longer knows where the platform is
  WrongPosition,  ///< the platform is not where it was sent
  NoEndstop,      ///< homing did not find the end switch
  Disconnected    ///< the cable or the power is gone
};

/// "silent", "refused", …: for messages.
[[nodiscard]] std::string_view fault_name(StageFault fault);

/// A build platform failed. The message says what was asked and what came back.
class StageError : public DeviceError {
public:
  StageError(StageFault fault, const std::string& message) : DeviceError(message), fault_(fault) {}
  [[nodiscard]] StageFault fault() const { return fault_; }

private:
  StageFault fault_;
};

/// A build platform as a print session sees it.
///
/// Frame    height over the machine's own zero, upward; absolute heights only, so that no rounding adds up
/// Units    whole micrometres; speeds in µm/s
/// Threads  one thread at a time
/// Errors   StageError. After PositionLost or WrongPosition every move is refused until `home`.
class Stage {
public:
  virtual ~Stage() = default;

  /// Drives to the end switch: from then on heights are known.
  virtual void home() = 0;
  /// Whether heights are known.
  [[nodiscard]] virtual bool is_homed() const = 0;
  /// Returns when the platform stands there, as it says itself.
  virtual void move_to(std::int64_t height_um, double speed_um_per_s) = 0;
  /// Where the platform says that it is.
  [[nodiscard]] virtual std::int64_t height_um() = 0;
};

}  // namespace mezzotint
