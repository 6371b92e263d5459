#include <cmath>

#include <gtest/gtest.h>

#include "forward/base/error.h"
#include "forward/base/random.h"
#include "measurement/comparison/registration.h"
#include "tests/measurement/comparison/cosine_relief.h"

namespace mezzotint {
namespace {

using test::CosineRelief;
using test::square_grid;

Registration placed(double x_um, double y_um, double degrees) {
  Registration registration;
  registration.shift_x.value = Length::from_um(x_um);
  registration.shift_y.value = Length::from_um(y_um);
  registration.rotation.value = Angle::from_degrees(degrees);
  return registration;
}

struct Rms {
  double um = 0.0;
  double samples = 0.0;
};
Rms rms(const HeightField& field) {
  Rms result;
  for (const float z : field.heights_um()) {
    if (std::isnan(z)) continue;
    result.um += static_cast<double>(z) * static_cast<double>(z);
    result.samples += 1.0;
  }
  result.um = std::sqrt(result.um / result.samples);
  return result;
}

void add_noise(HeightField& field, double um) {
  const RandomStream random(1, RandomPurpose::Test);
  for (std::size_t k = 0; k < field.heights_um().size(); ++k) {
    field.heights_um()[k] += static_cast<float>(um * random.normal4(k)[0]);
  }
}

TEST(ResampleToDesign, UndoesAKnownPlacementAndTilt) {
  const Grid grid = square_grid(128, 1.0);
  const CosineRelief relief(1, 20, 60);
  HeightField measured = relief.on(grid, grid, 4.3, -2.6, 3.0);
  for (std::size_t k = 0; k < grid.size(); ++k) {
    measured.heights_um()[k] += static_cast<float>(7.0 + 0.05 * static_cast<double>(k % 128));
  }
  const HeightField design = relief.on(grid);
  const HeightField resampled = resample_to_design(design, measured, placed(4.3, -2.6, 3.0));
  const Rms left = rms(residual(design, resampled));
  // A wave of 20 samples is interpolated to 0.3 % at worst, of 2 µm in all; 5 nm RMS leaves room and is a
  // thousandth of the tilt that was added.
  EXPECT_LT(left.um, 0.005);
  EXPECT_GT(left.samples, 0.85 * 128 * 128);
  EXPECT_EQ(resampled.grid(), grid);
}

TEST(ResampleToDesign, KeepsNoiseAtWholeSamplesAndAveragesItHalfWay) {
  const Grid grid = square_grid(192, 1.0);
  const CosineRelief relief(2, 60, 120);
  const HeightField design = relief.on(grid);
  // Half way Keys's weights are −1 9 9 −1 over 16 along each axis: Σw² = 0.640625, so the RMS in the plane is that.
  for (const auto& [shift_um, factor] : {std::pair{3.0, 1.0}, {3.5, 0.640625}}) {
    HeightField measured = relief.on(grid, grid, shift_um, shift_um);
    add_noise(measured, 0.1);
    const Rms left = rms(residual(design, resample_to_design(design, measured, placed(shift_um, shift_um, 0.0))));
    // Five standard errors; interpolated samples share neighbours, which makes them up to three times less certain.
    EXPECT_NEAR(left.um, 0.1 * factor, 5.0 * 0.1 * (shift_um > 3.1 ? 1.5 : 1.0) / std::sqrt(2.0 * left.samples));
  }
}

TEST(ResampleToDesign, AveragesAMeasurementThatIsFinerThanTheDesign) {
  const CosineRelief relief(3, 60, 120);
  const Grid coarse = square_grid(64, 2.0);
  const Grid fine = square_grid(253, 0.5);
  const HeightField design = relief.on(coarse);
  HeightField measured = relief.on(fine, coarse);
  add_noise(measured, 0.1);
  const Rms left = rms(residual(design, resample_to_design(design, measured, placed(0.0, 0.0, 0.0))));
  // Weights ½ 1 1 1 ½ over 4 along each axis: Σw² = 3.5/16. Neighbours share a little; five standard errors. The mean
  // over 2 µm damps waves of 60 µm by (π·2/60)²/6 = 0.2 % of 2 µm, 3 nm beside 22.
  EXPECT_NEAR(left.um, 0.1 * 3.5 / 16.0, 5.0 * 0.1 * 3.5 / 16.0 / std::sqrt(2.0 * left.samples) + 0.0005);
}

TEST(ResampleToDesign, IsMissingWhereNothingWasMeasured) {
  const Grid grid = square_grid(64, 1.0);
  const CosineRelief relief(4, 20, 60);
  const HeightField design = relief.on(grid);
  const HeightField resampled = resample_to_design(design, relief.on(grid, grid, 10.0, 0.0), placed(10.0, 0.0, 0.0));
  EXPECT_EQ(resampled.missing_count(), 10U * 64U);
  EXPECT_TRUE(std::isnan(resampled.at(54, 3)));
  EXPECT_FALSE(std::isnan(resampled.at(53, 3)));
  EXPECT_THROW((void)resample_to_design(design, design, placed(1000.0, 0.0, 0.0)), InvalidInput);
}

TEST(Residual, RefusesSurfacesOnDifferentGrids) {
  const HeightField a(square_grid(8, 1.0), Continuation::Mirrored);
  const HeightField b(square_grid(8, 1.5), Continuation::Mirrored);
  EXPECT_THROW((void)residual(a, b), InvalidInput);
}

}  // namespace
}  // namespace mezzotint
