#pragma once

#include "forward/base/quantity.h"
#include "forward/optics/direction_map.h"
#include "forward/surface/height_field.h"
#include "forward/surface/slope_covariance.h"

namespace mezzotint {

/// The slopes of a measured surface, which are its microfacet normal distribution.
///
/// distribution  D(m) in 1/sr, averaged over the bins of a direction map of the facets' upward normals:
///               ∫ D(m) (m·n) dm = 1, so that Σ D·(projected solid angle) = 1.
/// axes          RMS slopes about the mean slope, along their own axes (Beckmann's α is √2 times that).
/// kurtosis      of the slopes along those axes: 3 for Gaussian slopes, for which D is Beckmann's; NaN where there are
///               none. Standard errors: delete-one-block jackknife over 16 blocks.
/// shortest_um   the finest wavelength that the samples hold: two spacings. Slopes from finer structure are not in it;
/// longest_um    the longer side of the field. An instrument may resolve less than its samples: state its own limit.
/// Missing       cells with a missing corner are left out.
/// Source        facets as rays meet them (two triangles a cell). Bandwidth: Li and Torrance, "An experimental study of
///               the correlation between surface roughness and light scattering", SPIE 5878 (2005).
struct NormalDistribution {
  DirectionGrid grid;
  DirectionMap distribution;
  SlopeAxes axes;
  Quantity kurtosis_major, kurtosis_minor;
  double shortest_um = 0.0, longest_um = 0.0;
};

/// @throws InvalidInput when no whole cell is left.
[[nodiscard]] NormalDistribution normal_distribution(const HeightField& field, const DirectionGrid& grid = {});

}  // namespace mezzotint
