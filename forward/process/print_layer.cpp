#include <cmath>
#include <numbers>

#include "forward/base/error.h"
#include "forward/process/print_process.h"

namespace mezzotint {

HeightField print_layer(const GrayImage& image, const PrinterProfile& profile, const ProcessOptions& options) {
  require_valid(image);
  return PrintProcess(image.columns, image.rows, profile, options).print(image);
}

double pixel_transfer(const PrinterProfile& profile, Length wavelength) {
  require(std::isfinite(wavelength.um()) && wavelength.um() > 0.0, "a wavelength must be positive");
  require_valid(profile);
  const double phase = std::numbers::pi * (profile.pixel_pitch / wavelength);
  const double blur = 2.0 * std::numbers::pi * (profile.spread.width / wavelength);
  const bool gaussian = profile.spread.kernel == PixelSpread::Kernel::Gaussian;
  return std::sin(phase) / phase * std::exp(gaussian ? -0.5 * blur * blur : -blur);
}

}  // namespace mezzotint
