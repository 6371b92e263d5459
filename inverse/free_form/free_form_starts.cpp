#include "inverse/free_form/free_form_starts.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Eigenvalues>

#include "forward/pattern/pattern.h"
#include "inverse/objective/light_moments.h"

namespace mezzotint {

namespace {

// What matters to a shape in a lobe.
struct LobeAxes {
  Angle longer;         // direction of its longer axis
  Angle toward_middle;  // from the mirror direction
  double tilt = 0.0;    // slope that sends light from the mirror direction to the lobe's middle
};

LobeAxes axes_of(const LobeTarget& goal) {
  const LightMoments moments = light_moments(goal.grid, goal.maps.front());
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver(moments.covariance);
  const Eigen::Vector2d longer = solver.eigenvectors().col(1);
  const Direction light = to_direction(goal.incidences.front());
  const Eigen::Vector2d middle = moments.mean + Eigen::Vector2d(light.x(), light.y());
  return {Angle::from_radians(std::atan2(longer.y(), longer.x())),
          Angle::from_radians(std::atan2(middle.y(), middle.x())), middle.norm() / (2.0 * light.z())};
}

// A saw whose long sides lean as the lobe does, with as few short sides as the layer's height and the tile allow.
Ridges saw(const LobeAxes& axes, Length height, Length pixel, std::size_t pixels) {
  constexpr double crest = 0.1;
  const double slope = std::max(axes.tilt, 0.02);
  const Length longest = pixel * (static_cast<double>(pixels) / 4.0);
  const Length wavelength = std::clamp(height / (slope / (1.0 - crest)), 8.0 * pixel, longest);
  return {.wavelength = wavelength,
          .direction = axes.toward_middle,
          .height = std::min(height, (slope * (1.0 - crest)) * wavelength),
          .skew = crest};
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
      {"ridges", Ridges{.wavelength = 12.0 * pixel, .direction = axes.longer, .height = height}},
      {"a saw", saw(axes, height, pixel, options.pixels)}};
  const Grid grid{options.pixels, options.pixels, pixel, pixel};
  std::vector<StartShape> shapes;
  shapes.reserve(patterns.size());
  for (const auto& [name, pattern] : patterns)
    shapes.push_back({name, synthesize(pattern, grid, {}, Continuation::Periodic)});
  return shapes;
}

}  // namespace mezzotint
