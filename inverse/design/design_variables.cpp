#include "inverse/design/design_variables.h"

#include <algorithm>

#include <fmt/format.h>

#include "forward/base/error.h"
#include "forward/pattern/pattern_parameters.h"
#include "inverse/design/closed_form_start.h"

namespace mezzotint {

namespace {

PatternParameter table_entry(const Pattern& pattern, const FreeParameter& parameter) {
  PatternParameter entry = find_parameter(pattern, parameter.name);
  require(!entry.whole,
          fmt::format("{} is a whole number; a search cannot change it, so give it a value", parameter.name));
  require(parameter.low >= entry.lowest && parameter.high <= entry.highest,
          fmt::format("{}: the bounds must lie in [{}, {}]", parameter.name, entry.lowest, entry.highest));
  return entry;
}

// An axis turned by half a turn is the same axis: bring the start between the bounds if that is possible.
double into_bounds(double value, const Variable& variable) {
  if (is_axis(variable)) {
    while (value > variable.high && value - 180.0 >= variable.low) value -= 180.0;
    while (value < variable.low && value + 180.0 <= variable.high) value += 180.0;
  }
  return std::clamp(value, variable.low, variable.high);
}

}  // namespace

bool is_axis(const Variable& variable) {
  const std::string_view name = last_name(variable.name);
  return name == "direction_deg" || name == "rotation_deg";
}

std::vector<Variable> design_variables(const Pattern& pattern, const std::vector<FreeParameter>& free,
                                       const Target& target, const PrinterProfile& printer, Length wavelength) {
  const Pattern start = closed_form_start(pattern, target, printer, wavelength);
  std::vector<Variable> variables;
  for (const FreeParameter& parameter : free) {
    const PatternParameter entry = table_entry(pattern, parameter);
    Variable variable{parameter.name, parameter.low, parameter.high, 0.0, entry.logarithmic};
    variable.start = parameter.start.value_or(into_bounds(get_parameter(start, parameter.name), variable));
    variables.push_back(std::move(variable));
  }
  return variables;
}

Pattern with_values(Pattern pattern, const std::vector<Variable>& variables, const std::vector<double>& values) {
  for (std::size_t i = 0; i < variables.size(); ++i) set_parameter(pattern, variables[i].name, values[i]);
  return pattern;
}

}  // namespace mezzotint
