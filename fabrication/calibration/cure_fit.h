#pragma once

#include <array>
#include <string>
#include <vector>

#include "fabrication/calibration/cure_point.h"
#include "forward/process/cure_curve.h"

namespace mezzotint {

/// What a measured height says of the curve.
enum class PointRole {
  Measured,   ///< its height
  BelowCure,  ///< no more than that it cured less than can be told from nothing: 2 standard errors
  Saturated   ///< no more than that it filled the layer, or lacked less than 2 standard errors of it
};
[[nodiscard]] std::string_view role_name(PointRole role);

/// A point of less weight is named in the notes: it lies more than some 4 standard errors off.
inline constexpr double suspicious_weight = 0.25;

struct FittedPoint {
  CurePoint point;
  PointRole role = PointRole::Measured;
  double error_um = 0.0;      ///< standard error that it was weighted with
  double predicted_um = 0.0;  ///< of the fitted curve, within 0 and the layer
  double residual_um = 0.0;   ///< measured − predicted
  double weight = 1.0;        ///< ν/(ν + r²): below 1 the more standard errors r it lies off
};

/// A parameter with its 95 % interval; ±∞ where the data set no bound.
struct FittedNumber {
  double value = 0.0;
  double standard_error = 0.0;
  double low_95 = 0.0, high_95 = 0.0;
};

struct CureFitOptions {
  CureCurve base;                        ///< whose γ stands where the data do not determine it
  Length layer = Length::from_um(18.0);  ///< no step is higher
  double common_error_um = 0.0;          ///< standard error that all heights share (of the base that they are over)
};

struct CureFit {
  CureCurve curve;
  FittedNumber alpha_um, beta_um, gamma;
  /// Of (α in µm, β in µm, γ); row and column of γ are 0 where it was not fitted.
  std::array<std::array<double, 3>, 3> covariance{};
  bool gamma_is_determined = true;
  double chi_squared = 0.0;  ///< of the measured points, by their own errors (or 0 where none were given)
  double probability = 1.0;  ///< of a χ² at least as large, if curve and errors are right
  int degrees_of_freedom = 0;
  bool errors_were_given = true;
  /// What the given errors were multiplied with, since the heights scatter more than they say; where none were given,
  /// the standard error of one measurement in µm.
  double scale = 1.0;
  double quantile =
      1.96;  ///< half width of an interval in standard errors: normal, or Student's where `scale` is fitted
  std::vector<FittedPoint> points;
  std::vector<std::string> notes;
};

/// The cure curve through measured heights: height = α + β ln(k (I − γ)), k the exposure, within 0 and the layer.
///
/// Threshold  Heights below 2 standard errors say no more than that they are: their share of the likelihood is the
///            chance of a height so low (Tobit's), whatever their exact value. Nothing is dropped. Heights within 2
///            standard errors of the layer, or above, likewise.
/// Outliers   Student's loss with 5 degrees of freedom, which all but ignores what lies far off (94 % of the
///            efficiency of least squares where nothing does). A point that counts less than a quarter (4 standard
///            errors) is named.
/// Scale      Where the points bring standard errors they are trusted, unless χ² has a chance below 1 %: then they
///            are scaled to the scatter, robustly, and intervals are Student's. Without them the scatter tells.
/// Intervals  by profile likelihood (they are not symmetric), with the loss's own scale. γ is determined where its
///            interval ends above −1; where not, γ is the base's (or the nearest end of the interval), α and β
///            hold for that γ, and a note says so.
/// Errors     InvalidInput for fewer than two different doses that cured without filling the layer, for numbers that
///            are not finite, gray values outside of [0, 1], or where a scatter cannot be known (no errors and no more
///            points than parameters), and where the curve found would cure at gray 0.
/// Source     Tobin, Econometrica 26 (1958); Lange, Little, Taylor, JASA 84 (1989), on Student's
///            errors; Huber, "Robust Statistics" 1981 (proposal 2 for the scale);
///            least squares by the Levenberg–Marquardt method of MINPACK (Eigen).
[[nodiscard]] CureFit fit_cure(const std::vector<CurePoint>& points, const CureFitOptions& options = {});

/// Standard error of the curve's height at a dose (k, I), from the fit's covariance.
[[nodiscard]] double height_error_um(const CureFit& fit, double gray, double exposure = 1.0);

}  // namespace mezzotint
