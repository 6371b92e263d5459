#include "forward/pattern/noise_scatter.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <tbb/parallel_for.h>

#include "forward/base/error.h"
#include "forward/pattern/impulse_splat.h"
#include "forward/pattern/sparse_noise.h"

namespace mezzotint {

namespace {

constexpr std::size_t band_rows = 64;
// Of cells a sample: from here on most impulses reach no sample, and summing the cells around each costs less.
constexpr double finest_scattered = 1.0;

struct Span {
  double low, high;
};

// Columns and rows of the grid to noise coordinates, and back.
struct GridMap {
  PatternMap map;
  double column_u, column_v, row_u, row_v;  ///< (u, v) a column, a row
  double determinant;

  GridMap(const PatternMap& m, const Grid& grid)
      : map(m),
        column_u(m.ux * grid.pitch_x.um()),
        column_v(m.vx * grid.pitch_x.um()),
        row_u(m.uy * grid.pitch_y.um()),
        row_v(m.vy * grid.pitch_y.um()),
        determinant(column_u * row_v - row_u * column_v) {}

  [[nodiscard]] std::array<double, 2> at(double column, double row) const {
    return {map.u0 + column * column_u + row * row_u, map.v0 + column * column_v + row * row_v};
  }
  [[nodiscard]] SampleRows sample_rows(std::size_t columns, std::size_t rows) const {
    const double square = column_u * column_u + column_v * column_v;
    return {.lean = -(column_u * row_u + column_v * row_v) / square,
            .fall = 4.0 * square,
            .row_fall = 4.0 * determinant * determinant / square,
            .columns = columns,
            .rows = rows,
            .stride = columns + widest_vector};
  }
};

// Where the noise goes.
struct Fields {
  std::span<float> values, toward_u, toward_v;

  [[nodiscard]] bool with_gradient() const { return !toward_u.empty(); }
};

// Some rows of the grid, and what the noise is on them.
class Band {
public:
  Band(const GridMap& map, std::size_t columns, std::size_t first_row, std::size_t end_row, bool with_gradient)
      : map_(map),
        rows_(map.sample_rows(columns, end_row - first_row)),
        first_row_(first_row),
        size_(rows_.rows * rows_.stride),
        sums_((with_gradient ? 3 : 1) * size_, 0.0F),
        into_{sums_.data(), with_gradient ? &sums_[size_] : nullptr, with_gradient ? &sums_[2 * size_] : nullptr} {
    const auto low = static_cast<double>(first_row), high = static_cast<double>(end_row - 1);
    const auto last = static_cast<double>(columns - 1);
    corners_ = {map_.at(0.0, low), map_.at(last, low), map_.at(last, high), map_.at(0.0, high)};
  }

  void scatter(const NoiseLattice& lattice, double z) {
    const auto [least, most] =
        std::minmax_element(corners_.begin(), corners_.end(), [](const auto& a, const auto& b) { return a[1] < b[1]; });
    const auto first = static_cast<std::int64_t>(std::floor((*least)[1] - 0.5));
    const auto last = static_cast<std::int64_t>(std::floor((*most)[1] + 0.5));
    for (std::int64_t y = first; y <= last; ++y) {
      const Span u = u_between(static_cast<double>(y) - 0.5, static_cast<double>(y) + 1.5);
      const auto end = static_cast<std::int64_t>(std::floor(u.high + 0.5));
      for (auto x = static_cast<std::int64_t>(std::floor(u.low - 0.5)); x <= end; ++x) scatter_cells(lattice, x, y, z);
    }
  }

  void add_to(const Fields& fields, float amplitude) const {
    for (std::size_t row = 0; row < rows_.rows; ++row) {
      const float* sums = &into_.values[row * rows_.stride];
      float* into = &fields.values[(first_row_ + row) * rows_.columns];
      for (std::size_t column = 0; column < rows_.columns; ++column) into[column] += amplitude * sums[column];
    }
    if (!fields.with_gradient()) return;
    add_gradient(fields.toward_u, amplitude, map_.column_u, map_.row_u);
    add_gradient(fields.toward_v, amplitude, map_.column_v, map_.row_v);
  }

private:
  // ∂f³/∂u = 3f²·(−8)·(u − u_j), where u − u_j is so much a column and so much a row.
  void add_gradient(std::span<float> toward, float amplitude, double a_column, double a_row) const {
    const auto by_column = static_cast<float>(-24.0 * a_column) * amplitude,
               by_row = static_cast<float>(-24.0 * a_row) * amplitude;
    for (std::size_t row = 0; row < rows_.rows; ++row) {
      const float *columns = &into_.columns[row * rows_.stride], *rows = &into_.rows[row * rows_.stride];
      float* into = &toward[(first_row_ + row) * rows_.columns];
      for (std::size_t column = 0; column < rows_.columns; ++column)
        into[column] += by_column * columns[column] + by_row * rows[column];
    }
  }

