#pragma once

#include <filesystem>
#include <functional>
#include <span>
#include <string_view>

namespace mezzotint {

/// Writes a file beside its destination and renames it there when it is whole, so that a crash, a
/// full disk or Ctrl-C never leaves half a file under the final name.
///
/// `write` receives the temporary path (same folder, same ending). It creates the file and closes it.
/// @throws DeviceError where the folder cannot be written or the disk is full; the temporary is removed.
void write_aside(const std::filesystem::path& destination,
                 const std::function<void(const std::filesystem::path&)>& write);

/// A file piece by piece, by `write_aside`: `write` calls what it is given with the next bytes.
using PutBytes = std::function<void(std::string_view)>;
void write_pieces(const std::filesystem::path& destination, const std::function<void(const PutBytes&)>& write);

/// Bytes (or text) to a file, by `write_aside`.
void write_file(const std::filesystem::path& destination, std::string_view bytes);

}  // namespace mezzotint
