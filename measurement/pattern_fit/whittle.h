#pragma once

#include <vector>

#include <Eigen/Core>

#include "measurement/pattern_fit/noise_model.h"

/// Inside of measurement/pattern_fit.

namespace mezzotint {

/// A spectrum to explain: the blocks that count and what was seen there.
struct SeenSpectrum {
  Grid grid;
  std::vector<FrequencyBlock> blocks;
  std::vector<double> density_um4;
};

/// Whittle's log-likelihood of a spectrum, −Σ n (ln S + I/S) over blocks of n frequencies, corrected for what the
/// taper makes dependent.
[[nodiscard]] double log_likelihood(const SeenSpectrum& seen, const std::vector<double>& expected);

/// A local maximum of the likelihood.
///
/// sensitivity   ∂ ln S / ∂(free number), a column each, at the maximum
/// information   Σ n · sensitivity · sensitivityᵀ
struct NoiseFit {
  NoiseModel model;
  NoiseNumbers numbers;
  double log_likelihood = 0.0;
  std::vector<double> expected_um4;
  Eigen::MatrixXd sensitivity;
  Eigen::MatrixXd information;
};

/// Fisher scoring with Levenberg's damping from `start`, within the bounds of what the view can tell.
/// @param enough  the gain of a round after which no further one is made
/// Source   Whittle, "On stationary processes in the plane", Biometrika 41 (1954).
[[nodiscard]] NoiseFit maximise(const NoiseModel& model, const NoiseNumbers& start, const SeenSpectrum& seen,
                                double enough = 1e-3);

/// One step of scoring from a fit towards another spectrum of the same view: what that spectrum's own fit would be,
/// but for terms of second order.
[[nodiscard]] NoiseNumbers step_towards(const NoiseFit& fit, const SeenSpectrum& other);

/// The largest cell that is looked for: a quarter of the shorter side; the smallest: 2.5 samples.
struct ScaleBounds {
  double least_um, most_um;
};
[[nodiscard]] ScaleBounds scale_bounds(const Grid& grid);

}  // namespace mezzotint
