#include "measurement/texture/bearing_curve.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "forward/base/error.h"

namespace mezzotint {

namespace {

std::vector<float> measured(const HeightField& field) {
  std::vector<float> heights_um;
  heights_um.reserve(field.grid().size());
  std::ranges::copy_if(field.heights_um(), std::back_inserter(heights_um), [](float z) { return !std::isnan(z); });
  return heights_um;
}

}  // namespace

BearingCurve::BearingCurve(const HeightField& field) : BearingCurve(measured(field)) {}

BearingCurve::BearingCurve(std::vector<float> heights_um) : heights_um_(std::move(heights_um)) {
  require(heights_um_.size() >= 4, "a material ratio curve needs four measured samples at least");
  std::ranges::sort(heights_um_, std::greater<>());
  sums_.resize(heights_um_.size());
  const double step = 1.0 / static_cast<double>(heights_um_.size());
  double sum = 0.5 * step * static_cast<double>(heights_um_.front());
  sums_[0] = sum;
  for (std::size_t k = 1; k < heights_um_.size(); ++k) {
    sum += 0.5 * step * (static_cast<double>(heights_um_[k - 1]) + static_cast<double>(heights_um_[k]));
    sums_[k] = sum;
  }
}

double BearingCurve::height_um(double ratio) const {
  const double place = ratio * static_cast<double>(heights_um_.size()) - 0.5;
  if (!(place > 0.0)) return heights_um_.front();
  const auto low = static_cast<std::size_t>(place);
  if (low + 1 >= heights_um_.size()) return heights_um_.back();
  const double rest = place - static_cast<double>(low);
  return (1.0 - rest) * static_cast<double>(heights_um_[low]) + rest * static_cast<double>(heights_um_[low + 1]);
}

double BearingCurve::ratio(double height_um) const {
  const auto n = static_cast<double>(heights_um_.size());
  if (height_um > static_cast<double>(heights_um_.front())) return 0.0;
  if (height_um <= static_cast<double>(heights_um_.back())) return 1.0;
  // The last height that is at least as high, and the next one below.
  const auto below = std::partition_point(heights_um_.begin(), heights_um_.end(),
                                          [&](float z) { return static_cast<double>(z) >= height_um; });
  const auto k = static_cast<double>(below - heights_um_.begin()) - 1.0;
  const double high = *(below - 1), low = *below;
  return (k + 0.5 + (high - height_um) / (high - low)) / n;
}

double BearingCurve::integral_to(double ratio) const {
  const auto n = static_cast<double>(heights_um_.size());
  const double place = std::clamp(ratio, 0.0, 1.0) * n - 0.5;
  if (place <= 0.0) return ratio * static_cast<double>(heights_um_.front());
  const auto low = std::min(static_cast<std::size_t>(place), heights_um_.size() - 1);
  const double rest = place - static_cast<double>(low);
  return sums_[low] + rest / n * 0.5 * (static_cast<double>(heights_um_[low]) + height_um(ratio));
}

double BearingCurve::integral_um(double from, double to) const { return integral_to(to) - integral_to(from); }

}  // namespace mezzotint
