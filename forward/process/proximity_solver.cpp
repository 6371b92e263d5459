#include "forward/process/proximity_solver.h"

#include <algorithm>
#include <cmath>
#include <span>

#include <tbb/parallel_for.h>

#include "forward/process/fast_cure.h"
#include "forward/process/light_spread.h"

namespace mezzotint {

namespace {

// Dose below which a gray value means nothing, for curves whose γ is not negative.
constexpr double least_dose = 1e-3;
// Steps this small on average move no gray level.
constexpr double least_step_um = 2e-3;

// Gray as the height that it would cure to on its own, even where that is negative: what the steps are taken in.
struct DoseScale {
  float alpha_um, beta_um, gamma, lowest_um, highest_um;

  explicit DoseScale(const CureCurve& curve)
      : alpha_um(static_cast<float>(curve.alpha.um())),
        beta_um(static_cast<float>(curve.beta.um())),
        gamma(static_cast<float>(curve.gamma)),
        lowest_um(
            static_cast<float>(curve.alpha.um() + curve.beta.um() * std::log(std::max(-curve.gamma, least_dose)))),
        highest_um(static_cast<float>(curve.alpha.um() + curve.beta.um() * std::log(1.0 - curve.gamma))) {}

  [[nodiscard]] float gray(float height_um) const {
    if (height_um <= lowest_um) return 0.0F;
    return std::clamp(std::exp((height_um - alpha_um) / beta_um) + gamma, 0.0F, 1.0F);
  }
};

class Process {
public:
  Process(const ProximityTile& tile, const PrinterProfile& profile, const ProcessOptions& options)
      : tile_(tile),
        curve_(fast_cure(profile.cure, profile.layer)),
        spread_(light_spread(tile.columns, tile.rows, profile, options)),
        subsamples_(options.subsamples),
        means_(tile.wanted_um.size() == tile.columns * tile.rows) {}

  [[nodiscard]] GrayImage light(const GrayImage& image) const {
    return std::visit([&](const auto& kernel) { return kernel.apply(image, LightPart::Value, {}); }, spread_);
  }
  [[nodiscard]] std::vector<float> back(const GrayImage& samples) const {
    return std::visit([&](const auto& kernel) { return kernel.transposed(samples, LightPart::Value).values; }, spread_);
  }

  // Wanted − printed, in place of the light: of every sample, or of the pixel's mean at every sample. `share` becomes
  // ∂height/∂gray over β where the height follows the light, or should; else 0.
  void compare(GrayImage& light, GrayImage& share) const {
    tbb::parallel_for(std::size_t{0}, tile_.rows, [&](std::size_t row) {
      const std::size_t width = light.columns, start = row * subsamples_ * width;
      const auto part = [&](GrayImage& field) { return std::span(field.values).subspan(start, subsamples_ * width); };
      std::vector<float> heights(part(light).begin(), part(light).end());
      cure(heights, curve_);
      if (means_) take_means(heights, width);
      for (std::size_t s = 0; s < subsamples_; ++s) compare_row(part(light), part(share), heights, row, s);
    });
  }

private:
  void take_means(std::span<float> heights, std::size_t width) const {
    const float scale = 1.0F / static_cast<float>(subsamples_ * subsamples_);
    for (std::size_t column = 0; column < tile_.columns; ++column) {
      float sum = 0.0F;
      for (std::size_t s = 0; s < subsamples_; ++s)
        for (std::size_t k = 0; k < subsamples_; ++k) sum += heights[s * width + column * subsamples_ + k];
      for (std::size_t s = 0; s < subsamples_; ++s)
        for (std::size_t k = 0; k < subsamples_; ++k) heights[s * width + column * subsamples_ + k] = scale * sum;
    }
  }
  void compare_row(std::span<float> light, std::span<float> share, std::span<const float> heights, std::size_t row,
                   std::size_t s) const {
    const std::size_t width = tile_.columns * subsamples_;
    for (std::size_t i = 0; i < width; ++i) {
      const std::size_t at = s * width + i, pixel = row * tile_.columns + i / subsamples_;
      const bool off = !tile_.dark.empty() && tile_.dark[pixel] != 0;
      const float wanted = means_ ? tile_.wanted_um[pixel] : tile_.wanted_um[(row * subsamples_ + s) * width + i];
      const float gray = light[at];
      const bool idle = off || (wanted <= 0.0F && gray <= curve_.threshold);
      const float dose = std::max(gray - curve_.gamma, static_cast<float>(least_dose));
      light[at] = off ? 0.0F : wanted - heights[at];
      share[at] = idle ? 0.0F : 1.0F / dose;
    }
  }

