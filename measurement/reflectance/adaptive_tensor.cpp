#include "measurement/reflectance/adaptive_tensor.h"

#include <algorithm>

#include <fmt/format.h>

#include "forward/base/error.h"

namespace mezzotint {

namespace {

constexpr double pi = std::numbers::pi;
// θ_i of the files are floats.
constexpr double angle_slack = 1e-5;

struct SquarePoint {
  double x, y;
};

// A cell of a grid and the place in it.
struct Cell {
  std::size_t column, row;
  double x, y;
};

Cell cell_at(const UnitSquareGrid& grid, const SquarePoint& point) {
  const double x = std::clamp(point.x, 0.0, 1.0) * static_cast<double>(grid.columns - 1);
  const double y = std::clamp(point.y, 0.0, 1.0) * static_cast<double>(grid.rows - 1);
  const std::size_t column = std::min(static_cast<std::size_t>(x), grid.columns - 2);
  const std::size_t row = std::min(static_cast<std::size_t>(y), grid.rows - 2);
  return {column, row, x - static_cast<double>(column), y - static_cast<double>(row)};
}

// The slices around a direction of the light and their weights: all tables are mixed before they are used.
struct SliceMix {
  std::array<std::size_t, 4> slice;
  std::array<double, 4> weight;
  std::size_t count = 0;

