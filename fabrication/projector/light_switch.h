#pragma once

#include "fabrication/projector/dlpc900_link.h"

namespace mezzotint::dlpc900 {

/// Something happened between two moments.
struct Moment {
  Clock::Duration earliest{0}, latest{0};
  [[nodiscard]] Clock::Duration middle() const { return earliest + (latest - earliest) / 2; }
  [[nodiscard]] Clock::Duration uncertainty() const { return (latest - earliest) / 2; }
};

/// Orders the LEDs and reads back, up to three times; answers when they changed.
/// @throws LightEngineError IgnoredSetting where they never do, and what the link throws.
Moment switch_leds(Link& link, Clock& clock, std::uint8_t leds);

/// LEDs off, sequencer stopped, LED current 0, tried three times over; whatever fails, the rest is tried too.
/// True where the LEDs read back as off.
[[nodiscard]] bool force_dark(Link& link) noexcept;

}  // namespace mezzotint::dlpc900
