#pragma once

#include <algorithm>

#include "fabrication/projector/dlpc900_link.h"

namespace mezzotint::dlpc900 {

/// Something happened between two moments.
struct Moment {
  Clock::Duration earliest{0}, latest{0};
};

/// From one to the other. Two orders take the same way to the device, so that begin to begin is closer than middle to
/// middle, where half of an acknowledgement would be counted as light; and how far off that can be.
[[nodiscard]] inline Clock::Duration between(const Moment& on, const Moment& off) { return off.earliest - on.earliest; }
[[nodiscard]] inline Clock::Duration uncertainty_between(const Moment& on, const Moment& off) {
  return std::max(on.latest - on.earliest, off.latest - off.earliest);
}

/// Orders the LEDs and reads back, up to three times; answers when they changed.
/// @throws LightEngineError IgnoredSetting where they never do, and what the link throws.
Moment switch_leds(Link& link, Clock& clock, std::uint8_t leds);

/// LEDs off, sequencer stopped, LED current 0, tried three times over; whatever fails, the rest is tried too.
/// True where the LEDs read back as off.
[[nodiscard]] bool force_dark(Link& link) noexcept;

}  // namespace mezzotint::dlpc900
