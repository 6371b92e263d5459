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

/// Huber's bound, and what it makes of normal residuals: E ψ', E ψ² and E ψ(r)/r.
inline constexpr double huber_bound = 1.5;
inline constexpr double huber_mean_slope = 0.86639, huber_mean_square = 0.77847, huber_mean_weight = 0.97327;

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
