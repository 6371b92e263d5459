#pragma once

#include <array>
#include <vector>

#include "forward/optics/direction.h"
#include "measurement/reflectance/lobe_samples.h"

namespace mezzotint {

/// Values at the nodes of a grid over the unit square, bilinear between them; several such grids (slices) one after
/// the other. Shape: slice by slice, rows along y, columns along x.
struct UnitSquareGrid {
  std::size_t columns = 0, rows = 0;
  std::vector<float> values;
};

/// A BRDF sampled where it matters: for every direction of the light a map of the unit square, warped by the
/// distribution of visible normals, so that a lobe fills it whatever its width.
///
/// Frame    microfacet normal m = half vector: x = √(2θ_m/π), y = φ_m/2π + ½ (φ_m − φ_i where the sample is isotropic).
///          A light at (θ_i, φ_i) uses √(2θ_i/π) and φ_i/2π + ½ in `sigma`.
/// Shape    slices of `visible` and `samples`: φ_i by φ_i, θ_i by θ_i (and channel by channel).
/// Source   Dupuy & Jakob 2018, "An adaptive parameterization for efficient material acquisition and rendering",
///          eqs. 10–18 and the layout of its reference loader. `samples` · D/(4σ) is the BRDF times cosθ_o.
struct AdaptiveTensor {
  std::vector<double> phi_i_rad, theta_i_rad;
  int reduction = 1;  ///< 2: φ_i covers half a turn, the rest by rotation by 180°; 4: a quarter, the rest mirrored
  bool isotropic = true;
  std::size_t channels = 0;
  UnitSquareGrid normals;            ///< D
  UnitSquareGrid sigma;              ///< projected area of the microsurface
  UnitSquareGrid visible;            ///< normalised distribution of visible normals
  std::vector<float> row_integrals;  ///< of `visible`: along a row up to each node
  std::vector<float> integrals;      ///< of `visible`: of the rows up to each one
  UnitSquareGrid samples;            ///< NaN where the file calls them invalid
};

/// Fills the integrals from `visible` and normalises all three.
/// @throws InvalidInput for a slice without any light.
void integrate_visible(AdaptiveTensor& tensor);

/// NaN outside of the θ_i and φ_i of the file, and where a sample around the direction is invalid.
[[nodiscard]] double evaluate(const AdaptiveTensor& tensor, const Direction& to_light, const Direction& to_viewer,
                              const ChannelWeights& weights);

}  // namespace mezzotint
