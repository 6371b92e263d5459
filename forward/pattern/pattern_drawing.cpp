#include "forward/pattern/pattern_drawing.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <tbb/parallel_for.h>

#include "forward/pattern/line_integral_convolution.h"
#include "forward/pattern/noise_scatter.h"
#include "forward/pattern/octave_sum.h"
#include "forward/pattern/pattern_place.h"

namespace mezzotint {

namespace {

constexpr double pi = std::numbers::pi;

template <typename Kind>
concept OfOctaves = requires(const Kind& kind) {
  octave_sum(kind);
};

Drawing blank(const PatternPlace& place, float gray) {
  return {std::vector<float>(place.sheet.grid.size(), gray), std::vector<std::vector<float>>(place.names.size())};
}

template <typename Set>
void for_each_sample(const Sheet& sheet, const PatternMap& map, const Set& set) {
  tbb::parallel_for(std::size_t{0}, sheet.grid.rows, [&](std::size_t row) {
    const double y = static_cast<double>(row) * sheet.grid.pitch_y.um();
    for (std::size_t column = 0; column < sheet.grid.columns; ++column) {
      const auto [u, v] = map(static_cast<double>(column) * sheet.grid.pitch_x.um(), y);
      set(row * sheet.grid.columns + column, u, v);
    }
  });
}

// ∂gray/∂u and ∂gray/∂v of a simple kind, in its own units.
struct Gradient {
  std::vector<float> u, v;
};

bool moves_with_any(const SteepMap& map) {
  for (std::size_t k = 0; k < map.slopes.size(); ++k) {
    if (map.moves(k)) return true;
  }
  return false;
}

// What gray changes as the map moves its u and v.
void add_moves(Drawing& drawing, const Sheet& sheet, const SteepMap& map, const Gradient& gradient) {
  for (std::size_t k = 0; k < map.slopes.size(); ++k) {
    if (!map.moves(k)) continue;
    std::vector<float>& toward = drawing.toward(k);
    for_each_sample(sheet, map.slopes[k], [&](std::size_t i, double u, double v) {
      toward[i] += static_cast<float>(gradient.u[i] * u + gradient.v[i] * v);
    });
  }
}

template <typename GrayOf, typename SlopesOf>
void draw_function(Drawing& drawing, const Sheet& sheet, const SteepMap& map, const GrayOf& gray_of,
                   const SlopesOf& slopes_of) {
  for_each_sample(sheet, map.map,
                  [&](std::size_t i, double u, double v) { drawing.gray[i] = static_cast<float>(gray_of(u, v)); });
  if (!moves_with_any(map)) return;
  Gradient gradient{std::vector<float>(drawing.gray.size()), std::vector<float>(drawing.gray.size())};
  for_each_sample(sheet, map.map, [&](std::size_t i, double u, double v) {
    const auto [along_u, along_v] = slopes_of(u, v);
    gradient.u[i] = static_cast<float>(along_u);
    gradient.v[i] = static_cast<float>(along_v);
  });
  add_moves(drawing, sheet, map, gradient);
}

// ------------------------------------------------------------------------------------------------ octaves

// Toward which numbers an octave's weight and frequency change, and by how much, relatively.
struct OctaveSlopes {
  std::vector<double> weight, frequency;
};

template <typename Kind>
OctaveSlopes octave_slopes(const Kind&, const PatternPlace& place, int) {
  return {std::vector<double>(place.names.size(), 0.0), std::vector<double>(place.names.size(), 0.0)};
}
OctaveSlopes octave_slopes(const FractionalBrownianMotion& motion, const PatternPlace& place, int octave) {
  OctaveSlopes slopes{std::vector<double>(place.names.size(), 0.0), std::vector<double>(place.names.size(), 0.0)};
  const WeightSlopes weight = weight_slopes(motion, octave);
  if (const auto number = place.find("hurst")) slopes.weight[*number] = weight.toward_hurst;
  if (const auto number = place.find("lacunarity")) {
    slopes.weight[*number] = weight.toward_lacunarity;
    slopes.frequency[*number] = octave / motion.lacunarity;
  }
  return slopes;
}

// A layer of noise: weight·n or its magnitude.
class OctaveLayer {
public:
  OctaveLayer(const PatternPlace& place, const SteepMap& map, const OctaveSlopes& slopes)
      : place_(place), map_(map), slopes_(slopes), values_(place.sheet.grid.size()) {
    if (!moves_with_any(map_)) return;
    gradient_ = {std::vector<float>(values_.size()), std::vector<float>(values_.size())};
  }

