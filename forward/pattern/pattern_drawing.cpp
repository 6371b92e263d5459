#include "forward/pattern/pattern_drawing.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>

#include <tbb/parallel_for.h>

#include "forward/pattern/line_integral_convolution.h"
#include "forward/pattern/noise_scatter.h"
#include "forward/pattern/octave_sum.h"
#include "forward/pattern/pattern_tree.h"

namespace mezzotint {

namespace {

constexpr double pi = std::numbers::pi;

template <typename Kind>
concept OfOctaves = requires(const Kind& kind) {
  octave_sum(kind);
};

template <typename GrayOf>
std::vector<float> fill(const Sheet& sheet, const PatternMap& map, const GrayOf& gray_of) {
  std::vector<float> gray(sheet.grid.size());
  tbb::parallel_for(std::size_t{0}, sheet.grid.rows, [&](std::size_t row) {
    const double y = static_cast<double>(row) * sheet.grid.pitch_y.um();
    for (std::size_t column = 0; column < sheet.grid.columns; ++column) {
      const auto [u, v] = map(static_cast<double>(column) * sheet.grid.pitch_x.um(), y);
      gray[row * sheet.grid.columns + column] = static_cast<float>(gray_of(u, v));
    }
  });
  return gray;
}

template <OfOctaves Kind>
std::vector<float> draw(const Kind& kind, const Sheet& sheet) {
  const OctaveSum sum = octave_sum(kind);
  std::vector<float> gray(sheet.grid.size(), static_cast<float>(sum.offset));
  std::vector<float> layer(sum.absolute ? gray.size() : 0);
  for (const Octave& octave : sum.octaves) {
    const PatternMap map = fitted(in_units(map_of(kind, sheet), 1.0 / octave.frequency, 1.0 / octave.frequency), sheet);
    const NoiseLattice lattice(octave.seed, kind.hash, map, sheet);
    if (!sum.absolute) {
      add_sparse_noise(gray, sheet.grid, map, lattice, 0.0, octave.weight);
      continue;
    }
    std::ranges::fill(layer, 0.0F);
    add_sparse_noise(layer, sheet.grid, map, lattice, 0.0, octave.weight);
    std::ranges::transform(gray, layer, gray.begin(), [](float a, float b) { return a + std::abs(b); });
  }
  return gray;
}

std::vector<float> draw(const LineIntegralConvolution& lines, const Sheet& sheet) { return draw_lines(lines, sheet); }

std::vector<float> draw(const Sinusoid& sinusoid, const Sheet& sheet) {
  return fill(sheet, fitted(map_of(sinusoid, sheet), sheet),
              [](double u, double v) { return 0.5 * std::sin(2.0 * pi * u) * std::sin(2.0 * pi * v) + 0.5; });
}

std::vector<float> draw(const Ridges& ridges, const Sheet& sheet) {
  return fill(sheet, fitted_along_u(map_of(ridges, sheet), sheet), [skew = ridges.skew](double u, double) {
    const double phase = u - std::floor(u);
    return phase < skew ? phase / skew : (1.0 - phase) / (1.0 - skew);
  });
}

std::vector<float> draw(const PatternSum& sum, const Sheet& sheet) {
  std::vector<float> gray(sheet.grid.size(), 0.0F);
  const Length height = height_of(sum);
  for (const PatternPart& part : sum.parts) {
    const auto share = static_cast<float>(height_of(part.pattern) / height);
    const std::vector<float> own = draw_gray(part.pattern, sheet);
    std::ranges::transform(gray, own, gray.begin(), [share](float a, float b) { return a + share * b; });
  }
  return gray;
}

std::vector<float> draw(const PatternProduct& product, const Sheet& sheet) {
  std::vector<float> gray(sheet.grid.size(), 1.0F);
  for (const PatternPart& part : product.parts) {
    std::ranges::transform(gray, draw_gray(part.pattern, sheet), gray.begin(), std::multiplies<float>());
  }
  return gray;
}

std::vector<float> draw(const TurnedPattern& turned, const Sheet& sheet) {
  return draw_gray(turned.parts[0].pattern, sheet_below(turned, sheet));
}

// How much of the inner part is seen where the mask has that value.
float inside(const MaskedPattern& masked, float value) {
  const double over = static_cast<double>(value) - masked.threshold;
  if (masked.softness == 0.0) return over >= 0.0 ? 1.0F : 0.0F;
  const double t = std::clamp(0.5 + over / masked.softness, 0.0, 1.0);
  return static_cast<float>(t * t * (3.0 - 2.0 * t));
}

std::vector<float> draw(const MaskedPattern& masked, const Sheet& sheet) {
  const Length height = height_of(masked);
  const auto share = [&](std::size_t part) {
    return static_cast<float>(height_of(masked.parts[part].pattern) / height);
  };
  const float inner = share(0), outer = share(1);
  std::vector<float> gray = draw_gray(masked.parts[2].pattern, sheet);
  const std::vector<float> in = draw_gray(masked.parts[0].pattern, sheet),
                           out = draw_gray(masked.parts[1].pattern, sheet);
  for (std::size_t i = 0; i < gray.size(); ++i) {
    const float seen = inside(masked, gray[i]);
    gray[i] = seen * inner * in[i] + (1.0F - seen) * outer * out[i];
  }
  return gray;
}

std::uint8_t label_at(const PatternRegions& regions, double u, double v) {
  const auto pixel = [](double pictures, std::size_t count) {
    const double place = (pictures - std::floor(pictures)) * static_cast<double>(count);
    return std::min(static_cast<std::size_t>(place), count - 1);
  };
  return regions.labels[pixel(v, regions.rows) * regions.columns + pixel(u, regions.columns)];
}

std::vector<float> draw(const PatternRegions& regions, const Sheet& sheet) {
  const Length height = height_of(regions);
  const std::vector<float> labels =
      fill(sheet, fitted(map_of(regions, sheet), sheet), [&](double u, double v) { return label_at(regions, u, v); });
  std::vector<float> gray(sheet.grid.size(), 0.0F);
  for (const PatternPart& part : regions.parts) {
    const auto label = static_cast<float>(part.label), share = static_cast<float>(height_of(part.pattern) / height);
    const std::vector<float> own = draw_gray(part.pattern, sheet);
    for (std::size_t i = 0; i < gray.size(); ++i) {
      if (labels[i] == label) gray[i] = share * own[i];
    }
  }
  return gray;
}

}  // namespace

std::vector<float> draw_gray(const Pattern& pattern, const Sheet& sheet) {
  std::vector<float> gray = std::visit([&](const auto& kind) { return draw(kind, sheet); }, pattern);
  for (float& value : gray) value = std::clamp(value, 0.0F, 1.0F);
  return gray;
}

}  // namespace mezzotint
