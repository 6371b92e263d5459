#include "measurement/pattern_fit/noise_report.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "forward/pattern/pattern_parameters.h"

namespace mezzotint {

namespace {

std::string unit_of(std::string_view name) {
  if (name.ends_with("_um")) return "µm";
  return name.ends_with("_deg") ? "deg" : "1";
}

bool is_fitted(const NoiseModel& model, std::string_view name) {
  if (name == "stretch" || name == "direction_deg") return model.stretched;
  if (name == "lacunarity") return model.free_lacunarity;
  return name != "octaves";
}

double inward(const PatternParameter& parameter, double value) {
  return parameter.logarithmic ? std::log(value) : value;
}
double outward(const PatternParameter& parameter, double value) {
  return parameter.logarithmic ? std::exp(value) : value;
}

// Mean and deviation of what the draws give, about the fit's own value.
struct Scatter {
  double mean = 0.0, deviation = 0.0;
};

Scatter scatter_of(const NoiseFit& fit, const NoiseDraws& draws, const PatternParameter& parameter) {
  const double own = inward(parameter, get_parameter(pattern_of(fit.model, fit.numbers), parameter.name));
  const auto count = static_cast<double>(draws.numbers.size());
  double sum = 0.0, square = 0.0;
  for (const NoiseNumbers& numbers : draws.numbers) {
    double off = inward(parameter, get_parameter(pattern_of(fit.model, numbers), parameter.name)) - own;
    if (parameter.name == "direction_deg") off = std::remainder(off, 180.0);
    sum += off;
    square += off * off;
  }
  return {sum / count, std::sqrt(std::max(0.0, square - sum * sum / count) / (count - 1.0))};
}

// Student's t for 95 %, within 0.5 % from ten degrees of freedom on.
double student(double freedom) { return 1.960 + 2.45 / freedom + 1.7 / (freedom * freedom); }

}  // namespace

void report_parameters(const NoiseFit& fit, const NoiseDraws& draws, PatternFit& result) {
  result.pattern = pattern_of(fit.model, fit.numbers);
  const auto count = static_cast<double>(draws.numbers.size());
  for (const PatternParameter& parameter : pattern_parameters(result.pattern)) {
    const double raw = get_parameter(result.pattern, parameter.name);
    FittedParameter found{std::string(parameter.name), {raw, unit_of(parameter.name), {}}, {}, {}};
    if (is_fitted(fit.model, parameter.name)) {
      const Scatter scatter = scatter_of(fit, draws, parameter);
      const double error = scatter.deviation * std::sqrt(1.0 + 1.0 / count), half = student(count - 1.0) * error;
      const double middle = inward(parameter, raw) - scatter.mean;
      const auto value_at = [&parameter](double at) {
        return std::clamp(outward(parameter, at), parameter.lowest, parameter.highest);
      };
      found.quantity.value = value_at(middle);
      found.quantity.standard_error = parameter.logarithmic ? found.quantity.value * error : error;
      found.low_95 = value_at(middle - half);
      found.high_95 = value_at(middle + half);
      set_parameter(result.pattern, parameter.name, found.quantity.value);
    }
    result.parameters.push_back(found);
  }
}

}  // namespace mezzotint
