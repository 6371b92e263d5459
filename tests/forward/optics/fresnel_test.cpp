#include <cmath>
#include <complex>
#include <numbers>

#include <gtest/gtest.h>

#include "forward/optics/material.h"
#include "tests/forward/optics/quadrature.h"

namespace mezzotint {
namespace {

// Walsh/Duntley's closed form, as tabulated in the project's list of reference values.
struct DiffuseAlbedo {
  double index, outside, inside;
};
constexpr DiffuseAlbedo published[] = {{1.33, .065930849299, .471949148793}, {1.4, .076811545577, .528985482437},
                                       {1.45, .084366959185, .564502715427}, {1.5, .091777959342, .596345759708},
                                       {1.55, .099065830929, .625001386443}, {1.6, .106245567839, .650877174937},
                                       {2.0, .160596637070, .790149159267}};

// 64 Gauss points reach rounding (the integrand is analytic up to a distance of 0.87); the table has 12 digits.
constexpr double table_tolerance = 1e-11;

double square(double x) { return x * x; }

TEST(DielectricFresnel, HasThePublishedDiffuseAlbedoFromOutside) {
  const auto rule = test::gauss_legendre(64);
  for (const DiffuseAlbedo& row : published) {
    const double albedo = test::integrate(
        rule, [&](double cosine) { return 2.0 * cosine * dielectric_fresnel(cosine, row.index).reflectance; });
    EXPECT_NEAR(albedo, row.outside, table_tolerance) << "index " << row.index;
  }
}

TEST(DielectricFresnel, HasThePublishedDiffuseAlbedoFromInside) {
  const auto rule = test::gauss_legendre(64);
  for (const DiffuseAlbedo& row : published) {
    const double critical = 1.0 - 1.0 / square(row.index);  // square of the cosine
    const auto reflected = [&](double cosine) { return dielectric_fresnel(cosine, 1.0 / row.index).reflectance; };
    const double beyond =
        test::integrate(rule, [&](double t) { return 2.0 * critical * t * reflected(std::sqrt(critical) * t); });
    // cos² = critical + (1 − critical) t²: smooth in t where the reflectance has a root in the cosine.
    const double within = test::integrate(rule, [&](double t) {
      return 2.0 * (1.0 - critical) * t * reflected(std::sqrt(critical + (1.0 - critical) * t * t));
    });
    EXPECT_NEAR(beyond + within, row.inside, table_tolerance) << "index " << row.index;
  }
}

TEST(DielectricFresnel, LosesOnePolarisationAtBrewstersAngle) {
  constexpr struct { double index, degrees; } angles[] = {{1.33, 53.06}, {1.4, 54.46}, {1.5, 56.31}, {1.6, 57.99}};
  for (const auto& [index, degrees] : angles) {
    const double angle = std::atan(index);
    EXPECT_NEAR(angle * 180.0 / std::numbers::pi, degrees, 0.005);  // published with two decimals
    const double other = square((square(index) - 1.0) / (square(index) + 1.0));
    EXPECT_NEAR(dielectric_fresnel(std::cos(angle), index).reflectance, 0.5 * other, 1e-15);  // rounding
    // The refracted ray is at right angles to the reflected one.
    EXPECT_NEAR(dielectric_fresnel(std::cos(angle), index).cos_refracted, std::sin(angle), 1e-15);
  }
}

TEST(DielectricFresnel, ReflectsAllBeyondTheCriticalAngleAndLessBefore) {
  const double critical = std::sqrt(1.0 - 1.0 / square(1.5));
  for (const double cosine : {0.0, 0.3, critical - 1e-12}) {
    EXPECT_EQ(dielectric_fresnel(cosine, 1.0 / 1.5).reflectance, 1.0);
    EXPECT_EQ(dielectric_fresnel(cosine, 1.0 / 1.5).cos_refracted, 0.0);
  }
  EXPECT_LT(dielectric_fresnel(critical + 1e-6, 1.0 / 1.5).reflectance, 0.999);
}

TEST(DielectricFresnel, IsTheSameFromBothSidesAlongOneRay) {
  for (const double cosine : {0.05, 0.4, 0.9, 1.0}) {
    const DielectricFresnel in = dielectric_fresnel(cosine, 1.5);
    const DielectricFresnel out = dielectric_fresnel(in.cos_refracted, 1.0 / 1.5);
    EXPECT_NEAR(out.reflectance, in.reflectance, 1e-14);  // rounding, a little amplified at grazing
    EXPECT_NEAR(out.cos_refracted, cosine, 1e-14);
  }
}

TEST(DielectricFresnel, HasItsLimitsAtNormalAndGrazingIncidence) {
  EXPECT_NEAR(dielectric_fresnel(1.0, 1.5).reflectance, 0.04, 1e-16);
  EXPECT_EQ(dielectric_fresnel(0.0, 1.5).reflectance, 1.0);
  EXPECT_NEAR(dielectric_fresnel(0.0, 1.5).cos_refracted, std::sqrt(5.0) / 3.0, 1e-15);
  EXPECT_EQ(dielectric_fresnel(0.7, 1.0).reflectance, 0.0);
}

// Born & Wolf §14.2 in real numbers: no complex arithmetic shared with the code.
double textbook_conductor(double cosine, double eta, double kappa) {
  const double sine2 = 1.0 - square(cosine), d = square(eta) - square(kappa) - sine2;
  const double root = std::hypot(d, 2.0 * eta * kappa), a = std::sqrt(0.5 * (root + d));
  const double across = (root - 2.0 * a * cosine + square(cosine)) / (root + 2.0 * a * cosine + square(cosine));
  const double w = sine2 / cosine;  // sinθ tanθ
  const double along = across * (root - 2.0 * a * w + square(w)) / (root + 2.0 * a * w + square(w));
  return 0.5 * (across + along);
}

TEST(ConductorFresnel, IsTheTextbooksInRealNumbers) {
  constexpr struct { double eta, kappa; } metals[] = {{0.2, 3.0}, {1.1978, 7.0488}, {2.9, 3.1}, {0.05, 4.2}};
  for (const auto& [eta, kappa] : metals) {
    for (const double cosine : {0.01, 0.2, 0.5, 0.8, 1.0}) {
      EXPECT_NEAR(conductor_fresnel(cosine, {eta, kappa}), textbook_conductor(cosine, eta, kappa), 1e-13);  // rounding
    }
  }
}

TEST(ConductorFresnel, HasItsClosedFormAtNormalIncidence) {
  for (const std::complex<double> index : {std::complex{0.2, 3.0}, std::complex{1.5, 1e-3}, std::complex{2.5, 40.0}}) {
    const double expected =
        (square(index.real() - 1.0) + square(index.imag())) / (square(index.real() + 1.0) + square(index.imag()));
    EXPECT_NEAR(conductor_fresnel(1.0, index), expected, 1e-15);  // rounding
  }
}

TEST(ConductorFresnel, BecomesADielectricAsKappaVanishes) {
  for (const double cosine : {0.0, 0.1, 0.5, 0.9, 1.0}) {
    EXPECT_NEAR(conductor_fresnel(cosine, {1.5, 1e-9}), dielectric_fresnel(cosine, 1.5).reflectance, 1e-9);  // O(κ)
    EXPECT_NEAR(conductor_fresnel(cosine, {1.5, 0.0}), dielectric_fresnel(cosine, 1.5).reflectance, 1e-15);
  }
}

TEST(Reflectance, FollowsTheMaterial) {
  EXPECT_EQ(reflectance(Mirror{}, 0.3), 1.0);
  EXPECT_EQ(reflectance(Dielectric{1.7}, 0.3), dielectric_fresnel(0.3, 1.7).reflectance);
  EXPECT_EQ(reflectance(Conductor{0.2, 3.0}, 0.3), conductor_fresnel(0.3, {0.2, 3.0}));
}

}  // namespace
}  // namespace mezzotint
