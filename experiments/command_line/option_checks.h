#pragma once

#include <functional>
#include <string>

namespace mezzotint {

/// Checks a number's range for CLI11's `check`; unlike CLI::Range it refuses "nan".
[[nodiscard]] std::function<std::string(const std::string&)> in_range(double low, double high);

/// Refuses a file that cannot be written for want of its folder: before long work, not after it.
/// @throws DeviceError
void require_folder_of(const std::string& file);

}  // namespace mezzotint
