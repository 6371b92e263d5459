#include "forward/process/cure_curve.h"

#include <algorithm>
#include <cmath>

#include "forward/base/error.h"

namespace mezzotint {

void require_valid(const CureCurve& curve) {
  const bool finite = std::isfinite(curve.alpha.um()) && std::isfinite(curve.beta.um()) && std::isfinite(curve.gamma);
  require(finite, "cure curve: alpha, beta and gamma must be finite numbers");
  require(curve.beta.um() > 0.0, "cure.beta_um must be positive: it is the penetration depth of the light");
  require(curve.gamma < 1.0, "cure.gamma must be below 1: no gray value would cure");
  const double threshold = threshold_gray(curve);
  require(threshold >= 0.0, "cure curve: curing would begin below gray 0; raise cure.gamma or lower cure.alpha_um");
  require(threshold < 1.0, "cure curve: full gray would not cure; raise cure.alpha_um or lower cure.gamma");
}

double threshold_gray(const CureCurve& curve) { return std::exp(-(curve.alpha / curve.beta)) + curve.gamma; }

Length gray_to_height(const CureCurve& curve, double gray) {
  if (!(gray > threshold_gray(curve))) return Length{};
  const Length height = curve.alpha + curve.beta * std::log(gray - curve.gamma);
  return std::max(height, Length{});
}

double height_to_gray(const CureCurve& curve, Length height) {
  if (!(height > Length{})) return 0.0;
  return std::exp((height - curve.alpha) / curve.beta) + curve.gamma;
}

CureCurve scale_exposure(const CureCurve& curve, double factor) {
  require(std::isfinite(factor) && factor > 0.0, "an exposure must be a positive multiple of the calibrated one");
  CureCurve scaled = curve;
  scaled.alpha = curve.alpha + curve.beta * std::log(factor);
  require_valid(scaled);
  return scaled;
}

}  // namespace mezzotint
