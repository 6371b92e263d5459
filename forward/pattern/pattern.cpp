#include "forward/pattern/pattern.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>

#include <tbb/parallel_for.h>

#include "forward/base/error.h"
#include "forward/base/random.h"
#include "forward/pattern/noise_scatter.h"
#include "forward/pattern/sparse_noise.h"

namespace mezzotint {

namespace {

constexpr double pi = std::numbers::pi;

void require_length(Length length, const char* name) {
  require(std::isfinite(length.um()) && length.um() > 0.0,
          std::string("the pattern's ") + name + " must be a positive length");
}

void check(const Noise& noise) {
  require_length(noise.scale, "scale_um");
  require_length(noise.height, "height_um");
  require(noise.stretch >= 1.0 && noise.stretch <= 64.0, "the pattern's stretch must be in [1, 64]");
}
void check(const Sinusoid& sinusoid) {
  require_length(sinusoid.wavelength_u, "wavelength_u_um");
  require_length(sinusoid.wavelength_v, "wavelength_v_um");
  require_length(sinusoid.height, "height_um");
}
void check(const Ridges& ridges) {
  require_length(ridges.wavelength, "wavelength_um");
  require_length(ridges.height, "height_um");
  require(ridges.skew >= 0.01 && ridges.skew <= 0.99, "the pattern's skew must be in [0.01, 0.99]");
}

Angle direction_of(const Pattern& pattern) {
  return std::visit([](const auto& kind) { return kind.direction; }, pattern);
}

// Positions in the pattern's own axes: u along its direction, v across.
struct OwnAxes {
  double cosine, sine, origin_x, origin_y;

  OwnAxes(Angle direction, const Position& origin)
      : cosine(std::cos(direction.radians())),
        sine(std::sin(direction.radians())),
        origin_x(origin.x.um()),
        origin_y(origin.y.um()) {}
  [[nodiscard]] std::array<double, 2> operator()(double x_um, double y_um) const {
    const double x = x_um + origin_x, y = y_um + origin_y;
    return {x * cosine + y * sine, -x * sine + y * cosine};
  }
};

template <typename HeightOf>
HeightField fill_grid(const Grid& grid, const OwnAxes& axes, const HeightOf& height_um) {
  HeightField field(grid, Continuation::Mirrored);
  tbb::parallel_for(std::size_t{0}, grid.rows, [&](std::size_t row) {
    for (std::size_t column = 0; column < grid.columns; ++column) {
      const auto [u, v] =
          axes(static_cast<double>(column) * grid.pitch_x.um(), static_cast<double>(row) * grid.pitch_y.um());
      field.at(column, row) = static_cast<float>(height_um(u, v));
    }
  });
  return field;
}

HeightField draw(const Noise& noise, const Grid& grid, const Position& origin) {
  const PatternMap plane{.u0 = origin.x.um(), .v0 = origin.y.um()};
  const PatternMap map = in_units(turned(plane, noise.direction), noise.scale.um(), noise.scale.um() * noise.stretch);
  HeightField field(grid, Continuation::Mirrored);
  add_sparse_noise(field.heights_um(), grid, map, NoiseLattice(noise.seed, noise.hash), 0.0, 1.0);
  const double height = noise.height.um();
  for (float& z : field.heights_um()) z = static_cast<float>(height * std::clamp(0.5 + z, 0.0, 1.0));
  return field;
}

HeightField draw(const Sinusoid& sinusoid, const Grid& grid, const Position& origin) {
  const OwnAxes axes(sinusoid.direction, origin);
  const double k_u = 2.0 * pi / sinusoid.wavelength_u.um(), k_v = 2.0 * pi / sinusoid.wavelength_v.um();
  const double height = sinusoid.height.um();
  return fill_grid(grid, axes,
                   [=](double u, double v) { return height * (0.5 * std::sin(k_u * u) * std::sin(k_v * v) + 0.5); });
}

HeightField draw(const Ridges& ridges, const Grid& grid, const Position& origin) {
  const OwnAxes axes(ridges.direction, origin);
  const double per_u = 1.0 / ridges.wavelength.um(), height = ridges.height.um(), skew = ridges.skew;
  return fill_grid(grid, axes, [=](double u, double) {
    const double phase = u * per_u - std::floor(u * per_u);
    return height * (phase < skew ? phase / skew : (1.0 - phase) / (1.0 - skew));
  });
}

// Mean square slopes along u and v.
std::array<double, 2> mean_square_slopes(const Noise& noise) {
  const double amplitude = noise.height.um() / noise.scale.um();
  const double along = amplitude * amplitude * 0.5 * noise_plane_gradient_square_at_z0;
  return {along, along / (noise.stretch * noise.stretch)};
}
std::array<double, 2> mean_square_slopes(const Sinusoid& sinusoid) {
  const double per_u = pi * sinusoid.height.um() / sinusoid.wavelength_u.um();
  const double per_v = pi * sinusoid.height.um() / sinusoid.wavelength_v.um();
  return {0.25 * per_u * per_u, 0.25 * per_v * per_v};
}
std::array<double, 2> mean_square_slopes(const Ridges& ridges) {
  const double steepness = ridges.height.um() / ridges.wavelength.um();
  return {steepness * steepness / (ridges.skew * (1.0 - ridges.skew)), 0.0};
}

PatternInstance instance(Noise noise, const std::array<double, 4>&, std::uint64_t seed) {
  noise.seed = seed;
  return {noise, {}};
}
Position along(Angle direction, double u_um, double v_um) {
  const double c = std::cos(direction.radians()), s = std::sin(direction.radians());
  return {Length::from_um(u_um * c - v_um * s), Length::from_um(u_um * s + v_um * c)};
}
PatternInstance instance(const Sinusoid& sinusoid, const std::array<double, 4>& u, std::uint64_t) {
  return {sinusoid, along(sinusoid.direction, u[0] * sinusoid.wavelength_u.um(), u[1] * sinusoid.wavelength_v.um())};
}
PatternInstance instance(const Ridges& ridges, const std::array<double, 4>& u, std::uint64_t) {
  return {ridges, along(ridges.direction, u[0] * ridges.wavelength.um(), 0.0)};
}

}  // namespace

std::string_view kind_name(const Pattern& pattern) {
  constexpr std::array<std::string_view, 3> names = {"noise", "sinusoid", "ridges"};
  return names.at(pattern.index());
}

void require_valid(const Pattern& pattern) {
  std::visit([](const auto& kind) { check(kind); }, pattern);
  require(std::isfinite(direction_of(pattern).radians()), "the pattern's direction_deg must be finite");
}

HeightField synthesize(const Pattern& pattern, const Grid& grid, const Position& origin) {
  require_valid(pattern);
  require_valid_grid(grid);
  return std::visit([&](const auto& kind) { return draw(kind, grid, origin); }, pattern);
}

SlopeCovariance closed_form_slope_covariance(const Pattern& pattern) {
  const auto [along_u, along_v] = std::visit([](const auto& kind) { return mean_square_slopes(kind); }, pattern);
  const double c = std::cos(direction_of(pattern).radians()), s = std::sin(direction_of(pattern).radians());
  return {along_u * c * c + along_v * s * s, along_u * s * s + along_v * c * c, (along_u - along_v) * c * s};
}

PatternInstance draw_instance(const Pattern& pattern, std::uint64_t seed) {
  const auto u = RandomStream(seed, RandomPurpose::PatternImpulse).uniform4(0);
  return std::visit([&](const auto& kind) { return instance(kind, u, seed); }, pattern);
}

}  // namespace mezzotint
