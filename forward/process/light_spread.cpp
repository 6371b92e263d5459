#include "forward/process/light_spread.h"

#include "forward/base/error.h"

namespace mezzotint {

LightSpread light_spread(std::size_t columns, std::size_t rows, const PrinterProfile& profile,
                         const ProcessOptions& options) {
  require(options.subsamples >= 1 && options.subsamples <= 16, "subsamples must be within 1 and 16");
  const auto within = [](double place) { return place >= 0.0 && place <= 1.0; };
  require(within(options.place_x) && within(options.place_y), "a sample's place in its sub-pixel is within 0 and 1");
  require_valid(profile);
  const Length pitch = profile.pixel_pitch / static_cast<double>(options.subsamples);
  require_valid_grid({columns * options.subsamples, rows * options.subsamples, pitch, pitch});
  const double width_pixels = profile.spread.width / profile.pixel_pitch;
  // Without a width both kernels leave each pixel its light, and taps do that at once.
  if (profile.spread.kernel == PixelSpread::Kernel::Gaussian || width_pixels == 0.0)
    return GaussianSpread(columns, rows, width_pixels, options);
  return LorentzianSpread(columns, rows, width_pixels, options);
}

GrayImage spread_light(const GrayImage& image, const PrinterProfile& profile, const ProcessOptions& options) {
  require_valid(image);
  const LightSpread spread = light_spread(image.columns, image.rows, profile, options);
  return std::visit([&](const auto& kernel) { return kernel.apply(image, LightPart::Value, {}); }, spread);
}

}  // namespace mezzotint
