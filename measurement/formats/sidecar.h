#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <string>

namespace mezzotint {

/// What a picture or a plain text of heights cannot say of itself; stands beside it as TOML, in a file of the same
/// name with .toml behind it (relief.png.toml).
///
///   width_um = 640.0     physical width of the picture: columns times pitch
///   depth_um = 18.0      physical depth of its gray range, from black to white
///
/// Units    A height in micrometres is datum_um + gray / white · depth_um for gray levels of 8 or 16 bits, and
///          datum_um + number · value_um for floating-point pictures and text.
/// Missing  `missing_gray`; in floating-point pictures and text, what is no finite number.
/// Errors   FileError with the line and column of the TOML.
struct Sidecar {
  std::optional<double> width_um;
  std::optional<double> length_um;  ///< along y, rows times pitch; square samples where it is not given
  std::optional<double> depth_um;
  std::optional<double> value_um;  ///< micrometres per unit of the numbers
  std::optional<double> xy_um;     ///< of an .xyz: micrometres per unit of x and y
  double datum_um = 0.0;
  std::optional<unsigned> missing_gray;
  bool periodic = false;
  bool first_row_on_top = true;
  std::string title;
  std::map<std::string, std::string> provenance;
};

[[nodiscard]] std::filesystem::path sidecar_path(const std::filesystem::path& picture);

/// @throws FileError where it is missing, and then says what to write
[[nodiscard]] Sidecar read_sidecar(const std::filesystem::path& picture);
[[nodiscard]] Sidecar parse_sidecar(const std::filesystem::path& path, std::span<const std::byte> bytes);

[[nodiscard]] std::string sidecar_text(const Sidecar& sidecar);

}  // namespace mezzotint
