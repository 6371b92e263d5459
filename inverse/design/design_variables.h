#pragma once

#include <optional>
#include <string>
#include <vector>

#include "forward/pattern/pattern.h"
#include "forward/process/printer_profile.h"
#include "inverse/search/minimize.h"
#include "inverse/target/target.h"

namespace mezzotint {

/// A parameter that the search may change, by the name that the pattern's table gives it.
struct FreeParameter {
  std::string name;
  double low = 0.0;
  double high = 0.0;
  std::optional<double> start;  ///< left out: the closed-form start
};

/// The free parameters as variables with their starts: explicit ones, and closed-form ones cut to the bounds.
/// @throws InvalidInput for an unknown or whole parameter, or bounds outside of its range.
[[nodiscard]] std::vector<Variable> design_variables(const Pattern& pattern, const std::vector<FreeParameter>& free,
                                                     const Target& target, const PrinterProfile& printer,
                                                     Length wavelength);

/// The pattern with the variables' values.
[[nodiscard]] Pattern with_values(Pattern pattern, const std::vector<Variable>& variables,
                                  const std::vector<double>& values);

/// Whether a variable is a direction of a pattern, which comes back after half a turn.
[[nodiscard]] bool is_axis(const Variable& variable);

}  // namespace mezzotint
