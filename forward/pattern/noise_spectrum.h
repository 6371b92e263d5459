#pragma once

namespace mezzotint {

/// Power spectral density of sparse convolution noise on the lattice plane z = 0, averaged over the cell.
///
///     S(f) = c² N (⅓ ∫ |k̂(f, f_z)|² df_z − ⅛ |k̂(f, 0)|² sinc²(f_x) sinc²(f_y)),  k̂ the transform of (1 − 4 r²)³
///
/// The first term is that of impulses that know nothing of each other. The second is what the alternating signs take
/// away: the weights of a cell have the mean ½ · (±1), and pairs of cells stand on both sides of the plane.
///
/// Frame    f along the axes of the lattice, in cycles a cell.
/// Units    ∫∫ S df_x df_y = noise_variance_at_z0, ∫∫ (2π|f|)² S df_x df_y = noise_plane_gradient_square_at_z0.
/// Valid    to 1e-5 of its value up to |f| = 12, where it is 1e-8 of its highest; 0 beyond.
/// Source   Campbell's theorem for the impulses; Lewis, "Algorithms for solid noise synthesis", SIGGRAPH 1989. The
///          transform of (1 − r²/R²)^μ: Stein and Weiss, Fourier Analysis on Euclidean Spaces (1971), IV.4.
[[nodiscard]] double noise_spectral_density(double f_x, double f_y);

}  // namespace mezzotint
