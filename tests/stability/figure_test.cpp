#include "tests/stability/scene.h"

namespace mezzotint {
namespace {

using test::light_at;

constexpr double gradients[] = {0.1, 0.3, 0.8};

std::vector<double> angles() {
  std::vector<double> all;
  for (double theta = 0.0; theta < 86.0; theta += 5.0) all.push_back(theta);
  all.insert(all.end(), {87.0, 88.0, 89.0});
  return all;
}

std::string name_of(double gradient) { return fmt::format("s = {}", gradient); }

double rim_share(const Bsdf& bsdf) {
  const auto areas = projected_solid_angles(bsdf.grid);
  double rim = 0.0, all = 0.0;
  for (std::size_t k = 0; k < areas.size(); ++k) {
    const double light = areas[k] * bsdf.reflection.mean[k];
    all += light;
    if (areas[k] < 3.999 / static_cast<double>(bsdf.grid.size())) rim += light;
  }
  return rim / all;
}

TEST(AngleOfTheLight, DecidesWhatAWeightCreates) {
  for (const double gradient : gradients) {
    PathTracer tracer(test::random_relief(128, gradient));
    test::FailureCurve slides{"slides", name_of(gradient), angles(), {}}, flux{"slides", "flux", angles(), {}};
    for (const double theta : angles()) {
      PathTracingOptions options = light_at(theta, Mirror{}, 12);
      flux.values.push_back(tracer.trace(options).energy.reflected.value);
      options.estimator = Estimator::Slides;
      slides.values.push_back(tracer.trace(options).energy.reflected.value);
      EXPECT_NEAR(flux.values.back(), 1.0, 1e-4) << gradient << " at " << theta;  // what rounding may lose at edges
    }
    // Too little from above, too much at grazing incidence, growing with the angle.
    EXPECT_LT(slides.values.front(), 1.0);
    EXPECT_GT(slides.values.back(), 1.0);
    EXPECT_GT(slides.values.back(), slides.values[slides.values.size() - 2]);
    test::record(slides);
    if (gradient == gradients[0]) test::record(flux);
  }
}

TEST(AngleOfTheLight, DecidesWhatSlopesAloneCreate) {
  for (const double gradient : gradients) {
    PathTracer tracer(test::random_relief(128, gradient));
    test::FailureCurve slopes{"slopes", name_of(gradient), angles(), {}};
    for (const double theta : angles()) {
      slopes.values.push_back(test::share(tracer.splat(light_at(theta)), "unadjusted_energy"));
    }
    EXPECT_GT(slopes.values.back(), 1.5);
    test::record(slopes);
  }
}

TEST(AngleOfTheLight, DecidesWhatLiesOnTheRim) {
  for (const double gradient : gradients) {
    PathTracer tracer(test::random_relief(128, gradient));
    test::FailureCurve rim{"rim", name_of(gradient), angles(), {}};
    for (const double theta : angles()) {
      rim.values.push_back(rim_share(tracer.trace(light_at(theta, Dielectric{1.5}, 13))));
    }
    // Light that is spread evenly over the disc puts 7 % there, a rough lobe from above hardly more.
    EXPECT_LT(rim.values.front(), 0.12);
    if (gradient == 0.1) {
      EXPECT_GT(rim.values.back(), 0.3);
    }
    test::record(rim);
  }
}

}  // namespace
}  // namespace mezzotint
