#include "measurement/formats/plain_parsers.h"

#include <fmt/format.h>

#include "forward/base/error.h"

namespace mezzotint {

double required_scale_um(const std::filesystem::path& path, const std::optional<double>& value, std::string_view key) {
  if (!value) throw FileError(sidecar_path(path), key, "is missing; this format needs it");
  return *value;
}

Grid sidecar_grid(const std::filesystem::path& path, const Sidecar& sidecar, std::uint64_t columns,
                  std::uint64_t rows) {
  const double pitch_x_m = required_scale_um(path, sidecar.width_um, "width_um") / static_cast<double>(columns) * 1e-6;
  const double pitch_y_m = sidecar.length_um ? *sidecar.length_um / static_cast<double>(rows) * 1e-6 : pitch_x_m;
  return checked_grid(path, "size", {columns, rows, pitch_x_m, pitch_y_m});
}

Continuation sidecar_continuation(const Sidecar& sidecar) {
  return sidecar.periodic ? Continuation::Periodic : Continuation::Mirrored;
}

}  // namespace mezzotint
