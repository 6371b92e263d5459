// How many nanoseconds a sample of sparse convolution noise costs, by summing over the eight cells around each point
// and by scattering the impulses: one thread, CPU time, medians of interleaved repeats. Not a test.

#include <ctime>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <vector>

#include <fmt/format.h>
#include <tbb/global_control.h>

#include "forward/pattern/noise_scatter.h"
#include "forward/pattern/sparse_noise.h"

namespace {

using namespace mezzotint;

constexpr std::size_t repeats = 7;

double cpu_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

double seconds_of(const std::function<void()>& work) {
  const double start = cpu_seconds();
  work();
  return cpu_seconds() - start;
}

double median(std::vector<double> values) {
  std::ranges::nth_element(values, values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2));
  return values[values.size() / 2];
}

// The slides' loop, with the random numbers made beforehand: what remains is arithmetic that vectorises.
class NaivePlane {
public:
  explicit NaivePlane(const NoiseLattice& lattice, int cells) : side_(cells + 3) {
    constexpr std::size_t count = CellImpulses::count;
    CellImpulses at;
    for (auto* array : {&x_, &y_, &z_, &weight_}) array->resize(static_cast<std::size_t>(side_ * side_ * 2) * count);
    std::size_t i = 0;
    for (int layer = -1; layer <= 0; ++layer) {
      for (int row = -1; row <= cells + 1; ++row) {
        for (int column = -1; column <= cells + 1; ++column) {
          lattice.impulses(column, row, layer, at);
          for (std::size_t j = 0; j < count; ++j, ++i) {
            x_[i] = static_cast<float>(at.x[j]);
            y_[i] = static_cast<float>(at.y[j]);
            z_[i] = static_cast<float>(layer + at.z[j]);
            weight_[i] = static_cast<float>(at.weight[j]);
          }
        }
      }
    }
  }
  [[nodiscard]] double operator()(double x, double y) const {
    const auto left = static_cast<std::int64_t>(std::floor(x - 0.5)),
               low = static_cast<std::int64_t>(std::floor(y - 0.5));
    std::array<float, CellImpulses::count> sums{};
    for (int corner = 0; corner < 8; ++corner) {
      const std::int64_t column = left + (corner & 1), row = low + (corner >> 1 & 1), layer = corner >> 2;
      const auto px = static_cast<float>(x - static_cast<double>(column)),
                 py = static_cast<float>(y - static_cast<double>(row));
      const std::size_t at = static_cast<std::size_t>(((layer * side_ + row + 1) * side_ + column + 1)) * sums.size();
      for (std::size_t j = 0; j < sums.size(); ++j) {
        const float dx = x_[at + j] - px, dy = y_[at + j] - py, dz = z_[at + j];
        const float falloff = std::max(0.0F, 1.0F - 4.0F * (dx * dx + dy * dy + dz * dz));
        sums[j] += weight_[at + j] * falloff * falloff * falloff;
      }
    }
    double sum = 0.0;
    for (const float term : sums) sum += static_cast<double>(term);
    return noise_normalisation() * sum;
  }

private:
  std::int64_t side_;
  std::vector<float> x_, y_, z_, weight_;
};

struct Row {
  double direct, naive, scattered, difference;
};

Row measure(int pixels_a_cell) {
  const std::size_t side = 1024;
  const double per_pixel = 1.0 / pixels_a_cell;
  const NoiseLattice lattice(5, CellHash::Integer);
  const Grid grid{side, side, Length::from_um(1.0), Length::from_um(1.0)};
  const PatternMap map = in_units({}, pixels_a_cell, pixels_a_cell);
  const NaivePlane naive(lattice, static_cast<int>(side) / pixels_a_cell + 1);
  // The slow ones on some rows that lie apart.
  const std::size_t naive_rows = 16, direct_samples = 2048;
  std::vector<float> by_naive(naive_rows * side), by_scatter(side * side);
  std::vector<double> direct, loop, scattered;
  volatile double sink = 0.0;
  for (std::size_t repeat = 0; repeat < repeats; ++repeat) {
    direct.push_back(seconds_of([&] {
                       double sum = 0.0;
                       for (std::size_t i = 0; i < direct_samples; ++i) {
                         sum += sparse_noise(static_cast<double>(i % side) * per_pixel,
                                             static_cast<double>(i / side) * per_pixel, 0.0, 5);
                       }
                       sink = sink + sum;
                     }) /
                     static_cast<double>(direct_samples));
    const auto rows_by = [&](const auto& noise) {
      return seconds_of([&] {
               for (std::size_t i = 0; i < by_naive.size(); ++i) {
                 by_naive[i] =
                     static_cast<float>(noise(static_cast<double>(i % side) * per_pixel,
                                              static_cast<double>(i / side * (side / naive_rows)) * per_pixel));
               }
             }) /
             static_cast<double>(by_naive.size());
    };
    loop.push_back(rows_by(naive));
    scattered.push_back(seconds_of([&] {
                          std::ranges::fill(by_scatter, 0.0F);
                          add_sparse_noise(by_scatter, grid, map, lattice, 0.0, 1.0);
                        }) /
                        static_cast<double>(by_scatter.size()));
  }
  double difference = 0.0;
  for (std::size_t i = 0; i < by_naive.size(); ++i) {
    const float other = by_scatter[i / side * (side / naive_rows) * side + i % side];
    difference = std::max(difference, std::abs(static_cast<double>(by_naive[i] - other)));
  }
  return {1e9 * median(direct), 1e9 * median(loop), 1e9 * median(scattered), difference};
}

}  // namespace

int main() {
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  fmt::print("ns a sample, one thread, medians of {}; 1024² samples\n", repeats);
  fmt::print("pixels a cell   cells drawn at each sample   cells kept   scattered   ratios   largest difference\n");
  for (const int pixels : {2, 4, 16, 64, 256}) {
    const Row row = measure(pixels);
    fmt::print("{:>13} {:>28.0f} {:>12.1f} {:>11.2f}   {:.0f}, {:.0f}   {:.1e}\n", pixels, row.direct, row.naive,
               row.scattered, row.direct / row.scattered, row.naive / row.scattered, row.difference);
  }
  return 0;
}
