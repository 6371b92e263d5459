#include "experiments/run/target_relief.h"

#include <fmt/format.h>

#include "forward/base/error.h"
#include "measurement/correction/fill.h"
#include "measurement/correction/outliers.h"
#include "measurement/correction/plane.h"
#include "measurement/formats/surface_file.h"

namespace mezzotint {

TargetRelief read_target_relief(const std::filesystem::path& scan, double outliers) {
  const SurfaceFile file = read_surface(scan);
  auto provenance = file.provenance;
  provenance["source"] = scan.filename().string();
  const std::size_t missing = file.field.missing_count();
  if (missing == file.field.grid().size()) throw FileError(scan, "", "holds no measured sample; it cannot be a target");
  HeightField field = level(file.field);
  std::size_t removed = 0;
  if (outliers > 0.0) {
    OutlierResult cleaned = mask_outliers(field, outliers);
    field = std::move(cleaned.field);
    removed = cleaned.removed;
  }
  provenance["correction"] = fmt::format(
      "levelled by the least-squares plane; {} outliers beyond {:g} standard deviations taken out; {} missing "
      "samples of {} filled by Laplace's equation",
      removed, outliers, missing + removed, field.grid().size());
  if (!file.assumption.empty()) provenance["assumption"] = file.assumption;
  return {level(fill_missing(field)), provenance};
}

}  // namespace mezzotint
