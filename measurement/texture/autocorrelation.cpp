#include "measurement/texture/autocorrelation.h"

#include <cmath>
#include <complex>

#include "forward/base/error.h"
#include "forward/base/fft.h"
#include "measurement/texture/row_spectra.h"

namespace mezzotint {

namespace {

// Several sums at once: one alone would wait for itself.
double mean_um(const HeightField& field) {
  constexpr std::size_t lanes = 8;
  double sums[lanes] = {}, counts[lanes] = {};
  const auto heights_um = field.heights_um();
  for (std::size_t i = 0; i < heights_um.size(); ++i) {
    const double z = static_cast<double>(heights_um[i]);
    const bool measured = z == z;
    sums[i % lanes] += measured ? z : 0.0;
    counts[i % lanes] += measured ? 1.0 : 0.0;
  }
  double sum = 0.0, count = 0.0;
  for (std::size_t k = 0; k < lanes; ++k) {
    sum += sums[k];
    count += counts[k];
  }
  require(count > 0.0, "no sample was measured: there is nothing to correlate");
  return sum / count;
}

struct Lengths {
  std::size_t x = 0, y = 0;
};

// Σ over pairs at each lag of value · value, times the lengths; a sample that is missing counts as 0.
// use(lag_y, sums): of a row of lags, 0 first, negative ones at the end; for lag_y from 0 on.
template <class Value, class Use>
void pair_sums(const HeightField& field, Lengths lengths, const Value& value, const Use& use) {
  RowSpectra spectra(field.rows(), lengths.x, [&](std::size_t row, std::span<double> line) {
    const auto heights_um = field.heights_um().subspan(row * field.columns(), field.columns());
    for (std::size_t c = 0; c < heights_um.size(); ++c) {
      const double z = static_cast<double>(heights_um[c]);
      line[c] = z == z ? value(z) : 0.0;
    }
  });
  const std::size_t rows = field.rows() / 2 + 1;
  // The power of a column is real, so that a real transform leads back from it.
  spectra.for_each_four_columns(lengths.y, [&](std::size_t, std::span<ComplexFftLine> columns, RealFftLine& power) {
    for (ComplexFftLine& column : columns) {
      const auto values = column.values();
      for (std::size_t k = 0; k < values.size(); ++k) power.real()[k] = std::norm(values[k]);
      power.forward();
      for (std::size_t row = 0; row < rows; ++row) values[row] = std::conj(power.spectrum()[row]);
    }
    return rows;
  });
  tbb::enumerable_thread_specific<RealFftLine> lines(lengths.x);
  tbb::parallel_for(std::size_t{0}, rows, [&](std::size_t row) {
    RealFftLine& line = lines.local();
    std::ranges::copy(spectra.row(row), line.spectrum().begin());
    line.inverse();
    use(row, line.real());
  });
}

// Both halves of a map, which are the same turned by half a turn, from a row of lags.
template <class Set>
void set_lags(Autocorrelation& map, std::size_t lag_y, std::span<const double> sums, const Set& set) {
  const std::size_t width = 2 * map.lag_x + 1;
  double* below = map.values.data() + (map.lag_y + lag_y) * width;
  double* above = map.values.data() + (map.lag_y - lag_y) * width;
  for (std::size_t k = 0; k < width; ++k) {
    const double sum = sums[(k + sums.size() - map.lag_x) % sums.size()];
    const auto x = std::abs(static_cast<double>(k) - static_cast<double>(map.lag_x));
    set(below[k], sum, x);
    if (lag_y > 0) above[width - 1 - k] = below[k];
  }
}

}  // namespace

Autocorrelation autocorrelation(const HeightField& field) {
  require(field.columns() >= 2 && field.rows() >= 2, "an autocorrelation needs 2 x 2 samples at least");
  const double mean = mean_um(field);
  Autocorrelation result{field.columns() / 2, field.rows() / 2, field.grid().pitch_x, field.grid().pitch_y, {}};
  // A patch is padded, so that no pair wraps at the lags that are kept.
  const auto length = [&](std::size_t count, std::size_t lag) {
    return field.periodic() ? count : quick_fft_length(count + lag);
  };
  const Lengths lengths{length(field.columns(), result.lag_x), length(field.rows(), result.lag_y)};
  const double scale = 1.0 / static_cast<double>(lengths.x) / static_cast<double>(lengths.y);
  result.values.resize((2 * result.lag_x + 1) * (2 * result.lag_y + 1));
  const std::size_t missing = field.missing_count();
  const auto columns = static_cast<double>(field.columns()), rows = static_cast<double>(field.rows());
  pair_sums(
      field, lengths, [mean](double z) { return z - mean; },
      [&](std::size_t lag_y, std::span<const double> sums) {
        const double rows_left = field.periodic() ? rows : rows - static_cast<double>(lag_y);
        set_lags(result, lag_y, sums, [&](double& at, double sum, double lag_x) {
          at = scale * sum;
          if (missing == 0) at /= (field.periodic() ? columns : columns - lag_x) * rows_left;
        });
      });
  if (missing > 0) {
    pair_sums(
        field, lengths, [](double) { return 1.0; },
        [&](std::size_t lag_y, std::span<const double> sums) {
          set_lags(result, lag_y, sums, [&](double& at, double sum, double) {
            const double count = std::round(scale * sum);
            at = count > 0.0 ? at / count : std::nan("");
          });
        });
  }
  const double variance = result.at(0, 0);
  require(variance > 0.0, "a flat field has no autocorrelation");
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, result.values.size(), 65536), [&](const auto& some) {
    for (std::size_t k = some.begin(); k < some.end(); ++k) result.values[k] /= variance;
  });
  return result;
}

}  // namespace mezzotint
