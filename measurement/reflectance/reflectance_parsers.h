#pragma once

#include <cstddef>
#include <filesystem>
#include <span>

#include "measurement/reflectance/measured_reflectance.h"

namespace mezzotint {

// One parser a format, on the whole file's bytes; `path` is for complaints only.
// Errors   FileError with line or byte for what cannot be used: counts that do not fit, numbers that are none, NaN or
//          infinite samples, samples below −5 % of the largest (noise is kept, and counted in the provenance).

/// RGL tensor: see AdaptiveTensor. `spectra` with `wavelengths`, or `rgb`. A field `valid` of zeros and ones in the
/// shape of the luminance marks samples that were measured.
[[nodiscard]] MeasuredReflectance parse_rgl(const std::filesystem::path& path, std::span<const std::byte> bytes);

/// MERL .binary: three int32 (90, 90, 180), then doubles: R, G, B, each times its scale 1/1500, 1.15/1500, 1.66/1500. A
/// negative sample was not measured.
[[nodiscard]] MeasuredReflectance parse_merl(const std::filesystem::path& path, std::span<const std::byte> bytes);

/// Zemax (Radiant) BSDF text: angles about the mirrored ray. The format has no mark for what was not measured; a sample
/// of exactly 0 is taken as that. TIS lines are kept in the provenance as they stand.
[[nodiscard]] MeasuredReflectance parse_zemax(const std::filesystem::path& path, std::span<const std::byte> bytes);

/// FRED tabular BSDF text: a line of two angles begins a light, whose mirrored ray they name; lines of three are
/// viewers. Directions that are not listed were not measured.
[[nodiscard]] MeasuredReflectance parse_fred(const std::filesystem::path& path, std::span<const std::byte> bytes);

/// Cornell text: comments, number of wavelengths, wavelengths in nm, rows of θ_i φ_i θ_s φ_s (radians) and samples.
[[nodiscard]] MeasuredReflectance parse_cornell(const std::filesystem::path& path, std::span<const std::byte> bytes);

/// ALTA text of `#DIM 3 n`: isotropic samples in ISOTROPIC_TL_TV_PROJ_DPHI (θ_l, θ_v cosΔφ, θ_v sinΔφ, radians) of
/// BRDF · cosθ_v, which is divided by the cosine; samples within 0.01° of the horizon are left out.
[[nodiscard]] MeasuredReflectance parse_alta(const std::filesystem::path& path, std::span<const std::byte> bytes);

[[nodiscard]] bool looks_like_zemax(std::span<const std::byte> bytes);
[[nodiscard]] bool looks_like_fred(std::span<const std::byte> bytes);
[[nodiscard]] bool looks_like_cornell(std::span<const std::byte> bytes);
[[nodiscard]] bool looks_like_alta(std::span<const std::byte> bytes);
[[nodiscard]] bool looks_like_merl(std::span<const std::byte> bytes);

}  // namespace mezzotint
