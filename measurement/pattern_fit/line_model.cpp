#include "measurement/pattern_fit/line_model.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace mezzotint {

namespace {

constexpr double pi = std::numbers::pi;

struct Gray {
  double value = 0.0, by_u = 0.0, by_v = 0.0, by_skew = 0.0;
};

Gray gray_of(LineKind kind, double u, double v, double skew) {
  if (kind == LineKind::Sinusoid) {
    const double su = std::sin(2.0 * pi * u), cu = std::cos(2.0 * pi * u);
    const double sv = std::sin(2.0 * pi * v), cv = std::cos(2.0 * pi * v);
    return {0.5 * su * sv + 0.5, pi * cu * sv, pi * su * cv, 0.0};
  }
  const double phase = u - std::floor(u), rest = 1.0 - skew;
  if (phase < skew) return {phase / skew, 1.0 / skew, 0.0, -phase / (skew * skew)};
  return {(1.0 - phase) / rest, -1.0 / rest, 0.0, (1.0 - phase) / (rest * rest)};
}

}  // namespace

double line_height(LineKind kind, const LineNumbers& n, double x, double y, LineGradient& gradient) {
  const double c = std::cos(n.direction), s = std::sin(n.direction);
  const double along = c * x + s * y, across = c * y - s * x;
  const Gray gray = gray_of(kind, n.waves_u_per_um * along + n.phase_u, n.waves_v_per_um * across + n.phase_v, n.skew);
  const double h = n.height_um;
  gradient = {h * gray.by_u * along,
              h * (gray.by_u * n.waves_u_per_um * across - gray.by_v * n.waves_v_per_um * along),
              gray.value,
              h * gray.by_u,
              h * gray.by_v * across,
              h * gray.by_v,
              h * gray.by_skew,
              1.0,
              x,
              y};
  return h * gray.value + n.offset_um + n.slope_x * x + n.slope_y * y;
}

std::array<double*, line_numbers> members(LineNumbers& n) {
  return {&n.waves_u_per_um, &n.direction, &n.height_um, &n.phase_u, &n.waves_v_per_um,
          &n.phase_v,        &n.skew,      &n.offset_um, &n.slope_x, &n.slope_y};
}

LineNumbers in_reported_form(LineKind kind, LineNumbers n) {
  // Ridges upside down, or seen from the other side, lean the other way.
  if (n.height_um < 0.0) n.skew = 1.0 - n.skew;
  const double half_turns = std::ceil(n.direction / pi - 0.5);
  if (std::fmod(half_turns, 2.0) != 0.0) n.skew = 1.0 - n.skew;
  n.direction -= pi * half_turns;
  n.height_um = std::abs(n.height_um);
  n.waves_u_per_um = std::abs(n.waves_u_per_um);
  n.waves_v_per_um = std::abs(n.waves_v_per_um);
  const double quarter = 0.25 * pi;
  if (kind == LineKind::Sinusoid && (n.direction > quarter || n.direction <= -quarter)) {
    n.direction += n.direction > quarter ? -0.5 * pi : 0.5 * pi;
    std::swap(n.waves_u_per_um, n.waves_v_per_um);
  }
  return n;
}

Pattern pattern_of(LineKind kind, const LineNumbers& n) {
  const Length u = Length::from_um(1.0 / n.waves_u_per_um), height = Length::from_um(n.height_um);
  const Angle direction = Angle::from_radians(n.direction);
  if (kind == LineKind::Ridges) return Ridges{u, direction, height, n.skew};
  return Sinusoid{u, Length::from_um(1.0 / n.waves_v_per_um), direction, height};
}

}  // namespace mezzotint
