#include "forward/optics/direction.h"

#include <cmath>

#include <gtest/gtest.h>

namespace mezzotint {
namespace {

DirectionAngles degrees(double theta, double phi) { return {Angle::from_degrees(theta), Angle::from_degrees(phi)}; }

TEST(Direction, RunsFromTheNormalAndCounterClockwiseFromX) {
  EXPECT_NEAR((to_direction(degrees(0, 77)) - Direction(0, 0, 1)).norm(), 0.0, 1e-15);  // rounding
  EXPECT_NEAR((to_direction(degrees(90, 0)) - Direction(1, 0, 0)).norm(), 0.0, 1e-15);
  EXPECT_NEAR((to_direction(degrees(90, 90)) - Direction(0, 1, 0)).norm(), 0.0, 1e-15);
  EXPECT_NEAR((to_direction(degrees(30, 180)) - Direction(-0.5, 0, std::sqrt(0.75))).norm(), 0.0, 1e-15);
}

TEST(Direction, MakesTheRoundTripThroughAnglesInBothHemispheres) {
  for (const double theta : {1e-9, 0.3, 45.0, 89.9, 120.0, 179.0}) {
    for (const double phi : {-170.0, -90.0, 0.0, 33.0, 179.0}) {
      const DirectionAngles back = to_angles(to_direction(degrees(theta, phi)));
      // A few roundings of numbers up to 180; relative for the small angle, which acos(z) would lose.
      EXPECT_NEAR(back.theta.degrees(), theta, 1e-15 + 2e-14 * theta);
      EXPECT_NEAR(back.phi.degrees(), phi, 1e-12);
    }
  }
}

}  // namespace
}  // namespace mezzotint
