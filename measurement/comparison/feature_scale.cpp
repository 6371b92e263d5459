#include "measurement/comparison/feature_scale.h"

#include <algorithm>
#include <cmath>

#include "forward/base/error.h"
#include "measurement/comparison/placement.h"

namespace mezzotint {

namespace {

// Features are far smaller than this in any relief worth registering; more samples would cost, not tell.
constexpr std::size_t largest_side = 384;
constexpr double lobe_level = 0.3;
constexpr double least_lobe_overlap = 0.25;

HeightField middle_part(const HeightField& field) {
  const std::size_t columns = std::min(field.columns(), largest_side);
  const std::size_t rows = std::min(field.rows(), largest_side);
  return crop(field, (field.columns() - columns) / 2, (field.rows() - rows) / 2, columns, rows);
}

CorrelationMap autocorrelation(const HeightField& field) {
  const MaskedImage image = standardised(field);
  return MaskedCorrelation(image, image.columns, image.rows)
      .with(image, least_lobe_overlap * static_cast<double>(image.values.size()));
}

}  // namespace

MaskedImage standardised(const HeightField& field) {
  double count = 0.0, sum = 0.0, squares = 0.0;
  for (const float z : field.heights_um()) {
    if (!std::isnan(z)) count += 1.0, sum += static_cast<double>(z);
  }
  const double mean = sum / std::max(1.0, count);
  for (const float z : field.heights_um()) {
    if (!std::isnan(z)) squares += (static_cast<double>(z) - mean) * (static_cast<double>(z) - mean);
  }
  if (!(squares > 0.0)) throw MethodError("a surface that is flat, or was not measured, cannot be registered");
  const double scale = 1.0 / std::sqrt(squares / count);
  MaskedImage image{field.columns(), field.rows(), {}, {}};
  image.values.reserve(field.heights_um().size());
  image.seen.reserve(field.heights_um().size());
  for (const float z : field.heights_um()) {
    image.values.push_back(std::isnan(z) ? 0.0 : (static_cast<double>(z) - mean) * scale);
    image.seen.push_back(std::isnan(z) ? 0.0 : 1.0);
  }
  return image;
}

double feature_half_width_um(const HeightField& field) {
  const HeightField part = middle_part(field);
  const CorrelationMap map = autocorrelation(part);
  double shortest = half_diagonal_um(part.grid());
  for (std::size_t k = 0; k < map.correlation.size(); ++k) {
    if (map.overlap[k] < least_lobe_overlap * static_cast<double>(part.grid().size())) continue;
    if (map.correlation[k] > 0.5) continue;
    const double x_um = static_cast<double>(map.displacement_x(k)) * part.grid().pitch_x.um();
    const double y_um = static_cast<double>(map.displacement_y(k)) * part.grid().pitch_y.um();
    shortest = std::min(shortest, std::hypot(x_um, y_um));
  }
  return shortest;
}

MainLobe::MainLobe(const HeightField& field)
    : pitch_x_um_(field.grid().pitch_x.um()),
      pitch_y_um_(field.grid().pitch_y.um()),
      reach_x_(static_cast<std::ptrdiff_t>(field.columns()) - 1),
      reach_y_(static_cast<std::ptrdiff_t>(field.rows()) - 1),
      inside_(static_cast<std::size_t>((2 * reach_x_ + 1) * (2 * reach_y_ + 1))) {
  fill(autocorrelation(field));
}

void MainLobe::fill(const CorrelationMap& map) {
  const std::ptrdiff_t width = 2 * reach_x_ + 1;
  std::vector<char> above(inside_.size());
  for (std::size_t k = 0; k < map.correlation.size(); ++k) {
    const std::ptrdiff_t x = map.displacement_x(k);
    const std::ptrdiff_t y = map.displacement_y(k);
    if (std::abs(x) > reach_x_ || std::abs(y) > reach_y_) continue;
    above[static_cast<std::size_t>((y + reach_y_) * width + x + reach_x_)] = map.correlation[k] > lobe_level;
  }
  std::vector<std::ptrdiff_t> open = {reach_y_ * width + reach_x_};
  inside_[static_cast<std::size_t>(open.front())] = 1;
  const auto visit = [&](std::ptrdiff_t place) {
    const auto k = static_cast<std::size_t>(place);
    if (above[k] && !inside_[k]) inside_[k] = 1, open.push_back(place);
  };
  while (!open.empty()) {
    const std::ptrdiff_t place = open.back();
    open.pop_back();
    if (place % width > 0) visit(place - 1);
    if (place % width < width - 1) visit(place + 1);
    if (place >= width) visit(place - width);
    if (place + width < static_cast<std::ptrdiff_t>(inside_.size())) visit(place + width);
  }
}

bool MainLobe::holds(double x_um, double y_um) const {
  const auto x = static_cast<std::ptrdiff_t>(std::lround(x_um / pitch_x_um_));
  const auto y = static_cast<std::ptrdiff_t>(std::lround(y_um / pitch_y_um_));
  if (std::abs(x) > reach_x_ || std::abs(y) > reach_y_) return false;
  return inside_[static_cast<std::size_t>((y + reach_y_) * (2 * reach_x_ + 1) + x + reach_x_)] != 0;
}

double MainLobe::area_um2() const {
  return pitch_x_um_ * pitch_y_um_ * static_cast<double>(std::count(inside_.begin(), inside_.end(), char{1}));
}

}  // namespace mezzotint
