#pragma once

#include <cstddef>
#include <string_view>

/// Where things stand in the header of a .sur file, shared by its reader and its writer.
/// Source   "Surface file format" of Digital Surf, as read by Gwyddion, SurfaceTopography and surfalize, and checked
///          against files of several instruments.

namespace mezzotint::sur {

inline constexpr std::string_view magic_plain = "DIGITAL SURF";
inline constexpr std::string_view magic_compressed = "DSCOMPRESSED";
inline constexpr std::size_t header_bytes = 512;

inline constexpr std::size_t at_format = 12;   // int16: 0 where the bytes are little-endian
inline constexpr std::size_t at_objects = 14;  // int16
inline constexpr std::size_t at_version = 16;  // int16
inline constexpr std::size_t at_type = 18;     // int16
inline constexpr std::size_t at_name = 20, at_operator = 50, name_bytes = 30;
inline constexpr std::size_t at_non_measured = 86;  // int16: 1 where such points are marked
inline constexpr std::size_t at_absolute_z = 88;    // int16
inline constexpr std::size_t at_bits = 98;          // int16: 16 or 32
inline constexpr std::size_t at_lowest = 100, at_highest = 104;
inline constexpr std::size_t at_columns = 108, at_rows = 112, at_points = 116;   // int32
inline constexpr std::size_t at_step_x = 120, at_step_y = 124, at_step_z = 128;  // float
inline constexpr std::size_t at_names = 132, at_step_units = 180, at_units = 228, text_bytes = 16;
inline constexpr std::size_t at_ratios = 276;           // three floats, for display
inline constexpr std::size_t at_replica = 288;          // int16
inline constexpr std::size_t at_date = 306;             // int16: second, minute, hour, day, month, year
inline constexpr std::size_t at_compressed_size = 324;  // uint32
inline constexpr std::size_t at_comment_bytes = 334, at_private_bytes = 336;  // int16
inline constexpr std::size_t at_client_zone = 338;
inline constexpr std::size_t at_offset_x = 466, at_offset_y = 470, at_offset_z = 474;  // float, in the unit of the step

inline constexpr int type_profile = 1, type_surface = 2;
inline constexpr int type_surface_and_intensity = 11, type_surface_and_colour = 13, type_surface_and_both = 16;
/// The value of a point that was not measured lies this far below the lowest.
inline constexpr int non_measured_below_lowest = 2;

}  // namespace mezzotint::sur
