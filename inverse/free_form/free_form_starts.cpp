#include "inverse/free_form/free_form_starts.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/Eigenvalues>

#include "forward/pattern/pattern.h"
#include "inverse/free_form/free_form_bench.h"
#include "inverse/objective/light_moments.h"

namespace mezzotint {

namespace {

// What matters to a shape in a lobe.
struct LobeAxes {
  Angle longer;         // direction of its longer axis
  double spread = 0.0;  // RMS slope along it, about the lobe's middle
  Angle toward_middle;  // from the mirror direction
  double tilt = 0.0;    // slope that sends light from the mirror direction to the lobe's middle
  bool leans = false;   // its middle is further from there than half of its smaller RMS width
};

LobeAxes axes_of(const LobeTarget& goal) {
  const LightMoments moments = light_moments(goal.grid, goal.maps.front());
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver(moments.covariance);
  const Eigen::Vector2d longer = solver.eigenvectors().col(1);
  const Direction light = to_direction(goal.incidences.front());
  const Eigen::Vector2d middle = moments.mean + Eigen::Vector2d(light.x(), light.y());
  return {Angle::from_radians(std::atan2(longer.y(), longer.x())),
          std::sqrt(solver.eigenvalues()(1)) / (2.0 * light.z()),
          Angle::from_radians(std::atan2(middle.y(), middle.x())), middle.norm() / (2.0 * light.z()),
          middle.norm() > 0.5 * std::sqrt(std::max(0.0, solver.eigenvalues()(0)))};
}

// Teeth of a saw along either axis of the tile.
using Teeth = std::pair<int, int>;

// Light goes where a slope descends to, so heights fall from a tooth's back to its foot along that direction.
StartShape saw(const Teeth& teeth, double slope, const PrinterProfile& printer, std::size_t pixels) {
  const auto n = static_cast<double>(pixels);
  const double along = std::hypot(teeth.first, teeth.second), period_px = n / along;
  const double top_um = reachable_height(printer).um(), dark_um = wanted_range(printer).low_um;
  const double height_um = std::min(0.99 * top_um, slope * period_px * printer.pixel_pitch.um());
  StartShape shape{"a saw of " + std::to_string(teeth.first) + " by " + std::to_string(teeth.second) + " teeth", {}};
  for (std::size_t row = 0; row < pixels; ++row) {
    for (std::size_t column = 0; column < pixels; ++column) {
      const double phase =
          (teeth.first * (static_cast<double>(column) + 0.5) + teeth.second * (static_cast<double>(row) + 0.5)) / n;
      const double fall = phase - std::floor(phase);
      const bool foot = fall > 1.0 - 1.0 / period_px;
      shape.wanted_um.push_back(foot ? 0.5 * dark_um : top_um - height_um * fall);
    }
  }
  return shape;
}

std::vector<StartShape> saws(const LobeAxes& axes, const PrinterProfile& printer, std::size_t pixels) {
  const double side_um = static_cast<double>(pixels) * printer.pixel_pitch.um();
  const double fewest = side_um * axes.tilt / reachable_height(printer).um();
  std::vector<Teeth> done;
  std::vector<StartShape> shapes;
  for (int more = 0; more < 3; ++more) {
    const double along = std::max(1.0, std::floor(fewest)) + more;
    const Teeth teeth{static_cast<int>(std::lround(along * std::cos(axes.toward_middle.radians()))),
                      static_cast<int>(std::lround(along * std::sin(axes.toward_middle.radians())))};
    const bool fits = std::hypot(teeth.first, teeth.second) * 6.0 <= static_cast<double>(pixels);
    if (!fits || teeth == Teeth{0, 0} || std::ranges::find(done, teeth) != done.end()) continue;
    done.push_back(teeth);
    shapes.push_back(saw(teeth, axes.tilt, printer, pixels));
  }
  return shapes;
}

// Ridges whose two sides are as steep as the lobe is wide.
Ridges ridges(const LobeAxes& axes, Length height, Length pixel, std::size_t pixels) {
  const Length longest = pixel * (0.5 * static_cast<double>(pixels)), wanted = 2.0 * height / axes.spread;
  return {.wavelength = std::clamp(wanted, std::min(12.0 * pixel, longest), longest),
          .direction = axes.longer,
          .height = height};
}

StartShape lifted(const std::string& name, const Pattern& pattern, const PrinterProfile& printer, std::size_t pixels) {
  const Length pixel = printer.pixel_pitch;
  const HeightField heights = synthesize(pattern, {pixels, pixels, pixel, pixel}, {}, Continuation::Periodic);
  StartShape shape{name, {heights.heights_um().begin(), heights.heights_um().end()}};
  const double lift = reachable_height(printer).um() - *std::ranges::max_element(shape.wanted_um);
  for (double& height : shape.wanted_um) height += lift;
  return shape;
}

}  // namespace

std::vector<StartShape> start_shapes(const LobeTarget& goal, const PrinterProfile& printer,
                                     const FreeFormOptions& options) {
  const Length pixel = printer.pixel_pitch, height = 0.8 * reachable_height(printer);
  const LobeAxes axes = axes_of(goal);
  const std::vector<std::pair<std::string, Pattern>> patterns = {
      {"noise", Noise{.scale = 12.0 * pixel, .height = height, .seed = options.seed}},
      {"fine noise", Noise{.scale = 7.0 * pixel, .height = height, .seed = options.seed}},
      {"crossed waves", Sinusoid{.wavelength_u = 12.0 * pixel, .wavelength_v = 12.0 * pixel, .height = height}},
      {"ridges", ridges(axes, height, pixel, options.pixels)}};
  std::vector<StartShape> shapes;
  for (const auto& [name, pattern] : patterns) shapes.push_back(lifted(name, pattern, printer, options.pixels));
  if (axes.leans) {
    for (StartShape& shape : saws(axes, printer, options.pixels)) shapes.push_back(std::move(shape));
  }
  return shapes;
}

}  // namespace mezzotint
