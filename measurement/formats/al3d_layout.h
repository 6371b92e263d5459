#pragma once

#include <cstddef>
#include <string_view>

/// The header of an .al3d file, shared by its reader and its writer.
/// Source   no public specification; layout as read by Gwyddion 2.62 and checked against a file of MeasureSuite 5.3.

namespace mezzotint::al3d {

inline constexpr std::string_view magic("AliconaImaging\0\r\n", 17);
inline constexpr std::size_t key_bytes = 20, value_bytes = 30, tag_bytes = 52, comment_bytes = 256;
/// What MeasureSuite writes for a sample that it did not see.
inline constexpr std::string_view marker_text = "3.000000028082e+15";
inline constexpr float marker = 3.000000028082e+15F;
/// A record of our own: metres to add to the heights. Other programs skip it and read the relief without its datum.
inline constexpr std::string_view datum_key = "MezzotintDatum";

}  // namespace mezzotint::al3d
