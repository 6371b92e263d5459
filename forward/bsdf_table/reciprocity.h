#pragma once

#include <cstddef>

#include "forward/bsdf_table/bsdf_table.h"

namespace mezzotint {

/// How far the reflection of a table keeps Helmholtz reciprocity, f(i, o) = f(o, i), over all pairs of its nodes.
///
/// How       Each pair is looked up at node i toward node j, and back: in tables that are isotropic at relative
///           azimuths of 0, 30 … 180 degrees; in others at the nodes' azimuths and half a turn from them, where the
///           specular pairs lie. Pairs whose mean is less than `least_significance` standard errors have nothing to
///           say and are counted apart.
/// Caution   Values are means over bins, of other bins there and back: a lobe of a few bins' width shows a difference
///           that no physics has. It falls with the size of the bins.
/// Units     relative to the mean of the two values.
struct ReciprocityCheck {
  std::size_t pairs = 0;
  std::size_t lost_in_noise = 0;
  double largest_relative = 0.0;
  double rms_relative = 0.0;
  double rms_in_standard_errors = 0.0;  ///< 1 for noise alone; 0 where no value has an error
  std::size_t beyond_three_errors = 0;  ///< 0.3 % of the pairs for noise alone
};
[[nodiscard]] ReciprocityCheck check_reciprocity(const BsdfTable& table, double least_significance = 5.0);

}  // namespace mezzotint
