#pragma once

#include <cstddef>
#include <span>
#include <string_view>
#include <utility>

#include "measurement/formats/parsers.h"
#include "measurement/formats/plain_parsers.h"
#include "measurement/formats/quality_map.h"
#include "measurement/formats/x3p_document.h"

// Every reader as a function of bytes alone: what is fuzzed, and what the corpus is replayed through.
namespace mezzotint::fuzzed {

using Bytes = std::span<const std::byte>;

/// A sidecar with all that any format asks for.
inline Sidecar full_sidecar() {
  Sidecar sidecar;
  sidecar.width_um = 30.0;
  sidecar.depth_um = 18.0;
  sidecar.value_um = 1.0;
  sidecar.xy_um = 1.0;
  sidecar.missing_gray = 0;
  return sidecar;
}

inline void al3d(Bytes bytes) { static_cast<void>(parse_al3d("f", bytes)); }
inline void gwy(Bytes bytes) { static_cast<void>(parse_gwy("f", bytes)); }
inline void x3p(Bytes bytes) { static_cast<void>(parse_x3p("f", bytes)); }
/// main.xml alone, which the checksum of the archive would shield.
inline void x3p_document(Bytes bytes) { static_cast<void>(parse_x3p_document("f", bytes)); }
inline void sur(Bytes bytes) { static_cast<void>(parse_sur("f", bytes)); }
inline void sdf(Bytes bytes) { static_cast<void>(parse_sdf("f", bytes)); }
inline void opd(Bytes bytes) { static_cast<void>(parse_opd("f", bytes)); }
inline void png(Bytes bytes) { static_cast<void>(parse_picture("f", bytes, full_sidecar())); }
inline void tiff(Bytes bytes) { static_cast<void>(parse_picture("f", bytes, full_sidecar())); }
inline void exr(Bytes bytes) { static_cast<void>(parse_picture("f", bytes, full_sidecar())); }
inline void csv(Bytes bytes) { static_cast<void>(parse_csv("f", bytes, full_sidecar())); }
inline void xyz(Bytes bytes) { static_cast<void>(parse_xyz("f", bytes, full_sidecar())); }
inline void sidecar(Bytes bytes) { static_cast<void>(parse_sidecar("f", bytes)); }
inline void quality_map(Bytes bytes) { static_cast<void>(parse_quality_map("f", bytes)); }

inline constexpr std::pair<std::string_view, void (*)(Bytes)> readers[] = {
    {"al3d", al3d},       {"gwy", gwy},
    {"x3p", x3p},         {"x3p_document", x3p_document},
    {"sur", sur},         {"sdf", sdf},
    {"opd", opd},         {"png", png},
    {"tiff", tiff},       {"exr", exr},
    {"csv", csv},         {"xyz", xyz},
    {"sidecar", sidecar}, {"quality_map", quality_map}};

}  // namespace mezzotint::fuzzed
