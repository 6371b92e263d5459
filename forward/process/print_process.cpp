#include "forward/process/print_process.h"

#include <algorithm>
#include <cmath>

#include <tbb/parallel_for.h>

#include "forward/base/error.h"
#include "forward/process/fast_cure.h"
#include "forward/process/light_spread.h"

namespace mezzotint {

struct PrintProcess::Parts {
  std::size_t columns, rows;
  PrinterProfile profile;
  ProcessOptions options;
  LightSpread spread;

  void require_image(const GrayImage& image) const {
    require(image.columns == columns && image.rows == rows,
            "the process was made for an image of " + std::to_string(columns) + " × " + std::to_string(rows) +
                " pixels; this one has " + std::to_string(image.columns) + " × " + std::to_string(image.rows));
    require_valid(image);
  }
  [[nodiscard]] GrayImage light(const GrayImage& image, LightPart part, const RowFinish& finish = {}) const {
    return std::visit([&](const auto& kernel) { return kernel.apply(image, part, finish); }, spread);
  }
  [[nodiscard]] std::vector<float> back(const GrayImage& samples, LightPart part) const {
    return std::visit([&](const auto& kernel) { return kernel.transposed(samples, part).values; }, spread);
  }
  [[nodiscard]] GrayImage checked_light(const GrayImage& image, std::span<const float> height_slopes) const {
    require_image(image);
    GrayImage arrived = light(image, LightPart::Value);
    require(height_slopes.size() == arrived.values.size(), "one slope a sample of the printed relief is needed");
    return arrived;
  }
  template <class Visit>
  void for_each_row(GrayImage& samples, std::span<const float> height_slopes, const Visit& visit) const {
    tbb::parallel_for(std::size_t{0}, samples.rows, [&](std::size_t row) {
      const std::size_t start = row * samples.columns;
      visit(row, std::span(samples.values).subspan(start, samples.columns),
            height_slopes.subspan(start, samples.columns));
    });
  }
};

namespace {

// The light between which heights move: above the threshold, and below what fills the layer.
struct MovingLight {
  float from, to;
};

MovingLight moving_light(const PrinterProfile& profile) {
  return {static_cast<float>(threshold_gray(profile.cure)),
          static_cast<float>(height_to_gray(profile.cure, profile.layer))};
}

// From light and ∂J/∂height to ∂J/∂light, in place of the light.
void lead_back(std::span<float> light, std::span<const float> height_slopes, const PrinterProfile& profile) {
  const MovingLight moving = moving_light(profile);
  const auto beta = static_cast<float>(profile.cure.beta.um()), gamma = static_cast<float>(profile.cure.gamma);
  for (std::size_t i = 0; i < light.size(); ++i) {
    const bool moves = light[i] > moving.from && light[i] < moving.to;
    const float dose = moves ? light[i] - gamma : 1.0F;
    light[i] = moves ? height_slopes[i] * beta / dose : 0.0F;
  }
}

// Toward α, β and γ, of one row.
ProfileSlopes curve_slopes(std::span<const float> light, std::span<const float> height_slopes,
                           const PrinterProfile& profile) {
  const MovingLight moving = moving_light(profile);
  ProfileSlopes sum;
  for (std::size_t i = 0; i < light.size(); ++i) {
    if (!(light[i] > moving.from) || !(light[i] < moving.to)) continue;
    const double dose = static_cast<double>(light[i]) - profile.cure.gamma;
    const double slope = static_cast<double>(height_slopes[i]);
    sum.alpha_um += slope;
    sum.beta_um += slope * std::log(dose);
    sum.gamma -= slope * profile.cure.beta.um() / dose;
  }
  return sum;
}

double dot(const GrayImage& a, const GrayImage& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.values.size(); ++i)
    sum += static_cast<double>(a.values[i]) * static_cast<double>(b.values[i]);
  return sum;
}

}  // namespace

PrintProcess::PrintProcess(std::size_t columns, std::size_t rows, const PrinterProfile& profile,
                           const ProcessOptions& options)
    : parts_(new Parts{columns, rows, profile, options, light_spread(columns, rows, profile, options)}) {}
PrintProcess::~PrintProcess() = default;
PrintProcess::PrintProcess(PrintProcess&&) noexcept = default;
PrintProcess& PrintProcess::operator=(PrintProcess&&) noexcept = default;

HeightField PrintProcess::print(const GrayImage& image) const {
  const Parts& parts = *parts_;
  parts.require_image(image);
  const FastCure curve = fast_cure(parts.profile.cure, parts.profile.layer);
  GrayImage heights_um = parts.light(image, LightPart::Value, [&curve](std::span<float> row) { cure(row, curve); });
  const Length pitch = parts.profile.pixel_pitch / static_cast<double>(parts.options.subsamples);
  const bool repeats = parts.options.surround == Surround::Repeat;
  return HeightField({heights_um.columns, heights_um.rows, pitch, pitch},
                     repeats ? Continuation::Periodic : Continuation::Mirrored, std::move(heights_um.values));
}

