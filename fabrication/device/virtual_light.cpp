#include "fabrication/device/virtual_light.h"

#include <algorithm>

namespace mezzotint {

VirtualLight::VirtualLight(Clock& clock, std::size_t columns, std::size_t rows)
    : clock_(clock), identity_{"virtual printer", "", "", columns, rows} {}

void VirtualLight::prepare(const LightSettings& settings) {
  require(settings.led_amplitude >= 0 && settings.led_amplitude <= 255, "an LED amplitude lies between 0 and 255");
}

UploadEstimate VirtualLight::estimate(const ShownPicture&) const { return {}; }

void VirtualLight::show(const ShownPicture& picture, Clock::Duration exposure) {
  require(picture.columns == identity_.columns && picture.rows == identity_.rows &&
              picture.gray.size() == picture.columns * picture.rows,
          "a picture of the light engine's size is shown, no other");
  require(exposure > Clock::Duration{0}, "an exposure takes time");
  exposure_ = exposure;
  is_shown_ = true;
}

ExposureReport VirtualLight::expose(const std::function<bool()>& go_on) {
  if (!is_shown_) throw LightEngineError(LightFault::Refused, "the virtual light engine was shown no picture");
  is_shown_ = false;
  const auto begin = clock_.now();
  const auto end = begin + exposure_;
  bool goes_on = true;
  try {
    is_on_ = true;
    while (goes_on && clock_.now() < end) {
      clock_.sleep_until(std::min(end, clock_.now() + seconds(0.1)));
      goes_on = go_on() || clock_.now() >= end;
    }
  } catch (...) {
    is_on_ = false;
    throw;
  }
  is_on_ = false;
  // It times the light itself: what the clock overslept is no light.
  const auto lit = goes_on ? exposure_ : std::min(exposure_, clock_.now() - begin);
  return {exposure_, lit, Clock::Duration{0}, goes_on};
}

}  // namespace mezzotint
