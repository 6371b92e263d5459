#include "measurement/formats/surface_file.h"

#include "forward/base/error.h"
#include "forward/base/file_input.h"
#include "measurement/formats/parsers.h"

namespace mezzotint {

void add_assumption(std::string& assumptions, std::string_view sentence) {
  if (!assumptions.empty()) assumptions += "; ";
  assumptions += sentence;
}

SurfaceFile read_surface(const std::filesystem::path& path) {
  const auto bytes = read_file(path);
  if (looks_like_al3d(bytes)) return parse_al3d(path, bytes);
  if (looks_like_gwy(bytes)) return parse_gwy(path, bytes);
  if (looks_like_x3p(bytes)) return parse_x3p(path, bytes);
  throw FileError(path, "byte 0",
                  "the first bytes are those of no surface format that is read here; .al3d (Alicona), .x3p "
                  "(ISO 25178-72) and .gwy (Gwyddion) are");
}

SurfaceFile read_al3d(const std::filesystem::path& path) { return parse_al3d(path, read_file(path)); }
SurfaceFile read_x3p(const std::filesystem::path& path) { return parse_x3p(path, read_file(path)); }
SurfaceFile read_gwy(const std::filesystem::path& path) { return parse_gwy(path, read_file(path)); }

}  // namespace mezzotint
