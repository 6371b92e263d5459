#include "forward/process/gray_image.h"

#include <algorithm>
#include <cmath>

#include "forward/base/error.h"

namespace mezzotint {

namespace {

// Float heights carry 1e-6 µm of rounding; a pixel that asks for just what is reachable is not saturated.
constexpr double height_slack_um = 1e-5;

bool same_pitch(Length a, Length b) { return std::abs(a / b - 1.0) < 1e-6; }

void require_exposable(const HeightField& heights, const PrinterProfile& profile) {
  require_valid(profile);
  const bool on_pixels = same_pitch(heights.grid().pitch_x, profile.pixel_pitch) &&
                         same_pitch(heights.grid().pitch_y, profile.pixel_pitch);
  require(on_pixels, "an exposure needs one height a pixel: the field's pitch must be the printer's " +
                         std::to_string(profile.pixel_pitch.um()) + " um");
  const std::span<const float> values = heights.heights_um();
  require(std::all_of(values.begin(), values.end(), [](float h) { return std::isfinite(h); }),
          "an exposure needs every height; fill the missing samples first");
}

}  // namespace

void require_valid(const GrayImage& image) {
  require(image.columns >= 1 && image.rows >= 1, "a gray image needs at least one pixel");
  require(image.values.size() / image.columns == image.rows && image.values.size() % image.columns == 0,
          "a gray image needs one value a pixel");
  // Written so that NaN fails too, and without an early exit, so that it runs many values at a time.
  bool good = true;
  for (const float value : image.values) good = good & (value >= 0.0F) & (value <= 1.0F);
  require(good, "gray values must lie within 0 and 1");
}

Exposure expose(const HeightField& pixel_heights, const PrinterProfile& profile) {
  require_exposable(pixel_heights, profile);
  const Length reachable = reachable_height(profile);
  Exposure exposure;
  exposure.image = {pixel_heights.columns(), pixel_heights.rows(), {}};
  exposure.image.values.reserve(pixel_heights.grid().size());
  for (const float height_um : pixel_heights.heights_um()) {
    const Length wanted = Length::from_um(static_cast<double>(height_um));
    if (wanted.um() > reachable.um() + height_slack_um) ++exposure.saturated;
    const double gray = height_to_gray(profile.cure, std::min(wanted, reachable));
    exposure.image.values.push_back(static_cast<float>(std::clamp(gray, 0.0, 1.0)));
  }
  return exposure;
}

GrayImage quantize(const GrayImage& image, const PrinterProfile& profile) {
  require_valid(image);
  require_valid(profile);
  const double steps = profile.gray_levels - 1;
  GrayImage rounded = image;
  for (float& value : rounded.values) {
    value = static_cast<float>(std::round(static_cast<double>(value) * steps) / steps);
  }
  return rounded;
}

}  // namespace mezzotint
