#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "fabrication/calibration/cure_point.h"
#include "forward/base/random.h"
#include "forward/process/cure_curve.h"

namespace mezzotint::test {

/// Steps of a wedge by the cure curve, with normal errors of a known size.
struct WedgeSample {
  CureCurve curve;
  std::vector<double> grays;
  double layer_um = 18.0;
  double error_um = 0.1;
  bool say_error = true;
};

inline std::vector<double> every_level(int from, int to, int step) {
  std::vector<double> grays;
  for (int level = from; level <= to; level += step) grays.push_back(level / 255.0);
  return grays;
}

inline std::vector<CurePoint> draw(const WedgeSample& sample, std::uint64_t seed) {
  const RandomStream stream(seed, RandomPurpose::Test);
  std::vector<CurePoint> points;
  for (std::size_t i = 0; i < sample.grays.size(); ++i) {
    const double gray = sample.grays[i], light = gray - sample.curve.gamma;
    // The slides' law, written out.
    const double cured_um = gray > std::exp(-(sample.curve.alpha / sample.curve.beta)) + sample.curve.gamma
                                ? sample.curve.alpha.um() + sample.curve.beta.um() * std::log(light)
                                : 0.0;
    CurePoint point{.gray = gray, .height_um = std::min(cured_um, sample.layer_um)};
    point.height_um += sample.error_um * stream.normal4(i)[0];
    if (sample.say_error) point.standard_error_um = sample.error_um;
    point.place = "step " + std::to_string(i + 1);
    points.push_back(point);
  }
  return points;
}

}  // namespace mezzotint::test
