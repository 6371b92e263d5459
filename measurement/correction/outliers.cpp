#include <cmath>
#include <limits>

#include "forward/base/error.h"
#include "measurement/correction/correction.h"

namespace mezzotint {

OutlierResult mask_outliers(const HeightField& field, double k) {
  require(k >= 1.0 && k <= 100.0,
          "outliers lie between 1 and 100 standard deviations off; " + std::to_string(k) + " is outside");
  const HeightField levelled = level(field);  // its mean is zero
  double squares = 0.0, count = 0.0;
  for (const float z : levelled.heights_um()) {
    if (std::isnan(z)) continue;
    squares += static_cast<double>(z) * z;
    count += 1.0;
  }
  const double limit_um = k * std::sqrt(squares / count);
  OutlierResult result{field, 0};
  for (std::size_t i = 0; i < field.grid().size(); ++i) {
    if (!(std::abs(static_cast<double>(levelled.heights_um()[i])) > limit_um)) continue;
    result.field.heights_um()[i] = std::numeric_limits<float>::quiet_NaN();
    ++result.removed;
  }
  return result;
}

}  // namespace mezzotint
