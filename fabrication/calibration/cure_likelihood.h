#pragma once

#include <array>
#include <vector>

#include "fabrication/calibration/cure_fit.h"

/// Inside of fabrication/calibration.

namespace mezzotint {

/// (α in µm, ln β in µm, γ): β stays positive.
using CureParameters = std::array<double, 3>;
using FreeParameters = std::array<bool, 3>;

/// A point as the likelihood sees it.
struct WeighedPoint {
  double gray, exposure, height_um, error_um;
  PointRole role;
};

/// Height of the curve and its slopes toward the parameters, between 0 and the layer; beyond both it does not move.
struct CurveValue {
  double height_um;
  CureParameters slopes;
};
[[nodiscard]] CurveValue curve_value(const CureParameters& parameters, double gray, double exposure, double layer_um);

/// Student's loss of a residual r of standard errors, ½ (ν + 1) ln(1 + r²/ν) with ν = 5; its slope is
/// ψ = (ν + 1) r/(ν + r²), so that what lies far off is all but ignored. And what normal residuals make of it:
/// E ψ', E ψ² and E ψ/r.
inline constexpr double student_freedom = 5.0;
inline constexpr double mean_loss_slope = 0.807644, mean_loss_square = 0.692480, mean_loss_weight = 1.038471;
/// How much of a residual of r standard errors counts: 1 for none, ν/(ν + r²).
[[nodiscard]] inline double residual_weight(double r) { return student_freedom / (student_freedom + r * r); }

/// A point's share of 2·(−log likelihood) as the square of a residual, with its slopes.
struct PointLoss {
  double root;
  CureParameters slopes;
};
[[nodiscard]] PointLoss point_loss(const WeighedPoint& point, const CureParameters& parameters, double layer_um);

/// ½ Σ root².
[[nodiscard]] double total_loss(const std::vector<WeighedPoint>& points, const CureParameters& parameters,
                                double layer_um);

/// The nearest minimum over the free parameters, from a start.
[[nodiscard]] CureParameters minimize_loss(const std::vector<WeighedPoint>& points, const CureParameters& start,
                                           const FreeParameters& free, double layer_um);

/// The least loss of all: γ free or fixed at `gamma`. Starts from straight lines over ln(k (I − γ)) for many γ.
struct LeastLoss {
  CureParameters parameters;
  double loss;
};
[[nodiscard]] LeastLoss least_loss(const std::vector<WeighedPoint>& points, double layer_um);
[[nodiscard]] LeastLoss least_loss_at(const std::vector<WeighedPoint>& points, double gamma, double layer_um);

/// Fisher's information of the parameters (α, ln β, γ), from all points with the weights of the loss.
[[nodiscard]] std::array<std::array<double, 3>, 3> information(const std::vector<WeighedPoint>& points,
                                                               const CureParameters& parameters, double layer_um);

inline constexpr double least_gamma = -1.0, largest_gamma = 0.99;  ///< as a printer file takes them

}  // namespace mezzotint
