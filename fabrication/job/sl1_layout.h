#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "fabrication/job/job.h"
#include "fabrication/job/member_place.h"

namespace mezzotint {

// The layout of a .sl1 archive.
//
// Standard config.ini (what the printer wants to know), prusaslicer.ini (what the slicer was set to; PrusaSlicer asks
//          for it when it imports an archive), NAME%05d.png at the root, NAME the job's; thumbnail/.
// Missing  exposures layer by layer: the first layer has its own, the next `numFade` go over to the common one evenly.
//          The LED's amplitude: our manifest.json has it.
// Turned   where display_orientation is portrait the picture's rows run along the display's longer side. The job is the
//          picture as it is.
// Source   archives of PrusaSlicer 2.5.0; its SL1.cpp for which keys it asks for.

inline const std::string sl1_config_member = "config.ini";
inline const std::string sl1_slicer_member = "prusaslicer.ini";
inline const std::string sl1_tiny_preview = "thumbnail/thumbnail400x400.png";
inline const std::string sl1_huge_preview = "thumbnail/thumbnail800x480.png";

/// "NAME00042.png"
[[nodiscard]] std::string sl1_slice_member(const std::string& name, std::size_t index);

/// @param used_ml  cured volume
/// @throws InvalidInput where the layers after the first differ in exposure or thickness: the format has no place for
/// it.
[[nodiscard]] std::string write_sl1_config(const Job& job, double used_ml);
[[nodiscard]] std::string write_sl1_slicer(const Job& job);

/// The job that both files describe, its layers without pictures; columns and rows are those of the picture.
/// @throws FileError saying which value is missing or wrong.
[[nodiscard]] Job read_sl1_config(std::span<const std::byte> config, const MemberPlace& config_place,
                                  std::span<const std::byte> slicer, const MemberPlace& slicer_place);

}  // namespace mezzotint
