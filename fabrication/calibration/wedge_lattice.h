#pragma once

#include <cstddef>
#include <span>
#include <vector>

/// Inside of fabrication/calibration.

namespace mezzotint {

/// Strips of one width along a profile, in samples from its start: strip i from `first` + i·width on.
struct Lattice {
  double first = 0.0, width = 0.0;
  bool reversed = false;  ///< strip 0 is the last of the told ones
  double cost = 0.0;      ///< sum of squares about the strips' and the frame's means, and of what is not in order
};

/// A profile along a wedge, NaN where nothing was measured, with the sums that any part of it costs by.
class WedgeProfile {
public:
  explicit WedgeProfile(std::span<const double> heights_um);

  [[nodiscard]] double length() const { return static_cast<double>(sums_.size() - 1); }
  /// Number of samples, sum and sum of squares between two places, fractions of samples included.
  struct Sums {
    double count = 0.0, sum = 0.0, square = 0.0;
    [[nodiscard]] double about_mean() const { return count > 0.0 ? square - sum * sum / count : 0.0; }
  };
  [[nodiscard]] Sums between(double from, double to) const;
  /// Places where the height jumps, the clearest first, at most `most`; what is nearer to another than `apart` is not
  /// counted.
  [[nodiscard]] std::vector<double> jumps(double apart, std::size_t most) const;

private:
  [[nodiscard]] Sums until(double place) const;
  std::vector<Sums> sums_;  ///< of all samples before each
};

/// The lattice of n strips that fits best, where heights must not fall as gray values rise; the profile beside it is
/// frame, of one height.
/// @param grays  of the strips, in the order told; empty: no order is asked for
[[nodiscard]] Lattice fit_lattice(const WedgeProfile& profile, std::size_t strips, std::span<const double> grays);

}  // namespace mezzotint
