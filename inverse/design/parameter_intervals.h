#pragma once

#include <string>
#include <vector>

#include "inverse/design/design_goal.h"
#include "inverse/search/minimize.h"

namespace mezzotint {

/// A direction in the space of parameters: how each variable changes along it, per unit: by a factor e^c where it is
/// logarithmic, by c radians where it is an angle, else by c.
struct ParameterCombination {
  std::vector<double> change;  ///< of unit length
  double half_width_95 = 0.0;  ///< of the 95 % interval along it
  bool determined = false;     ///< false: a null direction; the target says nothing of it
};

/// What the target says of the parameters that were found.
///
/// Source of the uncertainty  the draws of the search are few, and so may be those that a measured target stands for.
/// Not in it                  an error of the model itself: blur, cure curve and ground as the printer's profile has
/// them.
struct ParameterIntervals {
  std::vector<ParameterCombination> combinations;  ///< the best determined first
  /// Of each variable by itself, in the units of `change`; infinite where a null direction moves it.
  std::vector<double> half_widths_95;
};

/// Method   the sandwich of an estimator that lowers |r(θ)|²: J = ∂r/∂θ by central differences on the search's draws;
///          Σ the covariance of r, from delete-one pseudo-values of the draws; θ's is J⁺ Σ J⁺ᵀ, widened by a target
///          that was seen on `target_draws` draws of the same size; Student's t of draws − 1 degrees of freedom. r by
///          measure: slope covariance log(T^(−½) C T^(−½)); cube root, L2 and logarithm the differences of the bins;
///          moments and Wasserstein the slopes that the light implies, and how much there is.
/// Null     a direction along which the figure changes too little to fix it to a quarter (25 %, 0.25 rad).
/// @param fresh         draws at the place that was found, as printed
/// @param target_draws  infinite for a target that is a formula
/// @throws InvalidInput for fewer than three draws of either kind.
[[nodiscard]] ParameterIntervals parameter_intervals(const DesignGoal& goal, const MeasureSum& lowered,
                                                     const SlopeModel& model, const Pattern& pattern,
                                                     const std::vector<Variable>& variables,
                                                     const std::vector<double>& values,
                                                     const std::vector<SlopeModel::Shown>& fresh, double target_draws);

/// A combination in words: "height_um and wavelength_u_um together (× e^0.71, × e^0.70)".
[[nodiscard]] std::string in_words(const ParameterCombination& combination, const std::vector<Variable>& variables);

}  // namespace mezzotint
