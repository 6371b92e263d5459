#include "experiments/run/patch.h"

#include <algorithm>

#include "forward/base/error.h"

namespace mezzotint {

namespace {

HeightField without_border(const HeightField& field, std::size_t border) {
  return crop(field, border, border, field.columns() - 2 * border, field.rows() - 2 * border);
}

double missing_share(const HeightField& field) {
  return static_cast<double>(field.missing_count()) / static_cast<double>(field.grid().size());
}

}  // namespace

HeightField inner_patch_of_picture(const HeightField& picture, const Experiment& experiment) {
  return without_border(picture, (experiment.print.margin_pixels + edge_pixels) * experiment.patch.subsamples);
}

HeightField inner_patch(const HeightField& patch, const Experiment& experiment) {
  return without_border(patch, edge_pixels * experiment.patch.subsamples);
}

CoveredPart covered_part(const HeightField& field) {
  constexpr std::size_t least_side = 16;
  const std::size_t side = std::min(field.columns(), field.rows());
  const double dropouts = missing_share(without_border(field, side / 4));
  if (dropouts > 0.25) throw MethodError("the measurement lacks more than a quarter of the heights of the design");
  for (std::size_t inset = 0; side >= least_side + 2 * inset; ++inset) {
    HeightField part = without_border(field, inset);
    if (missing_share(part) <= dropouts + 0.01) return {std::move(part), inset};
  }
  throw MethodError("the measurement covers too little of the design to compare them");
}

}  // namespace mezzotint
