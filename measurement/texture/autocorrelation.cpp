#include "measurement/texture/autocorrelation.h"

#include <cmath>
#include <complex>

#include "forward/base/error.h"
#include "forward/base/fft.h"

namespace mezzotint {

namespace {

double mean_um(const HeightField& field) {
  double sum = 0.0, count = 0.0;
  for (const float z : field.heights_um()) {
    if (std::isnan(z)) continue;
    sum += static_cast<double>(z);
    count += 1.0;
  }
  require(count > 0.0, "no sample was measured: there is nothing to correlate");
  return sum / count;
}

// Σ over pairs at each lag of value · value; a sample without a value counts as 0.
template <class Value>
std::vector<double> pair_sums(RealFft2d& fft, const HeightField& field, const Value& value) {
  std::ranges::fill(fft.real(), 0.0);
  for (std::size_t row = 0; row < field.rows(); ++row)
    for (std::size_t column = 0; column < field.columns(); ++column) {
      const float z = field.at(column, row);
      if (!std::isnan(z)) fft.real()[row * fft.columns() + column] = value(static_cast<double>(z));
    }
  fft.forward();
  for (std::complex<double>& s : fft.spectrum()) s = std::norm(s);
  fft.inverse();
  return {fft.real().begin(), fft.real().end()};
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
  RealFft2d fft(length(field.columns(), result.lag_x), length(field.rows(), result.lag_y));
  const std::vector<double> products = pair_sums(fft, field, [mean](double z) { return z - mean; });
  const bool whole = field.missing_count() == 0;
  const std::vector<double> pairs = whole ? std::vector<double>() : pair_sums(fft, field, [](double) { return 1.0; });
  const auto count_at = [&](std::ptrdiff_t x, std::ptrdiff_t y, std::size_t place) {
    if (!whole) return std::round(pairs[place]);
    if (field.periodic()) return static_cast<double>(field.grid().size());
    return (static_cast<double>(field.columns()) - std::abs(static_cast<double>(x))) *
           (static_cast<double>(field.rows()) - std::abs(static_cast<double>(y)));
  };
  const double variance = products[0] / count_at(0, 0, 0);
  require(variance > 0.0, "a flat field has no autocorrelation");
  const auto lag_x = static_cast<std::ptrdiff_t>(result.lag_x), lag_y = static_cast<std::ptrdiff_t>(result.lag_y);
  result.values.reserve((2 * result.lag_x + 1) * (2 * result.lag_y + 1));
  for (std::ptrdiff_t y = -lag_y; y <= lag_y; ++y)
    for (std::ptrdiff_t x = -lag_x; x <= lag_x; ++x) {
      const std::size_t column = x < 0 ? fft.columns() - static_cast<std::size_t>(-x) : static_cast<std::size_t>(x);
      const std::size_t row = y < 0 ? fft.rows() - static_cast<std::size_t>(-y) : static_cast<std::size_t>(y);
      const std::size_t place = (row % fft.rows()) * fft.columns() + column % fft.columns();
      const double count = count_at(x, y, place);
      result.values.push_back(count > 0.0 ? products[place] / count / variance : std::nan(""));
    }
  return result;
}

}  // namespace mezzotint
