#pragma once

#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "forward/base/error.h"
#include "forward/optics/bsdf_warnings.h"
#include "forward/scattering/path_tracing.h"
#include "tests/forward/scattering/reliefs.h"
#include "tests/stability/failure_row.h"

namespace mezzotint::test {

inline PathTracingOptions light_at(double theta_deg, const Material& material = Mirror{}, int log2_samples = 15) {
  PathTracingOptions options;
  options.incidence = {Angle::from_degrees(theta_deg), Angle::from_degrees(20.0)};
  options.material = material;
  options.samples = std::uint64_t{1} << log2_samples;
  return options;
}

/// Of what comes in, what the audit accounts for.
inline double accounted_for(const Bsdf& bsdf) {
  const EnergyAudit& energy = bsdf.energy;
  return energy.reflected.value + energy.transmitted.value + energy.absorbed.value + energy.left_sideways.value +
         energy.cut_off.value;
}

inline double share(const Bsdf& bsdf, const char* key) { return std::stod(bsdf.provenance.at(key)); }

/// The warning with these words in it; empty where there is none.
inline std::string warning(const Bsdf& bsdf, const std::string& words) {
  for (const std::string& sentence : warnings_of(bsdf.provenance)) {
    if (sentence.find(words) != std::string::npos) return sentence;
  }
  return "";
}

/// What the library says when it refuses; empty where it does not.
template <class Call>
std::string refusal(const Call& call) {
  try {
    call();
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

inline std::string percent(double share) {
  return share < 0.995 ? fmt::format("{:.2g} %", 100.0 * share) : fmt::format("{:.0f} %", 100.0 * share);
}

/// A figure that is rounding, or luck, by a bound alone: the next power of ten, so that another vector unit gives the
/// same words.
inline std::string below(double figure) {
  if (figure == 0.0) return "nothing";
  return fmt::format("less than 1e{:.0f}", std::ceil(std::log10(figure)));
}

/// relative_l2 without noise.
inline double difference(const Bsdf& a, const Bsdf& b) {
  return relative_l2(a.grid, a.reflection, b.reflection).corrected.value;
}

}  // namespace mezzotint::test
