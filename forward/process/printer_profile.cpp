#include "forward/process/printer_profile.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "forward/base/error.h"

namespace mezzotint {

namespace {

// Wider light is no projector's blur, and its taps would eat the memory.
constexpr double widest_blur_pixels = 64.0;

bool positive(double value) { return std::isfinite(value) && value > 0.0; }
bool at_least_zero(double value) { return std::isfinite(value) && value >= 0.0; }

void require_valid_light(const PrinterProfile& profile) {
  require(positive(profile.exposure_s), "printer profile: exposure_s must be positive");
  require(profile.led_amplitude >= 1 && profile.led_amplitude <= 255,
          "printer profile: led_amplitude must be within 1 and 255");
  require(profile.gray_levels >= 2 && profile.gray_levels <= 65536,
          "printer profile: gray_levels must be within 2 and 65536");
  const bool gaussian = profile.spread.kernel == PixelSpread::Kernel::Gaussian;
  const std::string key = gaussian ? "printer profile: [blur] sigma_um" : "printer profile: [blur] half_width_um";
  require(at_least_zero(profile.spread.width.um()), key + " must be 0 or more");
  require(profile.spread.width / profile.pixel_pitch <= widest_blur_pixels, key + " must be at most 64 pixels");
  require_valid(profile.cure);
}

void require_valid_ground(const PrinterProfile& profile) {
  require(at_least_zero(profile.ground_amplitude.um()), "printer profile: [ground] amplitude_um must be 0 or more");
  for (const GroundOctave& octave : profile.ground) {
    require(std::isfinite(octave.weight), "printer profile: the weights of the ground must be finite");
    require(positive(octave.scale.um()), "printer profile: scale_um of the [ground] octaves must be positive");
  }
}

}  // namespace

std::string_view kernel_name(PixelSpread::Kernel kernel) {
  return kernel == PixelSpread::Kernel::Gaussian ? "gaussian" : "lorentzian";
}

void require_valid(const PrinterProfile& profile) {
  require(profile.pixels_x >= 1 && profile.pixels_x <= 65535, "printer profile: pixels_x must be within 1 and 65535");
  require(profile.pixels_y >= 1 && profile.pixels_y <= 65535, "printer profile: pixels_y must be within 1 and 65535");
  require(positive(profile.pixel_pitch.um()), "printer profile: pixel_pitch_um must be positive");
  require(positive(profile.layer.um()), "printer profile: layer_um must be positive");
  require_valid_light(profile);
  require_valid_ground(profile);
}

Length reachable_height(const PrinterProfile& profile) {
  return std::min(gray_to_height(profile.cure, 1.0), profile.layer);
}

}  // namespace mezzotint
