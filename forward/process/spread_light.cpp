#include <algorithm>
#include <cstdint>
#include <optional>

#include <tbb/parallel_for.h>

#include "forward/base/error.h"
#include "forward/process/light_rows.h"
#include "forward/process/pixel_taps.h"

namespace mezzotint {

namespace {

// Values at a time in the inner loops: the sum and a source stay in the first-level cache.
constexpr std::size_t block = 2048;

// Which pixel stands at `index`, that may lie outside of 0…count−1; none where it is dark.
std::optional<std::size_t> pixel_at(std::int64_t index, std::size_t count, Surround surround) {
  const auto n = static_cast<std::int64_t>(count);
  if (index >= 0 && index < n) return static_cast<std::size_t>(index);
  if (surround == Surround::Dark) return std::nullopt;
  const std::int64_t period = surround == Surround::Repeat ? n : 2 * n;
  const std::int64_t wrapped = ((index % period) + period) % period;
  return static_cast<std::size_t>(wrapped < n ? wrapped : period - 1 - wrapped);
}

struct WeightedRow {
  const float* values;
  float weight;
};

void set_scaled(float* __restrict out, std::size_t count, WeightedRow a) {
  for (std::size_t i = 0; i < count; ++i) out[i] = a.weight * a.values[i];
}

void add_pair(float* __restrict out, std::size_t count, WeightedRow a, WeightedRow b) {
  for (std::size_t i = 0; i < count; ++i) out[i] += a.weight * a.values[i] + b.weight * b.values[i];
}

// out = Σ weight · row, always summed in the same order.
void blend(std::span<const WeightedRow> rows, std::size_t count, float* out) {
  if (rows.empty()) {
    std::fill_n(out, count, 0.0F);
    return;
  }
  const auto at = [](WeightedRow row, std::size_t start) { return WeightedRow{row.values + start, row.weight}; };
  for (std::size_t start = 0; start < count; start += block) {
    const std::size_t length = std::min(block, count - start);
    set_scaled(out + start, length, at(rows[0], start));
    for (std::size_t k = 1; k < rows.size(); k += 2) {
      const bool alone = k + 1 == rows.size();
      const WeightedRow second = alone ? WeightedRow{rows[k].values, 0.0F} : rows[k + 1];
      add_pair(out + start, length, at(rows[k], start), at(second, start));
    }
  }
}

// One spreading of an image: taps, and the image already spread along its rows.
class LightSpread {
public:
  LightSpread(const GrayImage& image, const PrinterProfile& profile, const ProcessOptions& options)
      : image_(image),
        surround_(options.surround),
        subsamples_(options.subsamples),
        taps_(pixel_taps(profile.blur_sigma / profile.pixel_pitch, options.subsamples)),
        width_(image.columns * options.subsamples),
        wide_(width_ * image.rows) {
    tbb::parallel_for(std::size_t{0}, image.rows, [this](std::size_t row) { widen(row); });
  }

  void sample_row(std::size_t row, std::size_t phase, float* out) const {
    std::vector<WeightedRow> sources;
    const PixelTaps& taps = taps_[phase];
    for (std::size_t k = 0; k < taps.weights.size(); ++k) {
      const auto source = pixel_at(static_cast<std::int64_t>(row + k) + taps.first, image_.rows, surround_);
      if (source) sources.push_back({wide_.data() + *source * width_, taps.weights[k]});
    }
    blend(sources, width_, out);
  }

private:
  // Along the row: every phase on its own over contiguous pixels, then woven together.
  void widen(std::size_t row) {
    const int reach =
        std::max(-taps_.front().first, taps_.back().first + static_cast<int>(taps_.back().weights.size()));
    const std::vector<float> padded = pad(row, reach);
    std::vector<float> phase_row(image_.columns);
    std::vector<WeightedRow> sources;
    for (std::size_t s = 0; s < subsamples_; ++s) {
      sources.clear();
      const float* const start = padded.data() + reach + taps_[s].first;
      for (std::size_t k = 0; k < taps_[s].weights.size(); ++k) sources.push_back({start + k, taps_[s].weights[k]});
      blend(sources, image_.columns, phase_row.data());
      float* const out = wide_.data() + row * width_ + s;
      for (std::size_t i = 0; i < image_.columns; ++i) out[i * subsamples_] = phase_row[i];
    }
  }

  [[nodiscard]] std::vector<float> pad(std::size_t row, int reach) const {
    const float* const pixels = image_.values.data() + row * image_.columns;
    std::vector<float> padded(image_.columns + 2 * static_cast<std::size_t>(reach), 0.0F);
    for (std::size_t i = 0; i < padded.size(); ++i) {
      const auto source = pixel_at(static_cast<std::int64_t>(i) - reach, image_.columns, surround_);
      if (source) padded[i] = pixels[*source];
    }
    return padded;
  }

  const GrayImage& image_;
  Surround surround_;
  std::size_t subsamples_;
  std::vector<PixelTaps> taps_;
  std::size_t width_;
  std::vector<float> wide_;
};

void require_printable(const GrayImage& image, const PrinterProfile& profile, const ProcessOptions& options) {
  require(options.subsamples >= 1 && options.subsamples <= 16, "subsamples must be within 1 and 16");
  require_valid(profile);
  require_valid(image);
  const Length pitch = profile.pixel_pitch / static_cast<double>(options.subsamples);
  require_valid_grid({image.columns * options.subsamples, image.rows * options.subsamples, pitch, pitch});
}

}  // namespace

GrayImage spread_rows(const GrayImage& image, const PrinterProfile& profile, const ProcessOptions& options,
                      const std::function<void(std::span<float>)>& finish) {
  require_printable(image, profile, options);
  const std::size_t subsamples = options.subsamples;
  const LightSpread spread(image, profile, options);
  GrayImage light{image.columns * subsamples, image.rows * subsamples, {}};
  light.values.resize(light.columns * light.rows);
  tbb::parallel_for(std::size_t{0}, image.rows, [&](std::size_t row) {
    for (std::size_t phase = 0; phase < subsamples; ++phase) {
      float* const out = light.values.data() + (row * subsamples + phase) * light.columns;
      spread.sample_row(row, phase, out);
      if (finish) finish({out, light.columns});
    }
  });
  return light;
}

GrayImage spread_light(const GrayImage& image, const PrinterProfile& profile, const ProcessOptions& options) {
  return spread_rows(image, profile, options, {});
}

}  // namespace mezzotint
