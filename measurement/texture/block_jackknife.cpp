#include "measurement/texture/block_jackknife.h"

#include <cmath>
#include <limits>

namespace mezzotint {

double jackknife_standard_error(double whole, std::span<const double> without, std::span<const double> samples) {
  double total = 0.0, blocks = 0.0;
  for (const double count : samples) {
    total += count;
    blocks += count > 0.0 ? 1.0 : 0.0;
  }
  if (blocks < 2.0) return std::numeric_limits<double>::quiet_NaN();
  double estimate = blocks * whole;
  for (std::size_t j = 0; j < samples.size(); ++j) {
    if (samples[j] > 0.0) estimate -= (1.0 - samples[j] / total) * without[j];
  }
  double variance = 0.0;
  for (std::size_t j = 0; j < samples.size(); ++j) {
    if (samples[j] == 0.0) continue;
    const double h = total / samples[j];
    const double off = h * whole - (h - 1.0) * without[j] - estimate;
    variance += off * off / (h - 1.0);
  }
  return std::sqrt(variance / blocks);
}

}  // namespace mezzotint