  // The u of the band's points with v in an interval: corners in it, and edges that cross its ends.
  [[nodiscard]] Span u_between(double v_low, double v_high) const {
    Span span{HUGE_VAL, -HUGE_VAL};
    const auto take = [&](double u) { span = {std::min(span.low, u), std::max(span.high, u)}; };
    for (std::size_t i = 0; i < 4; ++i) {
      const auto &a = corners_[i], &b = corners_[(i + 1) % 4];
      if (a[1] >= v_low && a[1] <= v_high) take(a[0]);
      for (const double v : {v_low, v_high}) {
        if ((a[1] - v) * (b[1] - v) < 0.0) take(a[0] + (v - a[1]) / (b[1] - a[1]) * (b[0] - a[0]));
      }
    }
    return span;
  }

  // Both layers of cells that reach the plane.
  void scatter_cells(const NoiseLattice& lattice, std::int64_t x, std::int64_t y, double z) {
    found_.count = 0;
    const auto layer = static_cast<std::int64_t>(std::floor(z - 0.5));
    for (const std::int64_t level : {layer, layer + 1}) {
      lattice.impulses(x, y, level, drawn_);
      collect(static_cast<double>(x), static_cast<double>(y), static_cast<double>(level) - z);
    }
    splat_impulses(found_, rows_, into_);
  }

  void collect(double x, double y, double z) {
    const double per_determinant = 1.0 / map_.determinant;
    std::size_t count = found_.count;
    for (std::size_t j = 0; j < CellImpulses::count; ++j) {
      const double u = x + drawn_.x[j] - map_.map.u0, v = y + drawn_.y[j] - map_.map.v0, dz = z + drawn_.z[j];
      const double headroom = 1.0 - 4.0 * dz * dz;
      found_.column[count] = (map_.row_v * u - map_.row_u * v) * per_determinant;
      found_.row[count] = (map_.column_u * v - map_.column_v * u) * per_determinant - static_cast<double>(first_row_);
      found_.headroom[count] = headroom;
      found_.weight[count] = drawn_.weight[j];
      // Half of the impulses reach the plane; a branch would be wrong every second time.
      count += headroom > 0.0 ? 1 : 0;
    }
    found_.count = count;
  }

  const GridMap& map_;
  SampleRows rows_;
  std::size_t first_row_;
  std::size_t size_;
  std::vector<float> sums_;
  SplatSums into_;
  std::array<std::array<double, 2>, 4> corners_{};
  CellImpulses drawn_{};
  PlaneImpulses found_{};
};

void require_within_lattice(const GridMap& map, const Grid& grid) {
  for (const double column : {0.0, static_cast<double>(grid.columns)}) {
    for (const double row : {0.0, static_cast<double>(grid.rows)}) {
      const auto [u, v] = map.at(column, row);
      const double most = NoiseLattice::largest_coordinate - 2.0;
      // Written so that NaN fails.
      require(std::abs(u) < most && std::abs(v) < most,
              "the noise lattice holds 2^20 cells a side; the patch is too large for this scale");
    }
  }
}

void gather(const Fields& fields, const Grid& grid, const GridMap& map, const NoiseLattice& lattice, double z,
            double amplitude) {
  tbb::parallel_for(std::size_t{0}, grid.rows, [&](std::size_t row) {
    for (std::size_t column = 0; column < grid.columns; ++column) {
      const auto [u, v] = map.at(static_cast<double>(column), static_cast<double>(row));
      const std::size_t at = row * grid.columns + column;
      fields.values[at] += static_cast<float>(amplitude * sparse_noise(lattice, u, v, z));
      if (!fields.with_gradient()) continue;
      const auto [along_u, along_v] = sparse_noise_gradient(lattice, u, v, z);
      fields.toward_u[at] += static_cast<float>(amplitude * along_u);
      fields.toward_v[at] += static_cast<float>(amplitude * along_v);
    }
  });
}

}  // namespace

void add_sparse_noise(std::span<float> values, const Grid& grid, const PatternMap& map, const NoiseLattice& lattice,
                      double z, double amplitude, std::span<float> toward_u, std::span<float> toward_v) {
  const Fields fields{values, toward_u, toward_v};
  const GridMap grid_map(map, grid);
  require_within_lattice(grid_map, grid);
  if (std::abs(grid_map.determinant) > finest_scattered) return gather(fields, grid, grid_map, lattice, z, amplitude);
  const auto factor = static_cast<float>(amplitude * noise_normalisation());
  tbb::parallel_for(std::size_t{0}, (grid.rows + band_rows - 1) / band_rows, [&](std::size_t index) {
    const std::size_t first = index * band_rows;
    Band band(grid_map, grid.columns, first, std::min(first + band_rows, grid.rows), fields.with_gradient());
    band.scatter(lattice, z);
    band.add_to(fields, factor);
  });
}

}  // namespace mezzotint
