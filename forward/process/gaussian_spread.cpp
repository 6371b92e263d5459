#include "forward/process/gaussian_spread.h"

#include <algorithm>
#include <cstdint>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include "forward/process/row_blend.h"
#include "forward/process/surrounding_pixel.h"

namespace mezzotint {

namespace {

void add_scaled(float* __restrict out, std::size_t count, WeightedRow a) {
  for (std::size_t i = 0; i < count; ++i) out[i] += a.weight * a.values[i];
}

std::vector<float> padded(const float* pixels, std::size_t count, int reach, Surround surround) {
  std::vector<float> values(count + 2 * static_cast<std::size_t>(reach), 0.0F);
  for (std::size_t i = 0; i < values.size(); ++i) {
    const auto source = pixel_at(static_cast<std::int64_t>(i) - reach, count, surround);
    if (source) values[i] = pixels[*source];
  }
  return values;
}

}  // namespace

GaussianSpread::GaussianSpread(std::size_t columns, std::size_t rows, double sigma_pixels,
                               const ProcessOptions& options)
    : columns_(columns), rows_(rows), width_(columns * options.subsamples), sigma_(sigma_pixels), options_(options) {}

GaussianSpread::Taps GaussianSpread::taps_x(TapKind kind) const {
  return pixel_taps(kind, sigma_, options_.subsamples, options_.place_x);
}
GaussianSpread::Taps GaussianSpread::taps_y(TapKind kind) const {
  return pixel_taps(kind, sigma_, options_.subsamples, options_.place_y);
}

GaussianSpread::Wide GaussianSpread::widen(const GrayImage& image, const Taps& taps) const {
  Wide wide(width_ * rows_);
  tbb::parallel_for(std::size_t{0}, rows_, [&](std::size_t row) {
    widen_row(image.values.data() + row * columns_, taps, wide.data() + row * width_);
  });
  return wide;
}

// Every phase on its own over contiguous pixels, then woven together.
void GaussianSpread::widen_row(const float* pixels, const Taps& taps, float* out) const {
  const int reach = std::max(-taps.front().first, taps.back().first + static_cast<int>(taps.back().weights.size()));
  const std::vector<float> values = padded(pixels, columns_, reach, options_.surround);
  std::vector<float> phase_row(columns_);
  std::vector<WeightedRow> sources;
  for (std::size_t s = 0; s < taps.size(); ++s) {
    sources.clear();
    const float* const start = values.data() + reach + taps[s].first;
    for (std::size_t k = 0; k < taps[s].weights.size(); ++k) sources.push_back({start + k, taps[s].weights[k]});
    blend(sources, columns_, phase_row.data());
    for (std::size_t i = 0; i < columns_; ++i) out[i * taps.size() + s] = phase_row[i];
  }
}

void GaussianSpread::sample_row(const Wide& wide, std::size_t row, const PixelTaps& taps, float* out) const {
  std::vector<WeightedRow> sources;
  for (std::size_t k = 0; k < taps.weights.size(); ++k) {
    const auto source = pixel_at(static_cast<std::int64_t>(row + k) + taps.first, rows_, options_.surround);
    if (source) sources.push_back({wide.data() + *source * width_, taps.weights[k]});
  }
  blend(sources, width_, out);
}

GrayImage GaussianSpread::spread(const GrayImage& image, const Taps& along_x, const Taps& along_y,
                                 const RowFinish& finish) const {
  const Wide wide = widen(image, along_x);
  GrayImage light{width_, rows_ * options_.subsamples, {}};
  light.values.resize(light.columns * light.rows);
  tbb::parallel_for(std::size_t{0}, rows_, [&](std::size_t row) {
    for (std::size_t phase = 0; phase < options_.subsamples; ++phase) {
      float* const out = light.values.data() + (row * options_.subsamples + phase) * width_;
      sample_row(wide, row, along_y[phase], out);
      if (finish) finish({out, width_});
    }
  });
  return light;
}

GrayImage GaussianSpread::apply(const GrayImage& image, LightPart part, const RowFinish& finish) const {
  const auto along = [](bool steep) { return steep ? TapKind::PlaceSlope : TapKind::Value; };
  if (part != LightPart::WidthSlope)
    return spread(image, taps_x(along(part == LightPart::SlopeX)), taps_y(along(part == LightPart::SlopeY)), finish);
  // Along one axis the slopes, along the other the values, and the other way round.
  GrayImage light = spread(image, taps_x(TapKind::WidthSlope), taps_y(TapKind::Value), {});
  const GrayImage second = spread(image, taps_x(TapKind::Value), taps_y(TapKind::WidthSlope), {});
  for (std::size_t i = 0; i < light.values.size(); ++i) light.values[i] += second.values[i];
  return light;
}

// Down the columns, a strip of them at a time: every strip is summed in the same order.
GrayImage GaussianSpread::gather_rows(const GrayImage& samples, const Taps& taps) const {
  GrayImage gathered{width_, rows_, std::vector<float>(width_ * rows_, 0.0F)};
  constexpr std::size_t strip = 256;
  tbb::parallel_for(std::size_t{0}, (width_ + strip - 1) / strip, [&](std::size_t index) {
    const std::size_t start = index * strip, length = std::min(strip, width_ - start);
    for (std::size_t row = 0; row < rows_; ++row) {
      for (std::size_t s = 0; s < taps.size(); ++s) {
        const float* const values = samples.values.data() + (row * options_.subsamples + s) * width_ + start;
        for (std::size_t k = 0; k < taps[s].weights.size(); ++k) {
          const auto pixel = pixel_at(static_cast<std::int64_t>(row + k) + taps[s].first, rows_, options_.surround);
          if (pixel) add_scaled(gathered.values.data() + *pixel * width_ + start, length, {values, taps[s].weights[k]});
        }
      }
    }
  });
  return gathered;
}

// The transposed of widen_row: every phase on its own onto contiguous pixels, some of them beyond the edges.
void GaussianSpread::narrow_row(const float* samples, const Taps& taps, float* pixels) const {
  const int reach = std::max(-taps.front().first, taps.back().first + static_cast<int>(taps.back().weights.size()));
  std::vector<float> sums(columns_ + 2 * static_cast<std::size_t>(reach), 0.0F), phase_row(columns_);
  for (std::size_t s = 0; s < taps.size(); ++s) {
    for (std::size_t i = 0; i < columns_; ++i) phase_row[i] = samples[i * taps.size() + s];
    for (std::size_t k = 0; k < taps[s].weights.size(); ++k) {
      add_scaled(sums.data() + reach + taps[s].first + k, columns_, {phase_row.data(), taps[s].weights[k]});
    }
  }
  for (std::size_t i = 0; i < sums.size(); ++i) {
    const auto pixel = pixel_at(static_cast<std::int64_t>(i) - reach, columns_, options_.surround);
    if (pixel) pixels[*pixel] += sums[i];
  }
}

GrayImage GaussianSpread::transposed(const GrayImage& samples, LightPart part) const {
  const auto along = [](bool steep) { return steep ? TapKind::PlaceSlope : TapKind::Value; };
  const Taps along_x = taps_x(along(part == LightPart::SlopeX)), along_y = taps_y(along(part == LightPart::SlopeY));
  const GrayImage gathered = gather_rows(samples, along_y);
  GrayImage pixels{columns_, rows_, std::vector<float>(columns_ * rows_, 0.0F)};
  tbb::parallel_for(std::size_t{0}, rows_, [&](std::size_t row) {
    narrow_row(gathered.values.data() + row * width_, along_x, pixels.values.data() + row * columns_);
  });
  return pixels;
}

}  // namespace mezzotint
