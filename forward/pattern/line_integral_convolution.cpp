#include "forward/pattern/line_integral_convolution.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <tbb/parallel_for.h>

#include "forward/base/error.h"
#include "forward/pattern/noise_raster.h"
#include "forward/pattern/pattern_tree.h"

namespace mezzotint {

namespace {

// Of the noise's lattice: the noise changes so little over an eighth of a cell that a sum is as good as an integral.
constexpr double step_in_cells = 0.125;

struct Vector {
  double x = 0.0, y = 0.0;
};

// A line field with singularities, on a sheet.
class LineField {
public:
  LineField(const LineIntegralConvolution& lines, const PatternMap& place)
      : place_(place), singularities_(lines.singularities) {
    // The direction is the pattern's: on a turned sheet its lines turn with it.
    const double angle = lines.direction.radians() + std::numbers::pi / 2.0 - std::atan2(place_.vx, place_.ux);
    twice_ = {std::cos(2.0 * angle), std::sin(2.0 * angle)};
  }

  // A line has no head: of its two tangents, the one that goes on along `before`. Vectors stand for complex numbers
  // here; with the angles doubled, each singularity is a whole power, and nothing jumps.
  [[nodiscard]] Vector tangent(const Vector& at, const Vector& before) const {
    const auto [x, y] = place_(at.x, at.y);
    Vector twice = twice_;
    for (const Singularity& point : singularities_) {
      Vector towards{x - point.place.x.um(), y - point.place.y.um()};
      const double distance = std::sqrt(towards.x * towards.x + towards.y * towards.y);
      if (distance == 0.0) continue;
      towards = {towards.x / distance, std::copysign(1.0, point.index) * towards.y / distance};
      const auto powers = std::lround(std::abs(2.0 * point.index));
      for (long k = 0; k < powers; ++k) twice = product(twice, towards);
    }
    const Vector found = half_angle(twice);
    return found.x * before.x + found.y * before.y < 0.0 ? Vector{-found.x, -found.y} : found;
  }

private:
  static Vector product(const Vector& a, const Vector& b) { return {a.x * b.x - a.y * b.y, a.x * b.y + a.y * b.x}; }
  static Vector half_angle(const Vector& a) {
    if (a.x >= 0.0) {
      const double cosine = std::sqrt(0.5 * (1.0 + a.x));
      return {cosine, 0.5 * a.y / cosine};
    }
    const double sine = std::sqrt(0.5 * (1.0 - a.x));
    return {0.5 * a.y / sine, sine};
  }

  PatternMap place_;
  std::vector<Singularity> singularities_;
  Vector twice_;  ///< the direction without singularities, its angle doubled
};

// Mean of the noise along the line through a point, at the middles of steps to both sides, by the midpoint rule.
class LineMean {
public:
  LineMean(const LineField& field, const NoiseRaster& noise, const PatternMap& map, double length, double scale)
      : field_(field),
        noise_(noise),
        map_(map),
        steps_(std::max(1, static_cast<int>(std::ceil(0.5 * length / (step_in_cells * scale))))),
        step_(0.5 * length / steps_) {}

  [[nodiscard]] double operator()(const Vector& at) const {
    const Vector forward = field_.tangent(at, {});
    return (half_sum(at, forward) + half_sum(at, {-forward.x, -forward.y})) / (2.0 * steps_);
  }

private:
  static Vector moved(const Vector& from, const Vector& along, double distance) {
    return {from.x + distance * along.x, from.y + distance * along.y};
  }
  [[nodiscard]] double half_sum(Vector at, Vector along) const {
    double sum = 0.0;
    for (int i = 0; i < steps_; ++i) {
      along = field_.tangent(at, along);
      const Vector middle = moved(at, along, 0.5 * step_);
      const auto [u, v] = map_(middle.x, middle.y);
      sum += noise_(u, v);
      along = field_.tangent(middle, along);
      at = moved(at, along, step_);
    }
    return sum;
  }

  const LineField& field_;
  const NoiseRaster& noise_;
  const PatternMap& map_;
  int steps_;
  double step_;
};

template <typename MeanAt>
std::vector<float> fill(const Sheet& sheet, double amplitude, const MeanAt& mean_at) {
  std::vector<float> gray(sheet.grid.size());
  tbb::parallel_for(std::size_t{0}, sheet.grid.rows, [&](std::size_t row) {
    const double y = static_cast<double>(row) * sheet.grid.pitch_y.um();
    for (std::size_t column = 0; column < sheet.grid.columns; ++column) {
      const double x = static_cast<double>(column) * sheet.grid.pitch_x.um();
      gray[row * sheet.grid.columns + column] = static_cast<float>(0.5 + amplitude * mean_at(x, y));
    }
  });
  return gray;
}

// The noise's coordinates on a sheet, and `margin` µm beyond it.
NoiseBounds bounds_of(const PatternMap& map, const Sheet& sheet, double margin) {
  NoiseBounds bounds{HUGE_VAL, -HUGE_VAL, HUGE_VAL, -HUGE_VAL};
  for (const double x : {-margin, sheet.width_um() + margin}) {
    for (const double y : {-margin, sheet.depth_um() + margin}) {
      const auto [u, v] = map(x, y);
      bounds = {std::min(bounds.x_low, u), std::max(bounds.x_high, u), std::min(bounds.y_low, v),
                std::max(bounds.y_high, v)};
    }
  }
  return bounds;
}

// Straight lines run along v: their means are differences of the noise's integral.
std::vector<float> draw_straight(const LineIntegralConvolution& lines, const Sheet& sheet) {
  const PatternMap map = fitted(map_of(lines, sheet), sheet);
  const double length = std::max(lines.length / lines.scale, step_in_cells);
  NoiseBounds bounds = bounds_of(map, sheet, 0.0);
  bounds.y_low -= 0.5 * length;
  bounds.y_high += 0.5 * length;
  NoiseRaster integral(NoiseLattice(lines.seed, lines.hash, map, sheet), bounds);
  integral.integrate_along_y();
  return fill(sheet, smeared_noise(length).amplitude, [&](double x, double y) {
    const auto [u, v] = map(x, y);
    return (integral(u, v + 0.5 * length) - integral(u, v - 0.5 * length)) / length;
  });
}

std::vector<float> draw_curved(const LineIntegralConvolution& lines, const Sheet& sheet) {
  require(sheet.continuation != Continuation::Periodic, "a line field with singularities fits no periodic tile");
  const PatternMap map = map_of(lines, sheet);
  const NoiseRaster noise(NoiseLattice(lines.seed, lines.hash), bounds_of(map, sheet, 0.5 * lines.length.um()));
  const LineField field(lines, sheet.place);
  const LineMean mean(field, noise, map, lines.length.um(), lines.scale.um());
  const double amplitude = smeared_noise(lines.length / lines.scale).amplitude;
  return fill(sheet, amplitude, [&](double x, double y) { return mean({x, y}); });
}

}  // namespace

std::vector<float> draw_lines(const LineIntegralConvolution& lines, const Sheet& sheet) {
  return lines.singularities.empty() ? draw_straight(lines, sheet) : draw_curved(lines, sheet);
}

}  // namespace mezzotint
