#pragma once

#include <sys/types.h>

#include <functional>

#include "fabrication/session/print_session.h"

namespace mezzotint {

/// A second process that puts the light off when this one was killed, crashed or hangs in an exposure.
///
/// What a process has open, the system closes when it dies; the light stays on all the same. The guardian waits at the
/// other end of a socket. Where the light is on and the line breaks, it calls `put_light_off`, which opens the device
/// anew. Where the light is on for longer than it was said to be (the process hangs, or was stopped), it kills the
/// process first. Ctrl-C and a closed terminal do not reach it.
/// Threads  Make it before other threads are started and before the device is opened.
/// Missing  a second process, or a machine, that dies together with the first.
class Guardian final : public LightWatch {
public:
  /// @param put_light_off  called in the second process; true where the light is surely off
  /// @throws DeviceError where no process can be started
  explicit Guardian(const std::function<bool()>& put_light_off);
  /// Lets the second process end; where the light may still be on, it tries once more.
  ~Guardian() override;
  Guardian(const Guardian&) = delete;
  Guardian& operator=(const Guardian&) = delete;

  void expect_light(Clock::Duration longest) noexcept override;
  void expect_dark() noexcept override;

private:
  void say(Clock::Duration until) noexcept;

  Descriptor line_;
  pid_t process_ = -1;
  bool light_ = false;
};

}  // namespace mezzotint
