#include "fabrication/projector/light_switch.h"

#include <exception>

namespace mezzotint::dlpc900 {
namespace {

constexpr int attempts = 3;

/// False where the order failed; nothing is left to try where the device is gone, which is thrown.
template <typename Order>
bool succeeds(const Order& order) {
  try {
    order();
    return true;
  } catch (const LightEngineError& error) {
    if (error.fault() == LightFault::Disconnected) throw;
    return false;
  }
}

}  // namespace

Moment switch_leds(Link& link, Clock& clock, std::uint8_t leds) {
  Moment moment{clock.now(), clock.now()};
  for (int attempt = 1; attempt <= attempts; ++attempt) {
    bool answered = true;
    try {
      link.order(Command::LedEnable, {leds});
    } catch (const LightEngineError& error) {
      if (error.fault() != LightFault::Timeout) throw;
      answered = false;
    }
    moment.latest = clock.now();
    if (link.read(Command::LedEnable, 1)[0] == leds) return moment;
    // What read back says that nothing has changed so far; an order without an answer may still be under way.
    if (answered) moment.earliest = moment.latest;
  }
  throw LightEngineError(LightFault::IgnoredSetting, leds == leds_off ? "the projector does not put its LEDs off"
                                                                      : "the projector does not put its LEDs on");
}

bool force_dark(Link& link) noexcept {
  bool dark = false;
  try {
    for (int attempt = 1; attempt <= attempts; ++attempt) {
      bool all = succeeds([&] { link.order(Command::LedEnable, {leds_off}); });
      all &= succeeds([&] { link.order(Command::Sequence, {static_cast<std::uint8_t>(SequenceAction::Stop)}); });
      all &= succeeds([&] { link.set(Command::LedCurrents, {0, 0, 0}); });
      // Off is what reads back last: nothing that is still under way can put them on.
      if (succeeds([&] { dark = link.read(Command::LedEnable, 1)[0] == leds_off; }) && dark && all) return true;
    }
  } catch (const std::exception&) {  // the device is gone, or memory: the caller is told by the answer
    return false;
  }
  return dark;
}

}  // namespace mezzotint::dlpc900
