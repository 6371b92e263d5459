#pragma once

#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "forward/optics/direction_map.h"

namespace mezzotint {

/// Where the light went, as shares of what came in; they sum to 1 to rounding.
struct EnergyAudit {
  Estimate reflected;  ///< albedo
  Estimate transmitted;
  Estimate absorbed;
  Estimate left_sideways;  ///< first met a mirrored copy beyond the measured patch
  Estimate cut_off;        ///< stopped at the bounce cap, or lost by the tracer; never dropped in silence
};

/// How a result came to be: attribute names to values, as they stand in the file.
using Provenance = std::map<std::string, std::string>;

/// The BSDF of a relief for one direction of the light.
///
/// Frame    see DirectionGrid. Reflection: upper hemisphere. Transmission: lower hemisphere, Ω inside the
///          medium, flux weights without n², so ∫ f_t cosθ dω = T.
/// Units    1/sr.
struct Bsdf {
  DirectionAngles incidence;
  DirectionGrid grid;
  MapEstimate reflection;
  MapEstimate transmission;
  EnergyAudit energy;
  Provenance provenance;
  /// The reflection by order of interaction (1, 2, …, the last: that order and above), means and
  /// standard errors alone; empty unless asked for.
  std::vector<MapEstimate> reflection_orders;
};

/// To OpenEXR: float channels "reflection", "reflection.standard_error", "reflection.half_a",
/// "reflection.half_b", the same for "transmission", "….low_95" and "….high_95" where both maps have intervals,
/// "reflection.order_1" … with standard errors where kept; incidence, energy and provenance as attributes "mezzotint:…"
/// (all as text or double). The picture's first line is y = −1, and an attribute says so. Written aside, then renamed;
/// the same result gives the same bytes. Values are rounded to float. A provenance value that is empty is not kept.
/// @throws InvalidInput for a map that has not one value a bin, or a provenance key of more than 200
///         characters; DeviceError where it cannot be written.
void write_exr(const Bsdf& bsdf, const std::filesystem::path& path);

/// Reads what `write_exr` wrote, also after another tool has rewritten it without loss.
/// @throws FileError for a file that is no such EXR, is truncated, or larger than 4096 bins a side; its
///         header is looked at before memory is taken for it.
[[nodiscard]] Bsdf read_exr(const std::filesystem::path& path);

/// Three channels, R, G and B, of one surface under one light, in one file; one channel is written by `write_exr`.
/// Names of channels end in ".R", ".G", ".B", so that a viewer shows the layer "reflection" in colour; attributes read
/// "mezzotint:R.…".
/// @throws InvalidInput as `write_exr`, and where they have not the same grid, incidence and orders, or are not three.
void write_channels_exr(std::span<const Bsdf> channels, const std::filesystem::path& path);

/// The channels of a file: three, or the one of `write_exr`. `read_exr` refuses a file of three.
/// @throws FileError as `read_exr`.
[[nodiscard]] std::vector<Bsdf> read_channels_exr(const std::filesystem::path& path);

/// "R", "G", "B"; of one channel an empty name.
[[nodiscard]] std::string channel_name(std::size_t channel, std::size_t channels);

}  // namespace mezzotint
