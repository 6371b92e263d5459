#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include "measurement/formats/gwy_container.h"

namespace mezzotint {

/// A GwyDataField as it stands in the file: values row by row from the top of the picture.
struct GwyField {
  std::uint64_t columns = 0;
  std::uint64_t rows = 0;
  double width = 1.0;   ///< xreal, in `lateral_unit`; the format's default is 1
  double height = 1.0;  ///< yreal
  std::string lateral_unit;
  std::string value_unit;
  std::span<const std::byte> data;  ///< doubles
  std::size_t offset = 0;           ///< of the object in the file

  [[nodiscard]] double value(std::size_t i) const { return little_endian<double>(data.data() + 8 * i); }
};

/// Reads a data field and checks that it holds as many values as it says.
/// @throws FileError
[[nodiscard]] GwyField read_gwy_field(const GwyComponent& component);

/// The entry of /N/meta that says that a field is periodic, and what it says then. The grid is part of it, so
/// that a crop made with Gwyddion, which keeps the entry, is not taken for periodic.
inline constexpr std::string_view gwy_continuation_key = "Mezzotint continuation";
[[nodiscard]] std::string gwy_periodic_entry(std::uint64_t columns, std::uint64_t rows);

}  // namespace mezzotint
