#include "forward/optics/microfacet.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <gtest/gtest.h>

#include "forward/base/error.h"
#include "tests/forward/optics/quadrature.h"

namespace mezzotint {
namespace {

Direction toward(double theta_deg, double phi_deg) {
  return to_direction({Angle::from_degrees(theta_deg), Angle::from_degrees(phi_deg)});
}

const BeckmannLobe anisotropic{0.5, 0.2, Angle::from_degrees(30.0)};
const GgxLobe anisotropic_ggx{0.5, 0.2, Angle::from_degrees(30.0)};

TEST(BeckmannLobe, HasNormalsThatCoverThePlaneOnce) {
  for (const BeckmannLobe& lobe : {BeckmannLobe{0.1, 0.1, {}}, BeckmannLobe{1.5, 1.5, {}}, anisotropic}) {
    const double covered = test::integrate_hemisphere(200, [&](const Direction& m) { return distribution(lobe, m); });
    EXPECT_NEAR(covered, 1.0, 1e-10);  // 200 points resolve a lobe of 0.1 to rounding
  }
}

TEST(BeckmannLobe, HasGaussianSlopesAlongItsTurnedAxes) {
  const Direction along(std::cos(std::numbers::pi / 6), std::sin(std::numbers::pi / 6),
                        0.0);  // +30°, counter-clockwise
  const Direction across(-along.y(), along.x(), 0.0);
  for (const double slope : {0.0, 0.1, 0.4}) {
    const double peak = 1.0 / (std::numbers::pi * 0.5 * 0.2), stretch = std::pow(1.0 + slope * slope, 2);
    const Direction tilted_along = (Direction(0, 0, 1) - slope * along).normalized();
    const Direction tilted_across = (Direction(0, 0, 1) + slope * across).normalized();
    // Rounding of a peak of 3.
    EXPECT_NEAR(distribution(anisotropic, tilted_along), peak * std::exp(-slope * slope / 0.25) * stretch, 1e-14);
    EXPECT_NEAR(distribution(anisotropic, tilted_across), peak * std::exp(-slope * slope / 0.04) * stretch, 1e-14);
  }
  EXPECT_EQ(distribution(anisotropic, {0.0, 0.0, -1.0}), 0.0);
}

TEST(BeckmannLobe, StaysTheSameWhenItsAxesChangePlaces) {
  const BeckmannLobe other{0.2, 0.5, Angle::from_degrees(-60.0)};
  const Direction light = toward(50, 10), viewer = toward(35, 160);
  EXPECT_NEAR(brdf(other, Mirror{}, light, viewer) / brdf(anisotropic, Mirror{}, light, viewer), 1.0, 1e-13);
}

TEST(SmithLambda, ShowsTheProjectedAreaOfTheVisibleFacets) {
  // Smith's Λ is defined by it: (1 + Λ) cosθ = ∫ max(0, ω·m) D(m) dm, here over the slopes themselves.
  for (const double theta : {5.0, 40.0, 70.0, 85.0}) {
    for (const double phi : {0.0, 30.0, 75.0}) {
      const Direction direction = toward(theta, phi);
      const double turn = 30.0 * std::numbers::pi / 180.0;
      constexpr int steps = 1200;
      constexpr double reach = 6.0, step = 2.0 * reach / steps;
      double area = 0.0;
      for (int j = 0; j < steps; ++j) {
        for (int i = 0; i < steps; ++i) {
          const double u = -reach + step * (i + 0.5), v = -reach + step * (j + 0.5);
          const double along = 0.5 * u, across = 0.2 * v;
          const double sx = along * std::cos(turn) - across * std::sin(turn);
          const double sy = along * std::sin(turn) + across * std::cos(turn);
          const double facing = direction.z() - sx * direction.x() - sy * direction.y();
          area += std::max(0.0, facing) * std::exp(-u * u - v * v);
        }
      }
      area *= step * step / std::numbers::pi;
      // Midpoints across the kink of max(): step²/12 of its slope, 1e-5.
      EXPECT_NEAR((1.0 + smith_lambda(anisotropic, direction)) * direction.z(), area, 1e-5) << theta << ' ' << phi;
    }
  }
}

TEST(SmithLambda, ShowsTheProjectedAreaOfTheVisibleFacetsOfGgxToo) {
  // As above, around the slopes' origin with r = tan χ, which brings the long tails in: r dr/(1 + r²)² = sin χ cos χ
  // dχ.
  for (const double theta : {5.0, 40.0, 70.0, 85.0}) {
    for (const double phi : {0.0, 30.0, 75.0}) {
      const Direction direction = toward(theta, phi);
      const double turn = 30.0 * std::numbers::pi / 180.0;
      constexpr int steps = 1200;
      const double step = 0.5 * std::numbers::pi / steps;
      double area = 0.0;
      for (int j = 0; j < steps; ++j) {
        for (int i = 0; i < steps; ++i) {
          const double chi = step * (i + 0.5), around = 4.0 * step * (j + 0.5);
          const double along = 0.5 * std::tan(chi) * std::cos(around), across = 0.2 * std::tan(chi) * std::sin(around);
          const double sx = along * std::cos(turn) - across * std::sin(turn);
          const double sy = along * std::sin(turn) + across * std::cos(turn);
          const double facing = direction.z() - sx * direction.x() - sy * direction.y();
          area += std::max(0.0, facing) * std::sin(chi) * std::cos(chi);
        }
      }
      area *= 4.0 * step * step / std::numbers::pi;
      // Midpoints across the kink of max(): step² of its slope.
      EXPECT_NEAR((1.0 + smith_lambda(anisotropic_ggx, direction)) * direction.z(), area, 1e-5) << theta << ' ' << phi;
    }
  }
}

TEST(SmithLambda, HidesNothingAtTheNormalAndAllAtTheHorizon) {
  EXPECT_EQ(smith_lambda(anisotropic, {0.0, 0.0, 1.0}), 0.0);
  EXPECT_GT(smith_lambda(anisotropic, toward(89.9999, 0.0)), 1e4);
  EXPECT_GE(smith_lambda(BeckmannLobe{1e-4, 1e-4, {}}, toward(60.0, 0.0)), 0.0);
}

TEST(GgxLobe, HasNormalsThatCoverThePlaneOnce) {
  for (const GgxLobe& lobe : {GgxLobe{0.1, 0.1, {}}, GgxLobe{1.5, 1.5, {}}, anisotropic_ggx}) {
    const double covered = test::integrate_hemisphere(200, [&](const Direction& m) { return distribution(lobe, m); });
    EXPECT_NEAR(covered, 1.0, 1e-8);  // its peak at α = 0.1 has poles nearer to the path than a Gaussian: 1e-9 here
  }
}

TEST(GgxLobe, HasItsPeakAndHalfOfItsSlopesWithinAlpha) {
  // P(r < 1) = ∫ 2r/(1 + r²)² dr = 1/2; D(n) = 1/(π α²).
  const GgxLobe lobe{0.3, 0.3, {}};
  EXPECT_NEAR(distribution(lobe, {0.0, 0.0, 1.0}), 1.0 / (std::numbers::pi * 0.09), 1e-12);
  const double within = test::integrate(test::gauss_legendre(60), [&](double t) {
    const double slope = 0.3 * t, z = 1.0 / std::sqrt(1.0 + slope * slope);
    // dω cosθ = z⁴ · slope d(slope) dφ
    return distribution(lobe, {slope * z, 0.0, z}) * std::pow(z, 4) * slope * 0.3 * 2.0 * std::numbers::pi;
  });
  EXPECT_NEAR(within, 0.5, 1e-12);
}

TEST(GgxLobe, IsTheSameWhenItsAxesChangePlaces) {
  const GgxLobe other{0.2, 0.5, Angle::from_degrees(-60.0)};
  const Direction light = toward(50, 10), viewer = toward(35, 160);
  EXPECT_NEAR(brdf(other, Mirror{}, light, viewer) / brdf(anisotropic_ggx, Mirror{}, light, viewer), 1.0, 1e-13);
}

template <class Lobe>
void expect_reciprocal(const Lobe& lobe) {
  for (const Material& material : {Material{Mirror{}}, Material{Dielectric{1.5}}, Material{Conductor{0.2, 3.0}}}) {
    for (const double theta : {0.0, 30.0, 60.0, 85.0}) {
      for (const double phi : {0.0, 100.0, 250.0}) {
        const Direction a = toward(theta, 20.0), b = toward(50.0, phi);
        const double there = brdf(lobe, material, a, b), back = brdf(lobe, material, b, a);
        EXPECT_NEAR(there, back, 1e-13 * there);  // rounding
      }
    }
  }
}

TEST(Brdf, IsReciprocal) {
  expect_reciprocal(anisotropic);
  expect_reciprocal(anisotropic_ggx);
}

TEST(Brdf, IsNothingBelowTheHorizon) {
  const Direction up = toward(20, 0), down = toward(100, 0), level(1.0, 0.0, 0.0);
  EXPECT_EQ(brdf(anisotropic, Mirror{}, up, down), 0.0);
  EXPECT_EQ(brdf(anisotropic, Mirror{}, down, up), 0.0);
  EXPECT_EQ(brdf(anisotropic, Mirror{}, up, level), 0.0);
}

TEST(Brdf, HasItsClosedFormAtTheMirrorDirection) {
  // D = 1/(π α²), m = n, G₂ = 1/(1 + 2Λ) with Λ at a = cot 60°/0.5 = 1.1547, from erf tables: erfc(a) = .102470.
  const double a = 1.0 / (std::sqrt(3.0) * 0.5);
  const double lambda = 0.5 * (std::exp(-4.0 / 3.0) / (a * std::sqrt(std::numbers::pi)) - 0.102470);
  const double expected = dielectric_fresnel(0.5, 1.5).reflectance / (std::numbers::pi * 0.25) / (1.0 + 2.0 * lambda);
  const BeckmannLobe lobe{0.5, 0.5, {}};
  EXPECT_NEAR(brdf(lobe, Dielectric{1.5}, toward(60, 0), toward(60, 180)), expected, 1e-6);  // six digits of erfc
}

TEST(GgxLobe, RefusesAlphasOutOfItsRange) {
  EXPECT_THROW(require_valid(GgxLobe{9e-5, 0.3, {}}), InvalidInput);
  EXPECT_THROW(require_valid(GgxLobe{0.3, std::numeric_limits<double>::quiet_NaN(), {}}), InvalidInput);
  EXPECT_NO_THROW(require_valid(GgxLobe{1e-4, 4.0, {}}));
}

TEST(BeckmannLobe, RefusesAlphasOutOfItsRange) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  for (const double alpha : {0.0, 9e-5, 4.1, -0.3, nan, std::numeric_limits<double>::infinity()}) {
    EXPECT_THROW(require_valid(BeckmannLobe{alpha, 0.3, {}}), InvalidInput);
    EXPECT_THROW(require_valid(BeckmannLobe{0.3, alpha, {}}), InvalidInput);
  }
  EXPECT_THROW(require_valid(BeckmannLobe{0.3, 0.3, Angle::from_radians(nan)}), InvalidInput);
  EXPECT_NO_THROW(require_valid(BeckmannLobe{1e-4, 4.0, Angle::from_degrees(720)}));
}

}  // namespace
}  // namespace mezzotint