  const ProximityTile& tile_;
  FastCure curve_;
  LightSpread spread_;
  std::size_t subsamples_;
  bool means_;
};

GrayImage gray_of(const ProximityTile& tile, const DoseScale& scale, std::span<const float> heights_um) {
  GrayImage image{tile.columns, tile.rows, std::vector<float>(heights_um.size())};
  for (std::size_t i = 0; i < heights_um.size(); ++i) image.values[i] = scale.gray(heights_um[i]);
  return image;
}

std::vector<float> pixel_means(const ProximityTile& tile) {
  const std::size_t pixels = tile.columns * tile.rows;
  if (tile.wanted_um.size() == pixels) return tile.wanted_um;
  const auto n = static_cast<std::size_t>(
      std::lround(std::sqrt(static_cast<double>(tile.wanted_um.size()) / static_cast<double>(pixels))));
  std::vector<float> means(pixels, 0.0F);
  for (std::size_t r = 0; r < tile.rows * n; ++r)
    for (std::size_t c = 0; c < tile.columns * n; ++c)
      means[r / n * tile.columns + c / n] += tile.wanted_um[r * tile.columns * n + c];
  for (float& mean : means) mean /= static_cast<float>(n * n);
  return means;
}

bool is_dark(const ProximityTile& tile, std::size_t pixel) { return !tile.dark.empty() && tile.dark[pixel] != 0; }

// The starting heights: what is wanted of each pixel on its own, and nothing at all where nothing is wanted.
std::vector<float> first_heights(const ProximityTile& tile, const DoseScale& scale) {
  std::vector<float> heights = pixel_means(tile);
  for (std::size_t i = 0; i < heights.size(); ++i) {
    const bool none = is_dark(tile, i) || heights[i] <= 0.0F;
    heights[i] = none ? scale.lowest_um : std::min(heights[i], scale.highest_um);
  }
  return heights;
}

// Heights that were tried: the sum of their squared errors, and the step of every pixel, which is the mean of the
// errors that its light reaches, each by this light's share.
struct Trial {
  std::vector<float> heights_um, moves_um;
  double squares = 0.0;
};

Trial try_out(const ProximityTile& tile, const Process& process, const DoseScale& scale,
              std::vector<float> heights_um) {
  GrayImage errors = process.light(gray_of(tile, scale, heights_um));
  GrayImage share{errors.columns, errors.rows, std::vector<float>(errors.values.size())};
  process.compare(errors, share);
  Trial trial{std::move(heights_um), {}, 0.0};
  for (std::size_t i = 0; i < errors.values.size(); ++i) {
    trial.squares += static_cast<double>(errors.values[i]) * static_cast<double>(errors.values[i]);
    errors.values[i] *= share.values[i];
  }
  trial.moves_um = process.back(errors);
  const std::vector<float> weights = process.back(share);
  for (std::size_t i = 0; i < weights.size(); ++i) {
    float& move = trial.moves_um[i];
    move = weights[i] > 1e-6F ? move / weights[i] : 0.0F;
  }
  return trial;
}

std::vector<float> moved(const ProximityTile& tile, const DoseScale& scale, const Trial& from, float share) {
  std::vector<float> to(from.heights_um.size());
  for (std::size_t i = 0; i < to.size(); ++i) {
    const float height = from.heights_um[i] + share * from.moves_um[i];
    to[i] = is_dark(tile, i) ? scale.lowest_um : std::clamp(height, scale.lowest_um, scale.highest_um);
  }
  return to;
}

// Goes on from `from` by as much as that came from `before`, times `push`.
std::vector<float> extrapolated(const std::vector<float>& from, const std::vector<float>& before, float push) {
  std::vector<float> ahead(from.size());
  for (std::size_t i = 0; i < from.size(); ++i) ahead[i] = from[i] + push * (from[i] - before[i]);
  return ahead;
}

double rms_difference(const std::vector<float>& a, const std::vector<float>& b) {
  double squares = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const double difference = static_cast<double>(a[i]) - static_cast<double>(b[i]);
    squares += difference * difference;
  }
  return std::sqrt(squares / static_cast<double>(a.size()));
}

}  // namespace

std::vector<float> relief_errors(const ProximityTile& tile, const GrayImage& image, const PrinterProfile& profile,
                                 const ProcessOptions& process) {
  const Process printer(tile, profile, process);
  GrayImage errors = printer.light(image);
  GrayImage share{errors.columns, errors.rows, std::vector<float>(errors.values.size())};
  printer.compare(errors, share);
  for (float& error : errors.values) error = -error;
  return errors.values;
}

GrayImage exposed(const ProximityTile& tile, const PrinterProfile& profile) {
  const DoseScale scale(profile.cure);
  return gray_of(tile, scale, first_heights(tile, scale));
}

GrayImage solve_proximity(const ProximityTile& tile, const PrinterProfile& profile, const ProcessOptions& options,
                          std::size_t steps) {
  const Process process(tile, profile, options);
  const DoseScale scale(profile.cure);
  Trial best = try_out(tile, process, scale, first_heights(tile, scale));
  std::vector<float> reached = best.heights_um;
  double momentum = 1.0;
  float share = 1.0F;
  std::vector<float> next = moved(tile, scale, best, share), ahead = next;
  for (std::size_t k = 0; k < steps; ++k) {
    Trial trial = try_out(tile, process, scale, ahead);
    const bool better = trial.squares < best.squares;
    if (better) {
      best = std::move(trial);
    } else {
      // At steep edges the bound does not hold: back to the best, and more carefully.
      share *= 0.5F;
      momentum = 1.0;
    }
    reached = std::move(next);
    next = moved(tile, scale, best, share);
    if (rms_difference(next, best.heights_um) < least_step_um) break;
    const double grown = 0.5 * (1.0 + std::sqrt(1.0 + 4.0 * momentum * momentum));
    ahead = better ? extrapolated(next, reached, static_cast<float>((momentum - 1.0) / grown)) : next;
    momentum = grown;
  }
  return gray_of(tile, scale, best.heights_um);
}

}  // namespace mezzotint
