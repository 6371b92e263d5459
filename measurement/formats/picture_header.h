#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <vector>

/// Inside of measurement/formats: what is asked of a picture before a library sees it. Libraries take memory for
/// whatever a header promises, and some leak when a picture ends early.

namespace mezzotint {

[[nodiscard]] bool looks_like_png(std::span<const std::byte> bytes);
[[nodiscard]] bool looks_like_tiff(std::span<const std::byte> bytes);
[[nodiscard]] bool looks_like_exr(std::span<const std::byte> bytes);

/// The PNG with nothing but its header, its data and its end: chunks of text, colour profiles and the like say
/// nothing about heights. The checksums are verified.
/// @throws FileError for a picture that is cut short or damaged, in colour, or has neither 8 nor 16 bits
[[nodiscard]] std::vector<std::byte> plain_png(const std::filesystem::path& path, std::span<const std::byte> bytes);

/// @throws FileError for anything but one flat picture in lines of one channel of 32-bit floats, without loss, with
///         every attribute inside of the file
void require_relief_exr(const std::filesystem::path& path, std::span<const std::byte> bytes);

/// @throws FileError where `bytes_needed` cannot come out of so small a file, however well it is packed
void require_plausible_size(const std::filesystem::path& path, std::uint64_t bytes_needed, std::uint64_t file_bytes);

}  // namespace mezzotint
