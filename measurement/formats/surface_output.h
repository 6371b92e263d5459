#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "measurement/formats/surface_file.h"

namespace mezzotint {

using Provenance = std::map<std::string, std::string>;

/// Writes a surface; the ending of the name says as what: .gwy, .x3p, .sur, .al3d, .png, .exr, or .obj for a mesh.
///
/// Every file is written aside, then renamed; .png and .exr get a sidecar FILE.toml (sidecar.h), .obj its .mtl.
/// What the surface assumed goes into the provenance.
/// @throws InvalidInput for another ending; DeviceError where it cannot be written.
void write_surface(const SurfaceFile& surface, const std::filesystem::path& path);

/// The endings that write_surface knows, for help texts.
inline constexpr std::string_view written_surface_formats = ".gwy, .x3p, .sur, .al3d, .png, .exr or .obj";

// What a field comes back as when it is read again. Reading takes the mean out anew, which moves a float by its last
// bit; on top of that:
//   .gwy, .x3p, .exr  nothing
//   .al3d             another last bit: floats of metres about the datum, which has a record of its own
//   .sur              half of 2^-30 of the largest height about the datum; pitches are floats (6e-8)
//   .png              half of 1/65535 of the height range (of 1/65534 where samples are missing)
// A period is kept by .gwy, .png and .exr alone; title and provenance as far as a format has room for them.

/// How far a height may be off when the file is read again, beside the last bit of a float. None where the ending is
/// that of a mesh, or of nothing that is written.
[[nodiscard]] std::optional<Length> rounding_of(const HeightField& field, const std::filesystem::path& path);
/// Whether a file of this ending says that the field is periodic.
[[nodiscard]] bool keeps_period(const std::filesystem::path& path);

/// ISO 25178-72: absolute doubles, deflated; missing points are NaN; MD5 of points and document.
void write_x3p(const HeightField& field, const std::string& title, const Provenance& provenance,
               const std::filesystem::path& path);
/// Digital Surf, uncompressed, in mm; missing points by the non-measured value.
void write_sur(const HeightField& field, const std::string& title, const Provenance& provenance,
               const std::filesystem::path& path);
/// Alicona's format, without texture and icon; rows padded to 8 bytes as Gwyddion reads them.
void write_al3d(const HeightField& field, const std::filesystem::path& path);
/// 16-bit gray from the lowest to the highest sample; missing ones are black where there are any.
void write_png(const HeightField& field, const std::string& title, const Provenance& provenance,
               const std::filesystem::path& path);
/// One channel of floats, "Y", in micrometres about the datum; missing samples are NaN.
void write_relief_exr(const HeightField& field, const std::string& title, const Provenance& provenance,
                      const std::filesystem::path& path);

}  // namespace mezzotint