  void add_to(Drawing& drawing, const NoiseLattice& lattice, double weight, bool absolute) {
    add_sparse_noise(values_, place_.sheet.grid, map_.map, lattice, 0.0, weight, gradient_.u, gradient_.v);
    if (absolute) {
      for (std::size_t i = 0; i < gradient_.u.size(); ++i) {
        if (values_[i] < 0.0F) gradient_.u[i] = -gradient_.u[i], gradient_.v[i] = -gradient_.v[i];
      }
      for (float& value : values_) value = std::abs(value);
    }
    std::ranges::transform(drawing.gray, values_, drawing.gray.begin(), std::plus<float>());
    add_moves(drawing, place_.sheet, map_, gradient_);
    for (std::size_t k = 0; k < slopes_.weight.size(); ++k) {
      if (slopes_.weight[k] == 0.0) continue;
      const auto share = static_cast<float>(slopes_.weight[k]);
      std::ranges::transform(drawing.toward(k), values_, drawing.toward(k).begin(),
                             [share](float a, float b) { return a + share * b; });
    }
  }

private:
  const PatternPlace& place_;
  const SteepMap& map_;
  const OctaveSlopes& slopes_;
  std::vector<float> values_;
  Gradient gradient_;
};

// The map of an octave that is so many times as fine as the coarsest.
SteepMap octave_map(const SteepMap& coarsest, double frequency, const OctaveSlopes& slopes) {
  SteepMap map{in_units(coarsest.map, 1.0 / frequency, 1.0 / frequency), {}};
  for (std::size_t k = 0; k < coarsest.slopes.size(); ++k) {
    const double own = slopes.frequency[k];
    map.slopes.push_back(sum(scaled(coarsest.slopes[k], frequency, frequency), scaled(map.map, own, own)));
  }
  return map;
}

template <OfOctaves Kind>
Drawing draw(const Kind& kind, const PatternPlace& place) {
  const OctaveSum sum = octave_sum(kind);
  const SteepMap coarsest = steep_map(kind, place);
  Drawing drawing = blank(place, static_cast<float>(sum.offset));
  int number = 0;
  for (const Octave& octave : sum.octaves) {
    const OctaveSlopes slopes = octave_slopes(kind, place, number++);
    SteepMap map = octave_map(coarsest, octave.frequency, slopes);
    map.map = fitted(map.map, place.sheet);
    const NoiseLattice lattice(octave.seed, kind.hash, map.map, place.sheet);
    OctaveLayer(place, map, slopes).add_to(drawing, lattice, octave.weight, sum.absolute);
  }
  return drawing;
}

// ------------------------------------------------------------------------------------------------ line fields

// How far a number may go for its differences: no point of the sheet moves by more than 0.004 cells of the noise.
double difference_step(const PatternMap& slope, const Sheet& sheet) {
  double fastest = 0.0;
  for (const double x : {0.0, sheet.width_um()}) {
    for (const double y : {0.0, sheet.depth_um()}) {
      const auto [u, v] = slope(x, y);
      fastest = std::max(fastest, std::hypot(u, v));
    }
  }
  return 0.004 / fastest;
}

LineIntegralConvolution changed(LineIntegralConvolution lines, const PatternPlace& place, std::size_t k, double step) {
  if (place.find("scale_um") == k) lines.scale = lines.scale + Length::from_um(step);
  if (place.find("length_um") == k) lines.length = lines.length + Length::from_um(step);
  if (place.find("direction_deg") == k)
    lines.direction = Angle::from_radians(lines.direction.radians() + step * pi / 180.0);
  return lines;
}

// The smeared noise is interpolated, and its amplitude a quadrature: central differences, good to about 1e-3.
Drawing draw(const LineIntegralConvolution& lines, const PatternPlace& place) {
  Drawing drawing{draw_lines(lines, place.sheet), std::vector<std::vector<float>>(place.names.size())};
  const SteepMap map = steep_map(lines, place);
  for (std::size_t k = 0; k < place.names.size(); ++k) {
    const bool is_length = place.find("length_um") == k;
    if (!map.moves(k) && !is_length) continue;
    const double step = is_length ? 1e-3 * lines.length.um() : difference_step(map.slopes[k], place.sheet);
    const auto at = [&](double by) {
      Sheet sheet = place.sheet;
      sheet.place = sum(sheet.place, scaled(place.slopes[k], by, by));
      return draw_lines(changed(lines, place, k, by), sheet);
    };
    const auto per_step = static_cast<float>(0.5 / step);
    std::ranges::transform(at(step), at(-step), drawing.toward(k).begin(),
                           [per_step](float above, float below) { return per_step * (above - below); });
  }
  return drawing;
}

// ------------------------------------------------------------------------------------------------ periodic kinds

Drawing draw(const Sinusoid& sinusoid, const PatternPlace& place) {
  SteepMap map = steep_map(sinusoid, place);
  map.map = fitted(map.map, place.sheet);
  Drawing drawing = blank(place, 0.0F);
  draw_function(
      drawing, place.sheet, map,
      [](double u, double v) { return 0.5 * std::sin(2.0 * pi * u) * std::sin(2.0 * pi * v) + 0.5; },
      [](double u, double v) {
        const double a = 2.0 * pi * u, b = 2.0 * pi * v;
        return std::array{pi * std::cos(a) * std::sin(b), pi * std::sin(a) * std::cos(b)};
      });
  return drawing;
}

// At a crest and in a valley the slopes are those on one side.
Drawing draw(const Ridges& ridges, const PatternPlace& place) {
  SteepMap map = steep_map(ridges, place);
  map.map = fitted_along_u(map.map, place.sheet);
  Drawing drawing = blank(place, 0.0F);
  const double skew = ridges.skew, rest = 1.0 - skew;
  draw_function(
      drawing, place.sheet, map,
      [=](double u, double) {
        const double phase = u - std::floor(u);
        return phase < skew ? phase / skew : (1.0 - phase) / rest;
      },
      [=](double u, double) {
        return std::array{u - std::floor(u) < skew ? 1.0 / skew : -1.0 / rest, 0.0};
      });
  if (const auto number = place.find("skew")) {
    std::vector<float>& toward = drawing.toward(*number);
    for_each_sample(place.sheet, map.map, [&](std::size_t i, double u, double) {
      const double phase = u - std::floor(u);
      toward[i] += static_cast<float>(phase < skew ? -phase / (skew * skew) : (1.0 - phase) / (rest * rest));
    });
  }
  return drawing;
}

// ------------------------------------------------------------------------------------------------ compositions

Drawing draw_at(const Pattern& pattern, const PatternPlace& place);

Drawing draw_part(const Pattern& part, const PatternPlace& place, std::string_view kind, std::size_t index) {
  return draw_at(part, place_below(place, kind, index));
}

// A part's gray as a share of the whole's.
void scale_to_whole(Drawing& part, const SteepHeight& own, const SteepHeight& whole) {
  const double share = own.um / whole.um;
  for (std::size_t k = 0; k < part.slopes.size(); ++k) {
    const auto change = static_cast<float>((own.slopes[k] - share * whole.slopes[k]) / whole.um);
    for (float& slope : part.slopes[k]) slope *= static_cast<float>(share);
    if (change == 0.0F) continue;
    std::ranges::transform(part.toward(k), part.gray, part.toward(k).begin(),
                           [change](float slope, float gray) { return slope + change * gray; });
  }
  for (float& gray : part.gray) gray *= static_cast<float>(share);
}

Drawing draw_scaled(const Pattern& part, const PatternPlace& place, std::string_view kind, std::size_t index,
                    const SteepHeight& whole) {
  const PatternPlace below = place_below(place, kind, index);
  Drawing drawing = draw_at(part, below);
  scale_to_whole(drawing, steep_height(part, below.path, below.names), whole);
  return drawing;
}

void add(std::vector<float>& a, const std::vector<float>& b) {
  std::ranges::transform(a, b, a.begin(), std::plus<float>());
}

Drawing draw(const PatternSum& sum, const PatternPlace& place, const SteepHeight& whole) {
  Drawing drawing = blank(place, 0.0F);
  for (std::size_t part = 0; part < sum.parts.size(); ++part) {
    Drawing own = draw_scaled(sum.parts[part].pattern, place, "sum", part, whole);
    add(drawing.gray, own.gray);
    for (std::size_t k = 0; k < own.slopes.size(); ++k) {
      if (own.slopes[k].empty()) continue;
      if (drawing.slopes[k].empty())
        drawing.slopes[k] = std::move(own.slopes[k]);
      else
        add(drawing.slopes[k], own.slopes[k]);
    }
  }
  return drawing;
}

Drawing draw(const PatternProduct& product, const PatternPlace& place, const SteepHeight&) {
  Drawing drawing = blank(place, 1.0F);
  for (std::size_t part = 0; part < product.parts.size(); ++part) {
    const Drawing own = draw_part(product.parts[part].pattern, place, "product", part);
    for (std::size_t k = 0; k < own.slopes.size(); ++k) {
      if (drawing.slopes[k].empty() && own.slopes[k].empty()) continue;
      std::vector<float>& toward = drawing.toward(k);
      for (std::size_t i = 0; i < toward.size(); ++i) {
        toward[i] = toward[i] * own.gray[i] + (own.slopes[k].empty() ? 0.0F : drawing.gray[i] * own.slopes[k][i]);
      }
    }
    std::ranges::transform(drawing.gray, own.gray, drawing.gray.begin(), std::multiplies<float>());
  }
  return drawing;
}

Drawing draw(const TurnedPattern& turned, const PatternPlace& place, const SteepHeight&) {
  return draw_at(turned.parts[0].pattern, place_below(place, turned));
}

// How much of the inner part is seen where the mask has a value, and how that changes.
struct Seen {
  double share = 0.0;
  double toward_value = 0.0, toward_softness = 0.0;  ///< toward the threshold: −toward_value
};
Seen seen(const MaskedPattern& masked, float value) {
  const double over = static_cast<double>(value) - masked.threshold;
  if (masked.softness == 0.0) return {over >= 0.0 ? 1.0 : 0.0};
  const double t = std::clamp(0.5 + over / masked.softness, 0.0, 1.0);
  const double slope = 6.0 * t * (1.0 - t) / masked.softness;
  return {t * t * (3.0 - 2.0 * t), slope, -slope * over / masked.softness};
}

Drawing draw(const MaskedPattern& masked, const PatternPlace& place, const SteepHeight& whole) {
  const Drawing in = draw_scaled(masked.parts[0].pattern, place, "mask", 0, whole),
                out = draw_scaled(masked.parts[1].pattern, place, "mask", 1, whole),
                mask = draw_part(masked.parts[2].pattern, place, "mask", 2);
  Drawing drawing = blank(place, 0.0F);
  std::vector<float> share(mask.gray.size());
  for (std::size_t i = 0; i < share.size(); ++i) {
    share[i] = static_cast<float>(seen(masked, mask.gray[i]).share);
    drawing.gray[i] = share[i] * in.gray[i] + (1.0F - share[i]) * out.gray[i];
  }
  const auto threshold = place.find("threshold"), softness = place.find("softness");
  for (std::size_t k = 0; k < place.names.size(); ++k) {
    const bool by_share = !mask.slopes[k].empty() || threshold == k || softness == k;
    if (!by_share && in.slopes[k].empty() && out.slopes[k].empty()) continue;
    std::vector<float>& toward = drawing.toward(k);
    for (std::size_t i = 0; i < toward.size(); ++i) {
      if (!in.slopes[k].empty()) toward[i] += share[i] * in.slopes[k][i];
      if (!out.slopes[k].empty()) toward[i] += (1.0F - share[i]) * out.slopes[k][i];
      if (!by_share) continue;
      const Seen at = seen(masked, mask.gray[i]);
      const double of_mask = mask.slopes[k].empty() ? 0.0 : static_cast<double>(mask.slopes[k][i]);
      const double change = threshold == k  ? -at.toward_value
                            : softness == k ? at.toward_softness
                                            : at.toward_value * of_mask;
      toward[i] += static_cast<float>(change) * (in.gray[i] - out.gray[i]);
    }
  }
  return drawing;
}

std::uint8_t label_at(const PatternRegions& regions, double u, double v) {
  const auto pixel = [](double pictures, std::size_t count) {
    const double place = (pictures - std::floor(pictures)) * static_cast<double>(count);
    return std::min(static_cast<std::size_t>(place), count - 1);
  };
  return regions.labels[pixel(v, regions.rows) * regions.columns + pixel(u, regions.columns)];
}

// A picture that moves changes what is seen by jumps, which have no slope.
Drawing draw(const PatternRegions& regions, const PatternPlace& place, const SteepHeight& whole) {
  std::vector<std::uint8_t> labels(place.sheet.grid.size());
  for_each_sample(place.sheet, fitted(map_of(regions, place.sheet), place.sheet),
                  [&](std::size_t i, double u, double v) { labels[i] = label_at(regions, u, v); });
  Drawing drawing = blank(place, 0.0F);
  for (std::size_t part = 0; part < regions.parts.size(); ++part) {
    const Drawing own = draw_scaled(regions.parts[part].pattern, place, "regions", part, whole);
    const auto copy = [&, label = regions.parts[part].label](const std::vector<float>& from, std::vector<float>& to) {
      for (std::size_t i = 0; i < labels.size(); ++i) {
        if (labels[i] == label) to[i] = from[i];
      }
    };
    copy(own.gray, drawing.gray);
    for (std::size_t k = 0; k < own.slopes.size(); ++k) {
      if (!own.slopes[k].empty()) copy(own.slopes[k], drawing.toward(k));
    }
  }
  return drawing;
}

void clamp_to_gray(Drawing& drawing) {
  for (std::vector<float>& toward : drawing.slopes) {
    for (std::size_t i = 0; i < toward.size(); ++i) {
      if (drawing.gray[i] < 0.0F || drawing.gray[i] > 1.0F) toward[i] = 0.0F;
    }
  }
  for (float& value : drawing.gray) value = std::clamp(value, 0.0F, 1.0F);
}

Drawing draw_at(const Pattern& pattern, const PatternPlace& place) {
  Drawing drawing = std::visit(
      [&]<typename Kind>(const Kind& kind) {
        if constexpr (Composed<Kind>)
          return draw(kind, place, steep_height(pattern, place.path, place.names));
        else
          return draw(kind, place);
      },
      pattern);
  clamp_to_gray(drawing);
  return drawing;
}

}  // namespace

Drawing draw_pattern(const Pattern& pattern, const Sheet& sheet, std::span<const std::string> names) {
  return draw_at(pattern, whole_place(sheet, names));
}

HeightField heights_of(const std::vector<float>& gray, const Pattern& pattern, const Grid& grid,
                       Continuation continuation) {
  HeightField field(grid, continuation);
  const double height_um = height_of(pattern).um();
  std::ranges::transform(gray, field.heights_um().begin(), [height_um](float value) {
    return static_cast<float>(height_um * static_cast<double>(value));
  });
  return field;
}

}  // namespace mezzotint
