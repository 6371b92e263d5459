#include "fabrication/calibration/reachable_range.h"

#include <algorithm>
#include <cmath>

namespace mezzotint {

namespace {

// Height of the curve itself, cut nowhere.
double height_um(const CureCurve& curve, double gray) {
  return curve.alpha.um() + curve.beta.um() * std::log(std::max(1e-12, gray - curve.gamma));
}

// The first level that lies above a gray value.
int level_above(double gray, int last) {
  return static_cast<int>(std::clamp(std::floor(gray * last) + 1.0, 0.0, static_cast<double>(last) + 1.0));
}

LevelInterval level_interval(const Quantity& gray, double quantile, int last) {
  const double reach = quantile * gray.standard_error.value_or(0.0);
  return {level_above(gray.value, last), level_above(gray.value - reach, last), level_above(gray.value + reach, last)};
}

}  // namespace

Quantity derived_quantity(const CureFit& fit, const std::string& unit,
                          const std::function<double(const CureCurve&)>& figure) {
  const std::array<double, 3> steps{1e-4, 1e-4, 1e-6};
  std::array<double, 3> slopes{};
  for (std::size_t k = 0; k < 3; ++k) {
    const auto moved = [&](double step) {
      CureCurve curve = fit.curve;
      if (k == 0) curve.alpha = curve.alpha + Length::from_um(step);
      if (k == 1) curve.beta = curve.beta + Length::from_um(step);
      if (k == 2) curve.gamma += step;
      return figure(curve);
    };
    slopes[k] = (moved(steps[k]) - moved(-steps[k])) / (2.0 * steps[k]);
  }
  double variance = 0.0;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) variance += slopes[i] * fit.covariance[i][j] * slopes[j];
  }
  return {figure(fit.curve), unit, std::sqrt(std::max(0.0, variance))};
}

ReachableRange reachable_range(const CureFit& fit, const PrinterProfile& printer) {
  const int last = printer.gray_levels - 1;
  const auto gray_of = [last](int level) { return static_cast<double>(level) / last; };
  const auto step_to = [&](int level) {
    return derived_quantity(fit, "µm", [&](const CureCurve& curve) {
      return height_um(curve, gray_of(level)) - height_um(curve, gray_of(level - 1));
    });
  };
  ReachableRange range;
  range.threshold = derived_quantity(fit, "1", threshold_gray);
  range.first_level = level_interval(range.threshold, fit.quantile, last);
  const int first = std::min(range.first_level.level, last);
  range.first_height =
      derived_quantity(fit, "µm", [&](const CureCurve& curve) { return height_um(curve, gray_of(first)); });
  range.step_at_first = step_to(std::min(first + 1, last));
  const double layer_um = printer.layer.um();
  const Quantity full = derived_quantity(fit, "µm", [](const CureCurve& curve) { return height_um(curve, 1.0); });
  int highest = last;
  if (full.value > layer_um) {
    const Quantity filling =
        derived_quantity(fit, "1", [&](const CureCurve& curve) { return height_to_gray(curve, printer.layer); });
    range.saturation = level_interval(filling, fit.quantile, last);
    highest = std::min(last, range.saturation->level - 1);
    range.full_height = {layer_um, "µm", 0.0};
  } else {
    range.full_height = full;
  }
  range.step_at_last = step_to(std::max(highest, 1));
  return range;
}

}  // namespace mezzotint
