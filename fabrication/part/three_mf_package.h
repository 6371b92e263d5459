#pragma once

#include <cstddef>
#include <filesystem>
#include <span>

/// Inside of fabrication/part.

namespace mezzotint {

/// How many objects a build may make of components that hold components.
inline constexpr std::size_t most_instances = std::size_t{1} << 20U;

/// Checks a 3MF before its library unpacks it: that it is an archive, that what it claims to hold is of a size that
/// memory has, and that its components do not multiply without bounds (the library walks through all of them).
/// @throws FileError
void check_three_mf_package(const std::filesystem::path& path, std::span<const std::byte> bytes);

}  // namespace mezzotint
