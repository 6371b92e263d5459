#pragma once

#include <filesystem>

#include "forward/bsdf_table/bsdf_table.h"

namespace mezzotint {

/// To one OpenEXR picture of all maps side by side, `columns` in a line, in the order of rings and azimuths; of each
/// map the first line is y = −1. Float channels "reflection", "reflection.standard_error", "reflection.level" (log₂ of
/// the side of the square that a bin belongs to), and the same for "transmission" where any node has it. All else
/// stands as JSON in the attribute "mezzotint:bsdf_table". Bins of a square hold the same numbers, which zip makes
/// small. Written aside, then renamed; the same table gives the same bytes, and is read back the same to the last bit.
/// @throws InvalidInput for a table that is not valid or has more than 4096 × 4096 bins in all; DeviceError where it
///         cannot be written.
void write_bsdf_table(const BsdfTable& table, const std::filesystem::path& path);

/// Whether an EXR says that it is a table; whether it is a whole one shows when it is read.
/// @throws FileError for a file that is no EXR, or whose header is damaged.
[[nodiscard]] bool is_bsdf_table(const std::filesystem::path& path);

/// Reads what `write_bsdf_table` wrote, also after another tool has rewritten it without loss.
/// @throws FileError for a file that is no such picture, is truncated, larger than 4096 × 4096, or contradicts itself;
///         header and sizes are looked at before memory is taken for pixels.
[[nodiscard]] BsdfTable read_bsdf_table(const std::filesystem::path& path);

}  // namespace mezzotint
