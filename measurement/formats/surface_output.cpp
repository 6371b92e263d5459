#include "measurement/formats/surface_output.h"

#include <algorithm>
#include <cmath>

#include "forward/base/error.h"
#include "forward/surface/mesh.h"

namespace mezzotint {

namespace {

std::string ending_of(const std::filesystem::path& path) {
  std::string ending = path.extension().string();
  std::ranges::transform(ending, ending.begin(),
                         [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  return ending;
}

}  // namespace

void write_surface(const SurfaceFile& surface, const std::filesystem::path& path) {
  const HeightField& field = surface.field;
  const std::string ending = ending_of(path);
  Provenance provenance = surface.provenance;
  if (!surface.assumption.empty()) provenance["assumption"] = surface.assumption;
  if (ending == ".gwy") return write_gwy(field, surface.title, provenance, path);
  if (ending == ".x3p") return write_x3p(field, surface.title, provenance, path);
  if (ending == ".sur") return write_sur(field, surface.title, provenance, path);
  if (ending == ".al3d") return write_al3d(field, path);
  if (ending == ".png") return write_png(field, surface.title, provenance, path);
  if (ending == ".exr") return write_relief_exr(field, surface.title, provenance, path);
  if (ending == ".obj") return write_obj(to_mesh(field), {}, path);
  throw InvalidInput(path.string() + ": surfaces are written as " + std::string(written_surface_formats));
}

std::optional<Length> rounding_of(const HeightField& field, const std::filesystem::path& path) {
  const std::string ending = ending_of(path);
  if (ending == ".gwy" || ending == ".x3p" || ending == ".exr") return Length{};
  const bool is_known = ending == ".al3d" || ending == ".sur" || ending == ".png";
  if (!is_known || field.missing_count() == field.grid().size()) return {};
  const HeightRange range = height_range(field);
  const double largest_um = std::max(range.highest.um(), -range.lowest.um());
  if (ending == ".al3d") return Length::from_um(std::ldexp(largest_um, -24));
  if (ending == ".sur") return Length::from_um(std::ldexp(largest_um, -31));
  const double levels = field.missing_count() > 0 ? 65534.0 : 65535.0;
  return Length::from_um(0.5 * (range.highest - range.lowest).um() / levels);
}

bool keeps_period(const std::filesystem::path& path) {
  const std::string ending = ending_of(path);
  return ending == ".gwy" || ending == ".png" || ending == ".exr";
}

}  // namespace mezzotint
