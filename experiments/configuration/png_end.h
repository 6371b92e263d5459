#pragma once

#include <filesystem>

/// Inside of experiments/configuration.

namespace mezzotint {

/// Whether a file does not end as a PNG picture does. OpenImageIO 2.4 leaks when libpng runs into the end of a picture,
/// so that is asked before: a PNG ends with an empty chunk IEND and its checksum.
/// @throws FileError as read_file.
[[nodiscard]] bool is_cut_off_png(const std::filesystem::path& path);

}  // namespace mezzotint