  template <class Lookup>
  [[nodiscard]] double operator()(const Lookup& of_slice) const {
    double sum = 0.0;
    for (std::size_t i = 0; i < count; ++i) sum += weight[i] * of_slice(slice[i]);
    return sum;
  }
};

SliceMix slices_of(const AdaptiveTensor& tensor, const Place& phi, const Place& theta) {
  SliceMix mix;
  for (const std::size_t p : {std::size_t{0}, std::size_t{1}}) {
    for (const std::size_t t : {std::size_t{0}, std::size_t{1}}) {
      const double weight = (p == 0 ? 1.0 - phi.share : phi.share) * (t == 0 ? 1.0 - theta.share : theta.share);
      if (weight == 0.0) continue;
      mix.slice[mix.count] = (phi.index + p) * tensor.theta_i_rad.size() + theta.index + t;
      mix.weight[mix.count++] = weight;
    }
  }
  return mix;
}

double bilinear(const UnitSquareGrid& grid, const Cell& cell, std::size_t slice) {
  const std::size_t at = (slice * grid.rows + cell.row) * grid.columns + cell.column;
  const auto value = [&](std::size_t offset, double weight) {
    return weight == 0.0 ? 0.0 : weight * double{grid.values[at + offset]};
  };
  return value(0, (1.0 - cell.x) * (1.0 - cell.y)) + value(1, cell.x * (1.0 - cell.y)) +
         value(grid.columns, (1.0 - cell.x) * cell.y) + value(grid.columns + 1, cell.x * cell.y);
}

// The point of the uniform square that the visible normals send to `normal`: the inverse of sampling a row by the
// marginal distribution, then a column by the conditional one.
SquarePoint unwarped(const AdaptiveTensor& tensor, const SliceMix& mix, const SquarePoint& normal) {
  const UnitSquareGrid& grid = tensor.visible;
  const Cell cell = cell_at(grid, normal);
  const auto density = [&](std::size_t right, std::size_t down) {
    return mix([&](std::size_t slice) {
      return double{grid.values[(slice * grid.rows + cell.row + down) * grid.columns + cell.column + right]};
    });
  };
  const auto along_row = [&](std::size_t down, std::size_t column) {
    return mix([&](std::size_t slice) {
      return double{tensor.row_integrals[(slice * grid.rows + cell.row + down) * grid.columns + column]};
    });
  };
  const double left = (1.0 - cell.y) * density(0, 0) + cell.y * density(0, 1);
  const double right = (1.0 - cell.y) * density(1, 0) + cell.y * density(1, 1);
  const double up_to = (1.0 - cell.y) * along_row(0, cell.column) + cell.y * along_row(1, cell.column) +
                       cell.x * (left + 0.5 * cell.x * (right - left));
  const double upper = along_row(0, grid.columns - 1), lower = along_row(1, grid.columns - 1);
  const double whole_row = (1.0 - cell.y) * upper + cell.y * lower;
  const double rows = mix([&](std::size_t slice) { return double{tensor.integrals[slice * grid.rows + cell.row]}; }) +
                      cell.y * (upper + 0.5 * cell.y * (lower - upper));
  return {whole_row > 0.0 ? up_to / whole_row : not_measured, rows};
}

// Directions brought into the part of the turn that was measured, where the sample has a symmetry.
void reduce(int reduction, Direction& light, Direction& viewer) {
  if (reduction < 2) return;
  const bool flip_y = light.y() > 0.0, flip_x = reduction == 4 ? light.x() > 0.0 : flip_y;
  for (Direction* direction : {&light, &viewer}) {
    if (flip_x) direction->x() = -direction->x();
    if (flip_y) direction->y() = -direction->y();
  }
}

double theta_of(const Direction& direction) {
  return std::atan2(std::hypot(direction.x(), direction.y()), direction.z());
}

double unit_theta(double theta) { return std::sqrt(theta * 2.0 / pi); }

double unit_phi(double phi) {
  const double share = phi / (2.0 * pi) + 0.5;
  return share - std::floor(share);
}

}  // namespace

void integrate_visible(AdaptiveTensor& tensor) {
  UnitSquareGrid& grid = tensor.visible;
  const std::size_t slice_size = grid.columns * grid.rows, slices = grid.values.size() / slice_size;
  tensor.row_integrals.resize(grid.values.size());
  tensor.integrals.resize(slices * grid.rows);
  std::vector<double> whole(grid.rows);
  for (std::size_t slice = 0; slice < slices; ++slice) {
    float* values = grid.values.data() + slice * slice_size;
    double total = 0.0;
    for (std::size_t row = 0; row < grid.rows; ++row) {
      double sum = 0.0;
      for (std::size_t c = 0; c + 1 < grid.columns; ++c) {
        sum += 0.5 * (double{values[row * grid.columns + c]} + double{values[row * grid.columns + c + 1]});
      }
      whole[row] = sum;
      if (row > 0) total += 0.5 * (whole[row - 1] + sum);
    }
    require(std::isfinite(total) && total > 0.0,
            fmt::format("the distribution of visible normals is empty for direction {} of the light", slice));
    double rows = 0.0;
    for (std::size_t row = 0; row < grid.rows; ++row) {
      float* line = values + row * grid.columns;
      double sum = 0.0, before = 0.0;
      for (std::size_t c = 0; c < grid.columns; ++c) {
        const double value = double{line[c]};
        if (c > 0) sum += 0.5 * (before + value);
        tensor.row_integrals[slice * slice_size + row * grid.columns + c] = static_cast<float>(sum / total);
        line[c] = static_cast<float>(value / total);
        before = value;
      }
      if (row > 0) rows += 0.5 * (whole[row - 1] + whole[row]);
      tensor.integrals[slice * grid.rows + row] = static_cast<float>(rows / total);
    }
  }
}

double evaluate(const AdaptiveTensor& tensor, const Direction& to_light, const Direction& to_viewer,
                const ChannelWeights& weights) {
  Direction light = to_light, viewer = to_viewer;
  reduce(tensor.reduction, light, viewer);
  const Direction normal = (light + viewer).normalized();
  const double theta_i = theta_of(light), phi_i = std::atan2(light.y(), light.x());
  const double phi_m = std::atan2(normal.y(), normal.x());
  const Place theta = place_among(tensor.theta_i_rad, theta_i, angle_slack);
  const Place phi = tensor.isotropic ? Place{0, 0.0, true} : place_among(tensor.phi_i_rad, phi_i, angle_slack);
  if (!theta.known || !phi.known) return not_measured;
  const SquarePoint u_normal{unit_theta(theta_of(normal)), unit_phi(tensor.isotropic ? phi_m - phi_i : phi_m)};
  const SquarePoint u_light{unit_theta(theta_i), phi_i / (2.0 * pi) + 0.5};
  const SliceMix mix = slices_of(tensor, phi, theta);
  const SquarePoint sample = unwarped(tensor, mix, u_normal);
  if (!std::isfinite(sample.x) || !std::isfinite(sample.y)) return not_measured;
  const Cell cell = cell_at(tensor.samples, sample);
  WeightedSum sum;
  for (std::size_t c = 0; c < weights.size(); ++c) {
    if (weights[c] == 0.0) continue;
    sum.add(weights[c],
            mix([&](std::size_t slice) { return bilinear(tensor.samples, cell, slice * tensor.channels + c); }));
  }
  const double normals = bilinear(tensor.normals, cell_at(tensor.normals, u_normal), 0);
  const double area = bilinear(tensor.sigma, cell_at(tensor.sigma, u_light), 0);
  const double value = sum.value() * normals / (4.0 * area * viewer.z());
  return std::isfinite(value) ? value : not_measured;
}

}  // namespace mezzotint
