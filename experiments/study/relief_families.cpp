#include "experiments/study/relief_families.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "forward/base/error.h"
#include "forward/base/random.h"
#include "forward/pattern/pattern.h"

namespace mezzotint {

namespace {

constexpr double turn = 2.0 * std::numbers::pi;

using Height = std::function<double(double, double)>;  ///< of a place in sides of the tile

HeightField sampled(const ReliefDraw& draw, const Height& height, Continuation continuation = Continuation::Periodic) {
  HeightField field({draw.cells, draw.cells, Length::from_um(1.0), Length::from_um(1.0)}, continuation);
  const auto side = static_cast<double>(draw.cells);
  for (std::size_t row = 0; row < draw.cells; ++row) {
    for (std::size_t column = 0; column < draw.cells; ++column) {
      field.at(column, row) =
          static_cast<float>(height(static_cast<double>(column) / side, static_cast<double>(row) / side));
    }
  }
  return field;
}

// 64 waves of one to four times the fewest periods. Each has the same slope, so that no octave is much rougher than the
// others. The sum has a deviation of some 0.6.
Height waves(const ReliefDraw& draw) {
  struct Wave {
    double x, y, phase;
  };
  std::vector<Wave> list;
  const RandomStream random(draw.seed, RandomPurpose::Test);
  for (std::uint64_t k = 0; k < 64; ++k) {
    const auto u = random.uniform4(k);
    const double count = draw.periods * std::pow(4.0, u[1]);
    list.push_back({std::round(count * std::cos(turn * u[0])), std::round(count * std::sin(turn * u[0])), turn * u[2]});
  }
  const double scale = draw.periods / std::sqrt(0.5 * static_cast<double>(list.size()));
  return [list, scale](double x, double y) {
    double sum = 0.0;
    for (const Wave& wave : list)
      sum += std::sin(turn * (wave.x * x + wave.y * y) + wave.phase) / std::hypot(wave.x, wave.y);
    return scale * sum;
  };
}

HeightField gaussian(const ReliefDraw& draw) { return sampled(draw, waves(draw)); }

HeightField noise(const ReliefDraw& draw) {
  const Noise pattern{.scale = Length::from_um(static_cast<double>(draw.cells) / draw.periods), .seed = draw.seed};
  return synthesize(pattern, {draw.cells, draw.cells, Length::from_um(1.0), Length::from_um(1.0)}, {},
                    Continuation::Periodic);
}

HeightField folds(const ReliefDraw& draw) {
  return sampled(draw, [wave = waves(draw)](double x, double y) { return std::abs(wave(x, y)); });
}

HeightField plateaus(const ReliefDraw& draw) {
  return sampled(draw, [wave = waves(draw)](double x, double y) { return std::tanh(6.0 * wave(x, y)); });
}

HeightField patch(const ReliefDraw& draw) {
  constexpr double part = 0.83;  // of the waves' period
  return sampled(
      draw, [wave = waves(draw)](double x, double y) { return wave(part * x, part * y); }, Continuation::Mirrored);
}

HeightField sinusoid(const ReliefDraw& draw) {
  return sampled(draw,
                 [n = draw.periods](double x, double y) { return std::sin(turn * n * x) * std::sin(turn * n * y); });
}

HeightField skewed_ridges(const ReliefDraw& draw) {
  return sampled(draw, [n = draw.periods, skew = draw.skew](double x, double) {
    const double u = n * x - std::floor(n * x);
    return u < skew ? u / skew : (1.0 - u) / (1.0 - skew);
  });
}

HeightField ridges(const ReliefDraw& draw) {
  ReliefDraw symmetric = draw;
  symmetric.skew = 0.5;
  return skewed_ridges(symmetric);
}

// Adds height·(1 − r²)³ within a radius, on the periodic tile. x, y and the radius in cells.
void add_bump(HeightField& field, double x, double y, double radius, double height) {
  const auto side = static_cast<std::int64_t>(field.columns());
  const auto wrapped = [side](std::int64_t i) { return static_cast<std::size_t>((i % side + side) % side); };
  for (auto row = static_cast<std::int64_t>(std::ceil(y - radius)); static_cast<double>(row) < y + radius; ++row) {
    for (auto column = static_cast<std::int64_t>(std::ceil(x - radius)); static_cast<double>(column) < x + radius;
         ++column) {
      const double dx = static_cast<double>(column) - x, dy = static_cast<double>(row) - y;
      const double left = 1.0 - (dx * dx + dy * dy) / (radius * radius);
      if (left > 0.0) field.at(wrapped(column), wrapped(row)) += static_cast<float>(height * left * left * left);
    }
  }
}

// Of each octave as many bumps as cover the tile once, so that many places are flat and some are steep.
HeightField bumps(const ReliefDraw& draw) {
  HeightField field({draw.cells, draw.cells, Length::from_um(1.0), Length::from_um(1.0)}, Continuation::Periodic);
  const auto side = static_cast<double>(draw.cells);
  const RandomStream random(draw.seed, RandomPurpose::Test);
  std::uint64_t index = 0;
  for (int octave = 0; octave < 3; ++octave) {
    const double periods = draw.periods * std::exp2(octave), radius = side / periods;
    const auto count = static_cast<std::uint64_t>(periods * periods / std::numbers::pi);
    for (std::uint64_t k = 0; k < count; ++k) {
      const auto u = random.uniform4(index++);
      add_bump(field, side * u[0], side * u[1], radius, radius * (2.0 * u[2] - 1.0));
    }
  }
  return field;
}

struct Family {
  std::string name;
  HeightField (*draw)(const ReliefDraw&);
};

const std::vector<Family>& families() {
  static const std::vector<Family> list = {{"gaussian", gaussian},
                                           {"noise", noise},
                                           {"sinusoid", sinusoid},
                                           {"ridges", ridges},
                                           {"skewed ridges", skewed_ridges},
                                           {"bumps", bumps},
                                           {"folds", folds},
                                           {"plateaus", plateaus},
                                           {"patch", patch}};
  return list;
}

}  // namespace

HeightField draw_relief(const std::string& family, const ReliefDraw& draw) {
  require(draw.cells >= 64 && draw.cells <= 8192, "a study needs 64 to 8192 cells a side");
  require(draw.periods >= 1.0 && draw.skew > 0.0 && draw.skew < 1.0,
          "a relief needs at least one period, and its crest within it");
  for (const Family& known : families())
    if (known.name == family) return known.draw(draw);
  throw InvalidInput(
      fmt::format("a study knows the reliefs {}, not \"{}\"", fmt::join(relief_families(), ", "), family));
}

const std::vector<std::string>& relief_families() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> list;
    for (const Family& family : families()) list.push_back(family.name);
    return list;
  }();
  return names;
}

}  // namespace mezzotint
