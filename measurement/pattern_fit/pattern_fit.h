#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "forward/base/progress.h"
#include "forward/base/quantity.h"
#include "forward/pattern/pattern.h"

namespace mezzotint {

/// A number of a fitted pattern under its name in files, with the ends of its 95 % interval; none where it was set, not
/// fitted (octaves, a lacunarity of 2, the stretch of a texture that is alike in all directions).
struct FittedParameter {
  std::string name;
  Quantity quantity;
  std::optional<double> low_95, high_95;
};

/// A question that a texture was asked, and how probable so bad an answer is for the pattern itself.
struct FitTest {
  std::string name;  ///< "spectrum", "directions", "shape", "evenness"; of lines "remainder"
  double probability = 1.0;
};

/// What was tried besides, and by how much less likely it is (natural logarithm, with a penalty for its numbers).
struct FitAlternative {
  std::string what;
  double log_likelihood_lost = 0.0;
};

/// The pattern nearest to a texture.
struct PatternFit {
  Pattern pattern;
  std::vector<FittedParameter> parameters;
  bool fits = false;  ///< else `pattern` is the nearest of those that do not fit
  std::vector<FitTest> tests;
  std::string verdict;             ///< in words
  Quantity white_noise;            ///< RMS of the white noise that lies over the pattern, µm
  double unexplained_share = 0.0;  ///< lines: mean square of what is left over ÷ that of the heights
  double cells = 0.0;              ///< cells or waves along the shorter side
  double missing_share = 0.0;
  std::vector<FitAlternative> alternatives;
  std::vector<std::string> notes;
};

/// draws        reliefs that are synthesized with the fitted pattern and looked at like the scan, 24 … 1000
/// false_alarm  how often a texture that is such a pattern may be sent away, 1e-6 … 0.5 (docs/physics.md has how
///              often it was: of 100 noises none, of 50 fBm two where 1 % was asked for)
/// kinds        which patterns are tried: "noise", "fbm", "sinusoid", "ridges"; empty: all
struct PatternFitOptions {
  std::vector<std::string> kinds;
  std::size_t draws = 40;
  double false_alarm = 0.01;
  std::uint64_t seed = 1;
};

/// From a relief to the pattern that it may be a draw of.
///
/// Lines    sinusoid, ridges: least squares from the peaks of the spectrum, with the residual's density beside the
///          lines as the noise. They are taken where they explain half of the heights, or all but white noise.
/// Noise    Whittle's likelihood of the tapered periodogram under the closed-form spectrum of the sampled pattern and a
///          white floor; the number of octaves by the likelihood with Schwarz's penalty. The fitted pattern is then
///          synthesized again and again on the scan's grid, with its missing samples, and fitted likewise: the scatter
///          gives the intervals (a sandwich that needs no Gaussian heights), the shift is taken off the fit.
/// Judged   by what the draws themselves show: power in rings and in sectors of the spectrum, skewness and kurtosis of
///          heights and slopes, and whether all parts of the patch are alike. A ring that holds less than 1e-4 of the
///          variance is not judged. A Gaussian field with the pattern's spectrum is told by its slopes alone.
/// Missing  samples are filled by Laplace's equation for the spectrum, in the draws too; lines leave them out.
/// Units    as the pattern's; lengths as the scan's.
/// @throws  InvalidInput for fewer than 32 × 32 samples, a flat field, more than half missing, or a patch that holds
///          fewer than 8 cells of the noise that fits (2.5 waves of lines), saying how large it should be.
/// Source   Whittle, Biometrika 41 (1954); bias and intervals by simulation: Gourieroux, Monfort and Renault,
///          Journal of Applied Econometrics 8 (1993).
[[nodiscard]] PatternFit fit_pattern(const HeightField& scan, const PatternFitOptions& options = {},
                                     const Progress& progress = {});

}  // namespace mezzotint
