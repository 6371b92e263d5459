#include "measurement/correction/polynomial.h"

#include <gtest/gtest.h>

#include "forward/base/error.h"
#include "measurement/correction/plane.h"
#include "tests/measurement/relief.h"

namespace mezzotint {
namespace {

using test::field_of;
using test::micrometre_grid;

double cubic_um(double c, double r) {
  const double x = c / 20.0 - 1.0, y = r / 15.0 - 1.0;
  return 2.0 - 3.0 * x + y + 0.5 * x * x - 4.0 * x * y * y + 0.25 * y * y * y;
}

TEST(Polynomial, OfItsOwnDegreeLeavesNothing) {
  const HeightField field = field_of(micrometre_grid(41, 31), cubic_um);
  const HeightField rest = subtract_polynomial(field, fit_polynomial(field, 3));
  for (const float z : rest.heights_um()) EXPECT_NEAR(z, 0.0, 1e-6);  // heights of up to 11 in float
}

TEST(Polynomial, IsFoundThoughAThirdIsMissing) {
  HeightField field = field_of(micrometre_grid(41, 31), cubic_um);
  for (std::size_t i = 0; i < field.grid().size(); i += 3) field.heights_um()[i] = test::missing;
  for (std::size_t c = 0; c < 20; ++c) field.at(c, 3) = test::missing;
  const SurfacePolynomial fit = fit_polynomial(field, 3);
  const SurfacePolynomial whole = fit_polynomial(field_of(micrometre_grid(41, 31), cubic_um), 3);
  for (std::size_t k = 0; k < fit.coefficients_um.size(); ++k)
    EXPECT_NEAR(fit.coefficients_um[k], whole.coefficients_um[k], 1e-6);  // floats on the surface
  EXPECT_EQ(subtract_polynomial(field, fit).missing_count(), field.missing_count());
}

TEST(Polynomial, OfTheFirstDegreeIsThePlane) {
  const HeightField field = test::white_noise(micrometre_grid(37, 22), 4);
  const HeightField by_plane = level(field), by_polynomial = subtract_polynomial(field, fit_polynomial(field, 1));
  for (std::size_t i = 0; i < field.grid().size(); ++i)
    EXPECT_NEAR(by_plane.heights_um()[i], by_polynomial.heights_um()[i], 1e-6);
  EXPECT_NEAR(by_plane.datum().um(), by_polynomial.datum().um(), 1e-12);
}

TEST(Polynomial, ThroughAPartOfTheSamplesForgetsTheOthers) {
  HeightField field = field_of(micrometre_grid(41, 31), cubic_um);
  std::vector<std::uint8_t> use(field.grid().size(), 1);
  for (std::size_t c = 10; c < 30; ++c) {
    field.at(c, 8) += 100.0F;
    use[8 * 41 + c] = 0;
  }
  const HeightField rest = subtract_polynomial(field, fit_polynomial(field, 3, use));
  EXPECT_NEAR(rest.at(12, 8), 100.0, 1e-4);
  EXPECT_NEAR(rest.at(12, 9), 0.0, 1e-6);
}

TEST(Polynomial, RefusesWhatTheSamplesDoNotDetermine) {
  EXPECT_THROW((void)fit_polynomial(HeightField(micrometre_grid(3, 40), Continuation::Mirrored), 3), InvalidInput);
  EXPECT_THROW((void)fit_polynomial(HeightField(micrometre_grid(9, 9), Continuation::Mirrored), 13), InvalidInput);
  EXPECT_THROW((void)fit_polynomial(HeightField(micrometre_grid(9, 9), Continuation::Mirrored), -1), InvalidInput);
}

}  // namespace
}  // namespace mezzotint
