#pragma once

#include <nlohmann/json.hpp>

#include "experiments/texture/texture_findings.h"
#include "measurement/texture/power_spectrum.h"

namespace mezzotint {

/// Charts of a surface's texture, thinned so that none has more than some hundred points whatever the field's size.

/// Shares of the heights, with the normal distribution of the same Sq.
[[nodiscard]] nlohmann::json height_histogram(const TextureFindings& findings);

/// The material ratio curve with the equivalent line, and Spk, Sk and Svk beside it.
[[nodiscard]] nlohmann::json bearing_chart(const TextureFindings& findings);

/// Mean density over rings, with its standard error.
[[nodiscard]] nlohmann::json radial_chart(const PowerSpectrum& spectrum, const std::string& remark);

/// Shares of the power by the direction of the wave vector.
[[nodiscard]] nlohmann::json angular_chart(const PowerSpectrum& spectrum, const std::string& remark);

/// The areal density on a logarithmic scale, around frequency 0.
[[nodiscard]] nlohmann::json spectrum_map(const PowerSpectrum& spectrum);

/// The autocorrelation around its middle, with the line where it first falls to 0.2.
[[nodiscard]] nlohmann::json autocorrelation_map(const Autocorrelation& autocorrelation);

/// Slopes along the axes of the steepest and of the gentlest, with normal distributions of the same RMS.
[[nodiscard]] std::vector<nlohmann::json> slope_charts(const TextureFindings& findings);

/// The profile with its mean line.
[[nodiscard]] nlohmann::json profile_chart(const ProfileFindings& profile);

}  // namespace mezzotint
