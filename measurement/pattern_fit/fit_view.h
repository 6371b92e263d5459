#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "forward/surface/height_field.h"

/// Inside of measurement/pattern_fit.

namespace mezzotint {

/// Neighbouring frequencies, seen as one.
struct FrequencyBlock {
  double x_per_um = 0.0, y_per_um = 0.0;  ///< their mean
  double count = 0.0;                     ///< how many, of the half-plane
};

/// How a fit looks at a scan, and at every relief that it compares with it: where samples are missing, the ends
/// tapered, and frequencies of the half-plane gathered in blocks that grow with the distance from 0, since spectra of
/// patterns are smooth. What all of that does to a spectrum, it does to both sides alike.
///
/// Left out  frequencies of up to one wave along both sides, which levelling takes, and the last ones of even sides.
/// Taper     a cosine over a tenth of each side at each end (Tukey): leakage falls fast, at 1.25 times the variance of
///           an estimate without taper.
class FitView {
public:
  /// @param scan  at least 32 × 32 samples
  explicit FitView(const HeightField& scan);

  [[nodiscard]] const Grid& grid() const { return grid_; }
  [[nodiscard]] const std::vector<FrequencyBlock>& blocks() const { return blocks_; }

  /// With the scan's missing samples missing, and levelled by the least-squares plane.
  [[nodiscard]] HeightField seen(const HeightField& field) const;
  /// Mean periodogram of each block in µm⁴, of a field as `seen` gives it; holes are filled by Laplace's equation.
  [[nodiscard]] std::vector<double> periodogram(const HeightField& field) const;
  /// The same with a level added that hides what is too quiet to be a pattern's own: on scan and draws alike, so that
  /// it is a part of both floors. A pattern sampled finely has most of its frequencies there, where all that is seen is
  /// how its drawing interpolates and how heights are rounded; unhidden, they would decide the fit.
  [[nodiscard]] std::vector<double> audible(const HeightField& field) const;
  /// Sets that level by the scan's own periodogram.
  void listen_to(const std::vector<double>& periodogram_um4);

  /// Of so many frequencies, how many the taper leaves independent.
  static constexpr double independent_share = 1.0 / 1.246;

private:
  void gather(std::size_t fineness);

  Grid grid_;
  std::vector<std::size_t> missing_;
  std::vector<double> taper_x_, taper_y_;
  std::vector<FrequencyBlock> blocks_;
  double quiet_um4_ = 0.0;
  std::vector<std::uint32_t> block_of_;  // of each frequency of the spectrum; blocks_.size(): none
};

}  // namespace mezzotint