std::vector<float> PrintProcess::gray_slopes(const GrayImage& image, std::span<const float> height_slopes) const {
  const Parts& parts = *parts_;
  GrayImage light = parts.checked_light(image, height_slopes);
  parts.for_each_row(light, height_slopes, [&](std::size_t, std::span<float> row, std::span<const float> slopes) {
    lead_back(row, slopes, parts.profile);
  });
  return parts.back(light, LightPart::Value);
}

ProfileSlopes PrintProcess::profile_slopes(const GrayImage& image, std::span<const float> height_slopes) const {
  const Parts& parts = *parts_;
  GrayImage light = parts.checked_light(image, height_slopes);
  std::vector<ProfileSlopes> rows(light.rows);
  parts.for_each_row(light, height_slopes, [&](std::size_t i, std::span<float> row, std::span<const float> slopes) {
    rows[i] = curve_slopes(row, slopes, parts.profile);
    lead_back(row, slopes, parts.profile);
  });
  ProfileSlopes sum;
  for (const ProfileSlopes& row : rows) {
    sum.alpha_um += row.alpha_um;
    sum.beta_um += row.beta_um;
    sum.gamma += row.gamma;
  }
  sum.width_um = dot(light, parts.light(image, LightPart::WidthSlope)) / parts.profile.pixel_pitch.um();
  return sum;
}

PrintedSlopes PrintProcess::printed_slopes(const GrayImage& image) const {
  const Parts& parts = *parts_;
  parts.require_image(image);
  PrintedSlopes printed{parts.light(image, LightPart::Value),
                        {parts.light(image, LightPart::SlopeX).values, parts.light(image, LightPart::SlopeY).values}};
  ReliefSlopes& slopes = printed.slopes;
  const MovingLight moving = moving_light(parts.profile);
  const CureCurve& curve = parts.profile.cure;
  const auto steepness = static_cast<float>(curve.beta / parts.profile.pixel_pitch);
  const auto gamma = static_cast<float>(curve.gamma);
  for (std::size_t i = 0; i < slopes.x.size(); ++i) {
    const float gray = printed.light.values[i];
    const bool moves = gray > moving.from && gray < moving.to;
    const float factor = moves ? steepness / (gray - gamma) : 0.0F;
    slopes.x[i] *= factor;
    slopes.y[i] *= factor;
  }
  return printed;
}

ReliefSlopes PrintProcess::slopes(const GrayImage& image) const { return printed_slopes(image).slopes; }

// z_x = β I_x/(I − γ): toward I_x by β/(I − γ), toward I by −z_x/(I − γ).
std::vector<float> PrintProcess::gray_slopes(PrintedSlopes printed, ReliefSlopes toward) const {
  const Parts& parts = *parts_;
  require(toward.x.size() == printed.light.values.size() && toward.y.size() == toward.x.size(),
          "one slope a sample of the printed relief is needed");
  const MovingLight moving = moving_light(parts.profile);
  const auto steepness = static_cast<float>(parts.profile.cure.beta / parts.profile.pixel_pitch);
  const auto gamma = static_cast<float>(parts.profile.cure.gamma);
  for (std::size_t i = 0; i < toward.x.size(); ++i) {
    const float gray = printed.light.values[i];
    const bool moves = gray > moving.from && gray < moving.to;
    const float per_dose = moves ? 1.0F / (gray - gamma) : 0.0F, factor = steepness * per_dose;
    printed.light.values[i] = -per_dose * (toward.x[i] * printed.slopes.x[i] + toward.y[i] * printed.slopes.y[i]);
    toward.x[i] *= factor;
    toward.y[i] *= factor;
  }
  const std::size_t columns = printed.light.columns, rows = printed.light.rows;
  const std::vector<float> by_x = parts.back({columns, rows, std::move(toward.x)}, LightPart::SlopeX),
                           by_y = parts.back({columns, rows, std::move(toward.y)}, LightPart::SlopeY);
  std::vector<float> slopes = parts.back(printed.light, LightPart::Value);
  for (std::size_t i = 0; i < slopes.size(); ++i) slopes[i] += by_x[i] + by_y[i];
  return slopes;
}

std::vector<float> PrintProcess::gray_slopes(const GrayImage& image, const ReliefSlopes& toward) const {
  return gray_slopes(printed_slopes(image), toward);
}

std::vector<float> wanted_height_slopes(const HeightField& pixel_heights, const GrayImage& gray,
                                        const PrinterProfile& profile, std::span<const float> gray_slopes) {
  require(gray_slopes.size() == gray.values.size() && gray.values.size() == pixel_heights.heights_um().size(),
          "one gray value and one slope a pixel is needed");
  const double reachable_um = reachable_height(profile).um();
  std::vector<float> slopes(gray_slopes.size());
  for (std::size_t i = 0; i < slopes.size(); ++i) {
    const double wanted_um = static_cast<double>(pixel_heights.heights_um()[i]);
    const double dose = static_cast<double>(gray.values[i]) - profile.cure.gamma;
    const bool moves = wanted_um > 0.0 && wanted_um < reachable_um;
    slopes[i] = static_cast<float>(moves ? static_cast<double>(gray_slopes[i]) * dose / profile.cure.beta.um() : 0.0);
  }
  return slopes;
}

}  // namespace mezzotint
