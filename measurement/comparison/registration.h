#pragma once

#include "forward/base/progress.h"
#include "forward/surface/height_field.h"

namespace mezzotint {

/// A length or angle or figure with its standard error.
struct LengthEstimate {
  Length value;
  Length standard_error;
};
struct AngleEstimate {
  Angle value;
  Angle standard_error;
};

/// Where a measured relief lies on the designed one.
///
/// Frame    a point p of the design is found at R(rotation)·(p − centre) + centre + shift in the measurement,
///          centre = the middle of the design's samples (half way from the first to the last).
/// Errors   standard errors hold for this placement: they know the noise and every other difference between the
///          two reliefs, and how far these are correlated, but not that a periodic relief fits elsewhere as well
///          (`runner_up` tells that). Infinite where nothing fixes a figure, as the shift along straight ridges.
struct Registration {
  LengthEstimate shift_x;
  LengthEstimate shift_y;
  AngleEstimate rotation;
  double correlation = 0.0;  ///< of the overlapping heights after registration, −1…1
  double overlap = 0.0;      ///< share of the design's area that was measured
  double runner_up = 0.0;    ///< correlation of the next best, separate placement; near `correlation`: ambiguous
  Length residual_rms;       ///< of the measured heights about the design, a plane taken out, not smoothed
};

struct RegistrationOptions {
  Angle largest_rotation = Angle::from_degrees(5.0);  ///< searched both ways; the time is proportional to it
  double least_correlation = 0.5;                     ///< of heights, noise included; below it nothing is answered
};

/// Finds a measurement's placement to a fraction of a sample: coarse by masked FFT correlation over
/// rotations at reduced resolution, then Gauss–Newton on the heights (shift, rotation, and a plane that takes
/// tilt and offset). Missing samples are left out, outliers are not (`mask_outliers` first).
///
/// Shape    pitches and sizes may differ, and the measurement may be larger or smaller than the design; a fifth of
///          the smaller one must be seen. Where the measurement's pitch is the larger one, the design is averaged
///          over its pixels first. A periodic design is one patch here, not continued.
/// Result   the same bits with any number of threads.
/// @throws InvalidInput for surfaces of fewer than 16 × 16 samples, or options out of range.
/// @throws MethodError when no placement reaches `least_correlation`, with the best one in words; when the best
///         could be chance (too few features overlap); or when one of the surfaces is flat.
/// Source   Padfield, "Masked object registration in the Fourier domain", IEEE TIP 21 (2012).
[[nodiscard]] Registration register_surfaces(const HeightField& design, const HeightField& measured,
                                             const RegistrationOptions& options = {}, const Progress& progress = {});

/// The measurement brought into the design's frame and grid (bicubic; missing outside), its plane relative to
/// the design removed. A measurement that is finer than the design is averaged over the design's cells first.
/// Interpolating between samples averages their noise: by 0.64 (in RMS) half way between four of them.
/// @throws InvalidInput when nothing of it lies on the design.
[[nodiscard]] HeightField resample_to_design(const HeightField& design, const HeightField& measured,
                                             const Registration& registration);

/// measured − design on the design's grid, where both exist.
/// @throws InvalidInput for different grids.
[[nodiscard]] HeightField residual(const HeightField& design, const HeightField& resampled);

}  // namespace mezzotint
