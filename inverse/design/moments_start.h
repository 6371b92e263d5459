#pragma once

#include <vector>

#include "forward/pattern/pattern.h"
#include "forward/process/printer_profile.h"
#include "inverse/search/minimize.h"
#include "inverse/target/target.h"

namespace mezzotint {

/// The lowest rung of the search: parameters by the closed-form moments of the print alone (printed_moments), in
/// microseconds an evaluation.
class MomentsModel {
public:
  MomentsModel(const Pattern& pattern, const std::vector<Variable>& variables, const PrinterProfile& printer,
               Length wavelength)
      : pattern_(pattern), variables_(variables), printer_(printer), wavelength_(wavelength) {}

  /// Whether the pattern has such moments.
  [[nodiscard]] bool exists() const;
  [[nodiscard]] SlopeCovariance covariance(const std::vector<double>& values) const;

  /// The values whose moments are nearest to `wanted`; of the many that are alike (a pattern and its enlargement have
  /// the same slopes) those that lie close to `from`.
  [[nodiscard]] std::vector<double> solve(const Target& wanted, const std::vector<double>& from) const;

private:
  const Pattern& pattern_;
  const std::vector<Variable>& variables_;
  const PrinterProfile& printer_;
  Length wavelength_;
};

/// The covariance to ask of the moments so that the print shows `wanted`, from what both show at one place: with
/// m = B s B, s the print's, m the moments', B symmetric, it is B·wanted·B.
/// Source  space mapping: Bandler et al., IEEE Trans. Microwave Theory Tech. 42 (1994); Echeverría and Hemker, Comput.
///         Methods Appl. Math. 5 (2005).
[[nodiscard]] SlopeCovariance mapped(const SlopeCovariance& moments, const SlopeCovariance& shown,
                                     const SlopeCovariance& wanted);

/// Points of the variables' box that fill it evenly (a Latin hypercube), by the seed.
[[nodiscard]] std::vector<std::vector<double>> spread_points(const std::vector<Variable>& variables, std::size_t count,
                                                             std::uint64_t seed);

}  // namespace mezzotint
