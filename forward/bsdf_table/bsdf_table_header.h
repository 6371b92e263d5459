#pragma once

#include <filesystem>
#include <string>

#include "forward/bsdf_table/bsdf_table.h"

/// Inside of forward/bsdf_table: what the file of a table holds beside its maps, and where the maps stand.

namespace mezzotint {

/// Maps side by side, as many in a line as fit.
struct TableMosaic {
  static constexpr std::size_t most_bins_a_side = 4096;

  DirectionGrid map;
  std::size_t maps = 0;

  [[nodiscard]] std::size_t columns() const;
  [[nodiscard]] std::size_t width() const { return columns() * map.width; }
  [[nodiscard]] std::size_t height() const { return (maps + columns() - 1) / columns() * map.height; }
  /// The place of a bin in the picture.
  [[nodiscard]] std::size_t pixel(std::size_t node, std::size_t column, std::size_t row) const {
    return (node / columns() * map.height + row) * width() + node % columns() * map.width + column;
  }
};

/// Numbers to the last bit. Nodes in the order of rings and azimuths.
[[nodiscard]] std::string to_header(const BsdfTable& table);

/// A table without its maps.
/// @throws FileError for text that is no header, or a header of a table that makes no sense.
[[nodiscard]] BsdfTable from_header(const std::string& text, const std::filesystem::path& path);

}  // namespace mezzotint
