#pragma once

#include "forward/surface/resample.h"
#include "measurement/instrument/virtual_profilometer.h"

/// Inside of measurement/instrument.

namespace mezzotint {

/// How far a relief is known: a periodic one up to the end of its period, where it begins again.
[[nodiscard]] FieldPoint extent_of(const HeightField& relief);

/// A relief as it lies under the instrument: the frame of VirtualProfilometer.
class PlacedRelief {
public:
  /// Keeps a reference to the relief.
  PlacedRelief(const HeightField& relief, const VirtualProfilometer& instrument);

  /// Mean of the tilted relief over a square pixel as wide as the pitch; NaN where the pixel is not wholly on the
  /// relief. Its points lie so close that none of the relief's samples is passed over.
  [[nodiscard]] double pixel_um(FieldPoint seen) const;
  /// Slope of the tilted relief in the middle of a pixel; NaN outside of it.
  [[nodiscard]] double slope(FieldPoint seen) const;

private:
  [[nodiscard]] FieldPoint on_relief(FieldPoint seen) const;
  [[nodiscard]] bool holds(FieldPoint point) const;
  [[nodiscard]] double height_um(FieldPoint seen) const;

  const HeightField& relief_;
  FieldPoint extent_, middle_, shift_;
  double cos_, sin_;
  double tilt_x_, tilt_y_;
  double width_um_;  ///< of a pixel
  int across_;       ///< points
};

}  // namespace mezzotint
