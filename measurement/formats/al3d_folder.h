#pragma once

#include "measurement/formats/quality_map.h"
#include "measurement/formats/surface_file.h"

namespace mezzotint {

/// What stands beside a dem.al3d in Alicona's folders.
[[nodiscard]] bool is_al3d_folder(const std::filesystem::path& path);
[[nodiscard]] std::filesystem::path al3d_of_folder(const std::filesystem::path& folder);

/// The entries of info.xml, where there is one, as provenance. A damaged one is noted, not refused: the heights do
/// not depend on it.
void add_al3d_information(const std::filesystem::path& folder, SurfaceFile& surface);

/// Whether the folder has a qualitymap.bmp; and that map.
/// @throws FileError where it is missing, damaged or of another size than the field.
[[nodiscard]] bool has_quality_map(const std::filesystem::path& folder);
[[nodiscard]] QualityMap read_quality_map(const std::filesystem::path& folder, const HeightField& field);

/// Samples whose gray in qualitymap.bmp is below the threshold become missing; the datum stays.
/// @throws FileError where there is no map, or one of another size
void mask_low_quality(const std::filesystem::path& folder, int min_quality, SurfaceFile& surface);

}  // namespace mezzotint
