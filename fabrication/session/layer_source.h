#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "fabrication/job/job.h"

namespace mezzotint {

/// A job as a print session reads it: layer by layer, never whole.
struct LayerSource {
  Job frame;             ///< its layers without their pictures
  std::string identity;  ///< changes whenever the job does: a hash of what it is read from
  /// The pixels of a layer, row 0 at y = 0.
  std::function<std::vector<std::uint8_t>(std::size_t index)> read;
};

/// From an archive or a folder; the identity of a folder is that of its manifest, or of its description without one.
/// @throws FileError
[[nodiscard]] LayerSource open_layers(const std::filesystem::path& path);

}  // namespace mezzotint
