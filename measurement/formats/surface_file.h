#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "forward/surface/height_field.h"

namespace mezzotint {

/// A surface as it stood in a file.
struct SurfaceFile {
  HeightField field;
  std::string format;  ///< "al3d", "x3p", "gwy", "sur", "sdf", "opd", "png", "tiff", "exr", "csv", "xyz"
  std::string title;
  /// What the file says of itself (instrument, date, creator), for `info` and for reports.
  std::map<std::string, std::string> provenance;
  /// What was assumed where the file is silent, in words ("no lateral unit: metres assumed"); empty if nothing.
  std::string assumption;
};

struct ReadOptions {
  /// Gray level of the quality map, 1 … 255, below which a sample is missing. For Alicona's folders alone.
  std::optional<int> min_quality;
};

/// Reads a surface; the format is found by the file's first bytes, not by its name.
///
/// Heights become micrometres with their mean offset taken out in double first (HeightField::datum);
/// missing samples become NaN; formats whose row 0 is on top are flipped, so that a ridge at +30° stays
/// at +30°. Continuation is Mirrored, unless our own .gwy or a sidecar says that the field is periodic.
///
/// @param path  a file; a folder of Alicona's (dem.al3d, qualitymap.bmp, info.xml); or FILE#/N/data for one of
///              several channels of a .gwy. Pictures (PNG, TIFF, OpenEXR) and plain text (names that end in .csv
///              or .xyz, since text has no first bytes) have their sizes in a sidecar (sidecar.h).
/// @throws FileError for an unknown format, and whenever a file contradicts itself, ends early or asks for
///         more samples than it has bytes for; sizes are checked before memory is taken.
[[nodiscard]] SurfaceFile read_surface(const std::filesystem::path& path, const ReadOptions& options = {});

/// What a quality map says of a surface's samples: gray levels, 0 … 255.
struct SampleQuality {
  int lowest = 0, median = 0, highest = 0;
};
/// Of Alicona's folders (or their dem.al3d), where they have a map; else nothing.
/// @throws FileError for a map that cannot be read, or is of another size than the surface.
[[nodiscard]] std::optional<SampleQuality> sample_quality(const std::filesystem::path& path,
                                                          const SurfaceFile& surface);

/// The endings of what read_surface reads, for help texts.
inline constexpr std::string_view read_surface_formats =
    ".al3d (or its folder), .x3p, .gwy, .sur, .sdf, .opd, and with a sidecar .png, .tif, .exr, .csv, .xyz";

/// The files that read_surface takes heights and sizes from: the file itself, and its sidecar where it has one.
[[nodiscard]] std::vector<std::filesystem::path> files_of_surface(const std::filesystem::path& path);

/// Whether a picture is a relief: it has a sidecar.
[[nodiscard]] bool has_sidecar(const std::filesystem::path& picture);

/// As read_surface, for a file that can be nothing else.
[[nodiscard]] SurfaceFile read_gwy(const std::filesystem::path& path);

/// Gwyddion's native format: /0/data in metres (datum added in double), /0/mask where samples are missing,
/// /0/data/title, and /0/meta with the provenance. Written aside, then renamed.
/// @throws DeviceError where it cannot be written.
void write_gwy(const HeightField& field, const std::string& title, const std::map<std::string, std::string>& provenance,
               const std::filesystem::path& path);

}  // namespace mezzotint
