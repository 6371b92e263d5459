#include <cmath>
#include <optional>

#include "forward/surface/mesh.h"

namespace mezzotint {

namespace {

using Vector = std::array<double, 3>;

struct Step {
  int column;
  int row;
};

// A vertex inside of the grid has six triangles around it. Neighbour k and neighbour k + 1 span the
// k-th of them, counter-clockwise from +x, and it lies in the cell whose first corner is `around_cells[k]` away.
constexpr std::array<Step, 6> around = {{{1, 0}, {1, 1}, {0, 1}, {-1, 0}, {-1, -1}, {0, -1}}};
constexpr std::array<Step, 6> around_cells = {{{0, 0}, {0, 0}, {-1, 0}, {-1, -1}, {-1, -1}, {0, -1}}};

Vector cross(const Vector& a, const Vector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

double dot(const Vector& a, const Vector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

std::optional<std::size_t> neighbour(std::size_t index, int step, std::size_t count, bool periodic) {
  const auto moved = static_cast<std::ptrdiff_t>(index) + step;
  const auto end = static_cast<std::ptrdiff_t>(count);
  if (moved >= 0 && moved < end) return static_cast<std::size_t>(moved);
  if (!periodic) return std::nullopt;
  return static_cast<std::size_t>((moved + end) % end);
}

// Heights around one sample; NaN beyond the ends of a patch that does not repeat.
class Neighbourhood {
public:
  Neighbourhood(const HeightField& field, std::size_t column, std::size_t row)
      : field_(field), column_(column), row_(row) {}

  [[nodiscard]] double height_um(Step step) const {
    const auto c = neighbour(column_, step.column, field_.columns(), field_.periodic());
    const auto r = neighbour(row_, step.row, field_.rows(), field_.periodic());
    return c && r ? field_.at(*c, *r) : std::nan("");
  }

  [[nodiscard]] bool whole_cell(Step corner) const {
    return !std::isnan(height_um(corner) + height_um({corner.column + 1, corner.row}) +
                       height_um({corner.column, corner.row + 1}) + height_um({corner.column + 1, corner.row + 1}));
  }

  [[nodiscard]] Vector edge_um(Step step) const {
    return {step.column * field_.grid().pitch_x.um(), step.row * field_.grid().pitch_y.um(),
            height_um(step) - height_um({0, 0})};
  }

private:
  const HeightField& field_;
  std::size_t column_;
  std::size_t row_;
};

void add_weighted_normal(Vector& sum, const Vector& first, const Vector& second) {
  const Vector normal = cross(first, second);
  const double length = std::sqrt(dot(normal, normal));
  const double angle = std::atan2(length, dot(first, second));
  for (std::size_t k = 0; k < 3; ++k) sum[k] += angle / length * normal[k];
}

std::array<float, 3> pseudo_normal(const Neighbourhood& near) {
  Vector sum{};
  for (std::size_t k = 0; k < around.size(); ++k) {
    if (!near.whole_cell(around_cells[k])) continue;
    add_weighted_normal(sum, near.edge_um(around[k]), near.edge_um(around[(k + 1) % around.size()]));
  }
  const double length = std::sqrt(dot(sum, sum));
  if (!(length > 0.0)) return {0.0F, 0.0F, 1.0F};
  return {static_cast<float>(sum[0] / length), static_cast<float>(sum[1] / length),
          static_cast<float>(sum[2] / length)};
}

}  // namespace

std::vector<std::array<float, 3>> pseudo_normals(const HeightField& field) {
  std::vector<std::array<float, 3>> normals;
  normals.reserve(field.grid().size());
  for (std::size_t row = 0; row < field.rows(); ++row) {
    for (std::size_t column = 0; column < field.columns(); ++column) {
      normals.push_back(pseudo_normal(Neighbourhood(field, column, row)));
    }
  }
  return normals;
}

}  // namespace mezzotint
