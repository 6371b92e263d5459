#pragma once

#include <filesystem>

#include <nlohmann/json.hpp>

#include "forward/base/progress.h"

namespace mezzotint {

/// What a job on disk holds, every layer read and checked.
/// @throws FileError naming the member and what is wrong with it
[[nodiscard]] nlohmann::ordered_json describe_job(const std::filesystem::path& path, const Progress& progress);

}  // namespace mezzotint
