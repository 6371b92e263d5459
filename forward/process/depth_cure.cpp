#include "forward/process/depth_cure.h"

#include <cmath>
#include <limits>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include "forward/base/error.h"
#include "forward/process/fast_cure.h"

namespace mezzotint {

namespace {

void require_valid(const StackLayer& layer) {
  require(std::isfinite(layer.thickness.um()) && layer.thickness > Length{}, "a layer's thickness must be positive");
  require(std::isfinite(layer.exposure) && layer.exposure > 0.0,
          "a layer's exposure must be a positive multiple of the calibrated one");
}

// visit(first, end) over stretches of samples, side by side; what is done to one sample depends on no other.
template <class Visit>
void for_each_stretch(std::size_t count, const Visit& visit) {
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, 1 << 14),
                    [&](const auto& range) { visit(range.begin(), range.end()); });
}

}  // namespace

float passing_share(Length thickness, const CureCurve& curve) {
  return static_cast<float>(std::exp(-(thickness / curve.beta)));
}

DepthDose::DepthDose(const CureCurve& curve, std::size_t samples) : curve_(curve), dose_(samples, 0.0F) {
  mezzotint::require_valid(curve);
}

void DepthDose::descend(const StackLayer& layer, std::span<const float> light) {
  require_valid(layer);
  require(light.size() == dose_.size(), "one gray value a column of the stack is needed");
  const float kept = is_empty_ ? 0.0F : passing_share(thickness_, curve_);
  const auto exposure = static_cast<float>(layer.exposure);
  const auto gamma = static_cast<float>(curve_.gamma);
  float* const dose = dose_.data();
  const float* const gray = light.data();
  for_each_stretch(dose_.size(), [=](std::size_t first, std::size_t end) {
    for (std::size_t i = first; i < end; ++i) {
      const float own = gray[i] - gamma;
      dose[i] = exposure * (own > 0.0F ? own : 0.0F) + kept * dose[i];
    }
  });
  thickness_ = layer.thickness;
  is_empty_ = false;
}

void DepthDose::cure_into(std::span<float> out, float ceiling_um) const {
  require(out.size() == dose_.size(), "one thickness a column of the stack is needed");
  const float* const dose = dose_.data();
  float* const cured = out.data();
  const FastCure curve = fast_cure(curve_, thickness_);
  for_each_stretch(dose_.size(), [=](std::size_t first, std::size_t end) {
    for (std::size_t i = first; i < end; ++i) {
      const float known = dose[i] > curve.least_dose ? dose[i] : curve.least_dose;
      const float height = curve.alpha_um + curve.beta_um * fast_log(known);
      const float low = height > 0.0F ? height : 0.0F;
      const float cut = low < ceiling_um ? low : ceiling_um;
      cured[i] = dose[i] > curve.least_dose ? cut : 0.0F;
    }
  });
}

void DepthDose::cured_um(std::span<float> out) const { cure_into(out, static_cast<float>(thickness_.um())); }

void DepthDose::reach_um(std::span<float> out) const { cure_into(out, std::numeric_limits<float>::max()); }

std::vector<SolidInterval> solid_intervals(std::span<const StackLayer> layers, std::span<const float> cured_um) {
  require(layers.size() == cured_um.size(), "one solid thickness a layer is needed");
  constexpr double slack_um = 1e-4;
  std::vector<SolidInterval> solid;
  Length face;
  for (std::size_t i = 0; i < layers.size(); ++i) {
    require_valid(layers[i]);
    const double whole_um = layers[i].thickness.um(), cured = static_cast<double>(cured_um[i]);
    require(cured >= 0.0 && cured <= whole_um + slack_um, "a solid thickness lies outside of its layer");
    const bool is_whole = cured >= whole_um - slack_um;
    const Length upper = face + layers[i].thickness;
    if (is_whole && !solid.empty() && solid.back().upper == face)
      solid.back().upper = upper;
    else if (cured > 0.0)
      solid.push_back({is_whole ? face : upper - Length::from_um(cured), upper});
    face = upper;
  }
  return solid;
}

}  // namespace mezzotint
