#include "forward/scattering/slope_splat.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "forward/base/error.h"
#include "forward/surface/slope_covariance.h"

namespace mezzotint {

namespace {

// Fresnel costs more than all the rest: a table over the cosine, linear between 1024 steps (error below 1e-5).
class ReflectanceTable {
public:
  explicit ReflectanceTable(const Material& material) : values_(steps + 2) {
    for (std::size_t i = 0; i < values_.size(); ++i) {
      values_[i] = reflectance(material, std::min(1.0, static_cast<double>(i) / steps));
    }
  }
  [[nodiscard]] double operator()(double cosine) const {
    const double place = cosine * steps;
    const auto index = static_cast<std::size_t>(place);
    const double t = place - static_cast<double>(index);
    return values_[index] + t * (values_[index + 1] - values_[index]);
  }

private:
  static constexpr std::size_t steps = 1024;
  std::vector<double> values_;
};

class Splat {
public:
  Splat(const Material& material, const DirectionAngles& incidence, const DirectionGrid& grid)
      : reflectance_(material), light_(to_direction(incidence)), grid_(grid), sums_(grid.size(), 0.0) {}

  void add(double slope_x, double slope_y) {
    ++count_;
    const double per_length = 1.0 / std::sqrt(1.0 + slope_x * slope_x + slope_y * slope_y);
    const double caught = light_.z() - slope_x * light_.x() - slope_y * light_.y();  // (ω_i·m)/m_z
    if (caught <= 0.0) return;
    const double cosine = std::min(1.0, caught * per_length);
    const double twice = 2.0 * cosine * per_length;
    const double z = twice - light_.z();
    if (z <= 0.0) return;
    const double x = -twice * slope_x - light_.x(), y = -twice * slope_y - light_.y();
    sums_[grid_.bin_of(x, y)] += reflectance_(cosine) * caught;
  }

  [[nodiscard]] DirectionMap take() && {
    require(count_ > 0, "no cell with four measured corners: the relief reflects nothing");
    const auto areas = projected_solid_angles(grid_);
    const double per_light = 1.0 / (static_cast<double>(count_) * light_.z());
    for (std::size_t bin = 0; bin < sums_.size(); ++bin)
      sums_[bin] = areas[bin] > 0.0 ? sums_[bin] * per_light / areas[bin] : 0.0;
    return std::move(sums_);
  }

private:
  ReflectanceTable reflectance_;
  Direction light_;
  DirectionGrid grid_;
  DirectionMap sums_;
  std::size_t count_ = 0;
};

}  // namespace

DirectionMap slope_reflection_map(const HeightField& field, const Material& material, const DirectionAngles& incidence,
                                  const DirectionGrid& grid) {
  require_valid(grid);
  require(to_direction(incidence).z() > 1e-6, "the light must stand above the horizon");
  Splat splat(material, incidence, grid);
  for_each_facet_slope(field, [&](double slope_x, double slope_y) { splat.add(slope_x, slope_y); });
  return std::move(splat).take();
}

}  // namespace mezzotint
