#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "forward/surface/height_field.h"

namespace mezzotint {

/// A surface as it stood in a file.
struct SurfaceFile {
  HeightField field;
  std::string format;  ///< "al3d", "x3p", "gwy"
  std::string title;
  /// What the file says of itself (instrument, date, creator), for `info` and for reports.
  std::map<std::string, std::string> provenance;
  /// What was assumed where the file is silent, in words ("no lateral unit: metres assumed"); empty if nothing.
  std::string assumption;
};

/// Reads a surface; the format is found by the file's first bytes, not by its name.
///
/// Heights become micrometres with their mean offset taken out in double first (HeightField::datum);
/// missing samples become NaN; formats whose row 0 is on top are flipped, so that a ridge at +30° stays
/// at +30°. Continuation is Mirrored, unless our own .gwy says that the field is periodic.
/// @throws FileError for an unknown format, and whenever a file contradicts itself, ends early or asks for
///         more samples than it has bytes for; sizes are checked before memory is taken.
[[nodiscard]] SurfaceFile read_surface(const std::filesystem::path& path);

[[nodiscard]] SurfaceFile read_al3d(const std::filesystem::path& path);
[[nodiscard]] SurfaceFile read_x3p(const std::filesystem::path& path);
[[nodiscard]] SurfaceFile read_gwy(const std::filesystem::path& path);

/// Gwyddion's native format: /0/data in metres (datum added in double), /0/mask where samples are missing,
/// /0/data/title, and /0/meta with the provenance. Written aside, then renamed.
/// @throws DeviceError where it cannot be written.
void write_gwy(const HeightField& field, const std::string& title, const std::map<std::string, std::string>& provenance,
               const std::filesystem::path& path);

}  // namespace mezzotint
