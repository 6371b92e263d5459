#include "inverse/target/target.h"

#include <cmath>

#include <gtest/gtest.h>

#include "forward/base/error.h"

namespace mezzotint {
namespace {

const Target brushed = beckmann_target({0.25, 0.10, 30.0_deg});

TEST(Target, OfABeckmannLobeHasItsSlopes) {
  EXPECT_NEAR(brushed.slopes.rms_major, 0.25 / std::sqrt(2.0), 1e-15);
  EXPECT_NEAR(brushed.slopes.rms_minor, 0.10 / std::sqrt(2.0), 1e-15);
  EXPECT_TRUE(brushed.rotation_matters);
  EXPECT_FALSE(beckmann_target({0.2, 0.2, 0.0_deg}).rotation_matters);
}

TEST(Target, DistanceIsZeroOnTargetAndCountsBothAxesAlike) {
  const SlopeCovariance on_target = covariance_of(brushed.slopes);
  EXPECT_NEAR(covariance_distance(on_target, brushed), 0.0, 1e-18);
  SlopeAxes steeper = brushed.slopes, rounder = brushed.slopes;
  steeper.rms_major *= 1.1;
  rounder.rms_minor *= 1.1;
  // Both variances by a factor 1.21: (ln 1.21)².
  const double expected = std::pow(std::log(1.21), 2);
  EXPECT_NEAR(covariance_distance(covariance_of(steeper), brushed), expected, 1e-10);
  EXPECT_NEAR(covariance_distance(covariance_of(rounder), brushed), expected, 1e-10);
}

TEST(Target, DistanceHasTheSlopesOfItsDifferences) {
  for (const Target& target : {brushed, anisotropy_target(2.5, 0.15)}) {
    const SlopeCovariance at{0.02, 0.011, 0.004};
    const CovarianceDistance found = covariance_distance_with_slopes(at, target);
    EXPECT_NEAR(found.value, covariance_distance(at, target), 1e-12);
    constexpr double step = 1e-7;
    const auto difference = [&](double SlopeCovariance::*number) {
      SlopeCovariance above = at, below = at;
      above.*number += step;
      below.*number -= step;
      return (covariance_distance(above, target) - covariance_distance(below, target)) / (2.0 * step);
    };
    // Slopes of some hundreds; distances are known to 1e-15, so their differences to 1e-8.
    EXPECT_NEAR(found.slopes.xx, difference(&SlopeCovariance::xx), 1e-5);
    EXPECT_NEAR(found.slopes.yy, difference(&SlopeCovariance::yy), 1e-5);
    EXPECT_NEAR(found.slopes.xy, difference(&SlopeCovariance::xy), 1e-5);
  }
  const SlopeCovariance flat{};
  EXPECT_TRUE(std::isfinite(covariance_distance_with_slopes(flat, brushed).slopes.xx));
}

TEST(Target, DistanceDoesNotDependOnTheFrame) {
  Target turned = brushed;
  turned.slopes.rotation = turned.slopes.rotation + 50.0_deg;
  const SlopeAxes other{0.2, 0.05, 10.0_deg};
  SlopeAxes other_turned = other;
  other_turned.rotation = other.rotation + 50.0_deg;
  EXPECT_NEAR(covariance_distance(covariance_of(other), brushed),
              covariance_distance(covariance_of(other_turned), turned), 1e-10);
}

TEST(Target, ErrorIsOfTheVariancesAndTheAxis) {
  const SlopeAxes off{brushed.slopes.rms_major * 1.02, brushed.slopes.rms_minor * 0.97, 31.5_deg};
  const TargetError error = target_error(covariance_of(off), brushed);
  EXPECT_NEAR(error.variance_major, 1.02 * 1.02 - 1.0, 1e-12);
  EXPECT_NEAR(error.variance_minor, 0.97 * 0.97 - 1.0, 1e-12);
  EXPECT_NEAR(error.rotation.degrees(), 1.5, 1e-9);
  EXPECT_FALSE(is_met(error, brushed));  // 0.97² is 5.9 % off
}

TEST(Target, OfAnAnisotropyLeavesTheDirectionOpen) {
  const Target target = anisotropy_target(4.0, 0.2);
  EXPECT_NEAR(target.slopes.rms_major, 0.4 / std::sqrt(2.0), 1e-15);
  for (const double degrees : {0.0, 37.0, 90.0}) {
    SlopeAxes axes = target.slopes;
    axes.rotation = Angle::from_degrees(degrees);
    EXPECT_NEAR(covariance_distance(covariance_of(axes), target), 0.0, 1e-18);
    EXPECT_TRUE(is_met(target_error(covariance_of(axes), target), target));
  }
}

TEST(Target, StaysFiniteForAFlatSurface) {
  EXPECT_TRUE(std::isfinite(covariance_distance({0.0, 0.0, 0.0}, brushed)));
  EXPECT_GT(covariance_distance({0.0, 0.0, 0.0}, brushed), 100.0);
}

TEST(Target, RefusesWhatNoSurfaceHas) {
  EXPECT_THROW((void)beckmann_target({0.1, 0.2, 0.0_deg}), InvalidInput);
  EXPECT_THROW((void)beckmann_target({5.0, 0.2, 0.0_deg}), InvalidInput);
  EXPECT_THROW((void)anisotropy_target(0.5, 0.2), InvalidInput);
  EXPECT_THROW((void)scan_target(HeightField({8, 8, 1.0_um, 1.0_um}, Continuation::Mirrored)), InvalidInput);
}

}  // namespace
}  // namespace mezzotint
