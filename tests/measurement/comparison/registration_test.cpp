#include "measurement/comparison/registration.h"

#include <tbb/global_control.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <string>

#include <gtest/gtest.h>

#include "forward/base/error.h"
#include "measurement/instrument/virtual_profilometer.h"
#include "tests/measurement/comparison/cosine_relief.h"

namespace mezzotint {
namespace {

using test::CosineRelief;
using test::square_grid;

VirtualProfilometer askew(std::uint64_t seed = 1) {
  VirtualProfilometer instrument;
  instrument.pitch = 1.0_um;
  instrument.shift_x = Length::from_um(7.31);
  instrument.shift_y = Length::from_um(-5.67);
  instrument.rotation = Angle::from_degrees(2.23);
  instrument.tilt_x = 0.02;
  instrument.tilt_y = -0.013;
  instrument.noise = 100.0_nm;
  instrument.missing_share = 0.02;
  instrument.seed = seed;
  return instrument;
}

struct Pulls {
  double x = 0.0, y = 0.0, rotation = 0.0;
};

/// Errors in units of their own standard errors.
Pulls pulls(const Registration& found, double x_um, double y_um, double degrees) {
  return {(found.shift_x.value.um() - x_um) / found.shift_x.standard_error.um(),
          (found.shift_y.value.um() - y_um) / found.shift_y.standard_error.um(),
          (found.rotation.value.degrees() - degrees) / found.rotation.standard_error.degrees()};
}

TEST(Registration, FindsAnUnmovedReliefWhereItIs) {
  const HeightField relief = CosineRelief(1, 14, 60).on(square_grid(128, 1.0));
  const Registration found = register_surfaces(relief, relief);
  // The same heights: what is left is where Gauss–Newton stops, 1e-5 of a sample.
  EXPECT_NEAR(found.shift_x.value.um(), 0.0, 1e-5);
  EXPECT_NEAR(found.shift_y.value.um(), 0.0, 1e-5);
  EXPECT_NEAR(found.rotation.value.degrees(), 0.0, 1e-5);
  EXPECT_NEAR(found.correlation, 1.0, 1e-9);
  EXPECT_NEAR(found.overlap, 1.0, 2.0 / 128);  // round-off may push samples of the rim outside
  EXPECT_LT(found.runner_up, 0.8);
}

TEST(Registration, RecoversAKnownPlacementWithinItsErrors) {
  const HeightField relief = CosineRelief(2, 14, 60).on(square_grid(192, 1.0));
  const VirtualProfilometer instrument = askew();
  const Registration found = register_surfaces(relief, measure_virtually(relief, instrument));
  const Pulls pull = pulls(found, 7.31, -5.67, 2.23);
  EXPECT_LT(std::abs(pull.x), 3.0);
  EXPECT_LT(std::abs(pull.y), 3.0);
  EXPECT_LT(std::abs(pull.rotation), 3.0);
  // In absolute terms: noise/(slope·√n) = 0.1/(0.4·√33000) = 1.4e-3 µm is the Cramér–Rao bound, so that a
  // fiftieth of a sample is more than ten of it.
  EXPECT_NEAR(found.shift_x.value.um(), 7.31, 0.02);
  EXPECT_NEAR(found.shift_y.value.um(), -5.67, 0.02);
  EXPECT_NEAR(found.rotation.value.degrees(), 2.23, 0.01);
  EXPECT_LT(found.shift_x.standard_error.um(), 0.003);
  EXPECT_LT(found.rotation.standard_error.degrees(), 0.003);
}

TEST(Registration, FindsTheNoiseOfTheInstrumentInItsResidual) {
  const HeightField relief = CosineRelief(3, 14, 60).on(square_grid(192, 1.0));
  const Registration found = register_surfaces(relief, measure_virtually(relief, askew()));
  const double samples = found.overlap * 192 * 192;
  // Five standard errors of a standard deviation; the six fitted figures take away 6/n, far less.
  EXPECT_NEAR(found.residual_rms.um(), 0.1, 5.0 * 0.1 / std::sqrt(2.0 * samples));
}

/// The RMS of the pulls over repeated measurements must be 1. That of 20 pulls scatters by 1/√40 = 0.16, so the bounds
/// lie three and five of that away.
void expect_honest(const std::vector<Pulls>& all) {
  Pulls sum;
  for (const Pulls& p : all) sum.x += p.x * p.x, sum.y += p.y * p.y, sum.rotation += p.rotation * p.rotation;
  const auto n = static_cast<double>(all.size());
  for (const double squares : {sum.x, sum.y, sum.rotation}) {
    EXPECT_GT(std::sqrt(squares / n), 0.5);
    EXPECT_LT(std::sqrt(squares / n), 1.8);
  }
}

TEST(Registration, StatesHonestErrorsForWhiteNoise) {
  const HeightField relief = CosineRelief(4, 10, 40).on(square_grid(128, 1.0));
  std::vector<Pulls> all;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    VirtualProfilometer instrument = askew(seed);
    instrument.shift_x = Length::from_um(7.31 + 0.137 * static_cast<double>(seed));
    const Registration found = register_surfaces(relief, measure_virtually(relief, instrument));
    all.push_back(pulls(found, instrument.shift_x.um(), -5.67, 2.23));
  }
  expect_honest(all);
}

TEST(Registration, StatesHonestErrorsForAResidualThatIsCorrelated) {
  // What the print got wrong has features as wide as the design's own. Errors that took all samples for independent
  // would be some five times too small here.
  const Grid grid = square_grid(128, 1.0);
  const CosineRelief relief(5, 10, 40);
  const HeightField design = relief.on(grid);
  std::vector<Pulls> all;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    HeightField measured = relief.on(grid, grid, 3.4, 2.7, -1.5);
    const HeightField flaw = CosineRelief(100 + seed, 10, 40, 0.5).on(grid);
    for (std::size_t k = 0; k < grid.size(); ++k) measured.heights_um()[k] += flaw.heights_um()[k];
    all.push_back(pulls(register_surfaces(design, measured), 3.4, 2.7, -1.5));
  }
  expect_honest(all);
}

TEST(Registration, AgreesWithAMeasurementThatNobodyInterpolated) {
  // The measurement is the closed form itself, on another pitch in each axis; a third of the instrument's field lies
  // beside the design.
  const Grid grid = square_grid(160, 1.0);
  const Grid instrument{200, 180, Length::from_um(0.7), Length::from_um(1.1)};
  const CosineRelief relief(6, 14, 60);
  const Registration found = register_surfaces(relief.on(grid), relief.on(instrument, grid, -11.3, 8.9, -3.1));
  // Interpolating a wave of 14 samples by cubic convolution errs by up to 1 % of it, differently at each sample:
  // over thousands of them far below the hundredth of a sample that is asked here.
  EXPECT_NEAR(found.shift_x.value.um(), -11.3, 0.01);
  EXPECT_NEAR(found.shift_y.value.um(), 8.9, 0.01);
  EXPECT_NEAR(found.rotation.value.degrees(), -3.1, 0.01);
  EXPECT_GT(found.correlation, 0.9999);
}

TEST(Registration, AveragesTheDesignOverACoarseInstrumentsPixels) {
  const HeightField relief = CosineRelief(7, 8, 40).on(square_grid(384, 0.5));
  VirtualProfilometer instrument = askew();
  instrument.pitch = 1.5_um;
  instrument.noise = 20.0_nm;
  const Registration found = register_surfaces(relief, measure_virtually(relief, instrument));
  EXPECT_NEAR(found.shift_x.value.um(), 7.31, 0.02);  // as above: a fiftieth of a µm is about ten standard errors
  EXPECT_NEAR(found.shift_y.value.um(), -5.67, 0.02);
  EXPECT_NEAR(found.rotation.value.degrees(), 2.23, 0.01);
  // The pixel's mean was taken along axes 2.23° apart and interpolated; the waves of 8 µm are damped by 6 %, so that
  // comparing single points instead would leave about 0.05 µm.
  EXPECT_LT(found.residual_rms.um(), 0.03);
}

TEST(Registration, FindsASmallPartAndALargerWhole) {
  const HeightField whole = CosineRelief(8, 10, 40).on(square_grid(192, 1.0));
  const HeightField part = crop(whole, 70, 35, 90, 80);
  // Sample (70, 35) of the whole is (0, 0) of the part: no interpolation anywhere, so to 1e-3 samples.
  const Registration of_part = register_surfaces(whole, part);
  EXPECT_NEAR(of_part.shift_x.value.um(), -70.0, 1e-3);
  EXPECT_NEAR(of_part.shift_y.value.um(), -35.0, 1e-3);
  EXPECT_NEAR(of_part.overlap, 90.0 * 80.0 / (192.0 * 192.0), 0.01);
  const Registration of_whole = register_surfaces(part, whole);
  EXPECT_NEAR(of_whole.shift_x.value.um(), 70.0, 1e-3);
  EXPECT_NEAR(of_whole.shift_y.value.um(), 35.0, 1e-3);
  EXPECT_NEAR(of_whole.overlap, 1.0, 0.03);  // the rim, as above
}

TEST(Registration, TellsThatAPeriodicReliefFitsElsewhereToo) {
  HeightField relief(square_grid(160, 1.0), Continuation::Periodic);
  for (std::size_t k = 0; k < relief.heights_um().size(); ++k) {
    const double x = 2.0 * std::numbers::pi * static_cast<double>(k % 160) / 20.0;
    const double y = 2.0 * std::numbers::pi * static_cast<double>(k / 160) / 20.0;
    relief.heights_um()[k] = static_cast<float>(2.0 * std::sin(x) * std::sin(y));
  }
  VirtualProfilometer instrument = askew();
  instrument.shift_x = 2.0_um;
  instrument.shift_y = 1.0_um;
  const Registration found = register_surfaces(relief, measure_virtually(relief, instrument));
  EXPECT_GT(found.correlation, 0.99);
  // Shifted by a period it is the same surface; only the noise, 1 % of the variance, differs.
  EXPECT_NEAR(found.runner_up, found.correlation, 0.01);
  // Among equals the largest overlap is taken, which is the true one as long as that is the nearest.
  EXPECT_NEAR(found.shift_x.value.um(), 2.0, 0.05);
  EXPECT_NEAR(found.shift_y.value.um(), 1.0, 0.05);
}

TEST(Registration, SaysThatNothingFixesTheShiftAlongStraightRidges) {
  const CosineRelief profile(9, 10, 40);
  HeightField ridges(square_grid(128, 1.0), Continuation::Mirrored);
  for (std::size_t k = 0; k < ridges.heights_um().size(); ++k) {
    ridges.heights_um()[k] = static_cast<float>(profile.height_um(static_cast<double>(k % 128), 0.0));
  }
  const Registration found = register_surfaces(ridges, ridges);
  EXPECT_NEAR(found.shift_x.value.um(), 0.0, 1e-4);  // ten times where Gauss–Newton stops
  EXPECT_TRUE(std::isinf(found.shift_y.standard_error.um()));
  EXPECT_TRUE(std::isfinite(found.shift_x.standard_error.um()));
  EXPECT_TRUE(std::isfinite(found.rotation.standard_error.degrees()));
}

TEST(Registration, RefusesASampleThatLiesTheOtherWayRound) {
  const Grid grid = square_grid(128, 1.0);
  const CosineRelief relief(10, 10, 40);
  const HeightField turned = relief.on(grid, grid, 3.0, -2.0, 175.0);
  EXPECT_THROW((void)register_surfaces(relief.on(grid), turned), MethodError);
  // … and finds it when allowed to look.
  RegistrationOptions options;
  options.largest_rotation = Angle::from_degrees(180.0);
  const Registration found = register_surfaces(relief.on(grid), turned, options);
  EXPECT_NEAR(found.rotation.value.degrees(), 175.0, 0.01);
  EXPECT_NEAR(found.shift_x.value.um(), 3.0, 0.01);
}

TEST(Registration, RefusesAnotherSampleAndSaysHowFarItCame) {
  const Grid grid = square_grid(96, 1.0);
  const HeightField design = CosineRelief(11, 10, 40).on(grid);
  for (std::uint64_t seed = 20; seed < 30; ++seed) {
    try {
      (void)register_surfaces(design, CosineRelief(seed, 10, 40).on(grid));
      ADD_FAILURE() << "registered with the unrelated surface " << seed;
    } catch (const MethodError& error) {
      EXPECT_NE(std::string(error.what()).find("correlation of heights of 0."), std::string::npos) << error.what();
    }
  }
}

TEST(Registration, RefusesWhatCannotBeRegisteredBeforeItStarts) {
  const HeightField flat(square_grid(64, 1.0), Continuation::Mirrored);
  const HeightField relief = CosineRelief(12, 10, 40).on(square_grid(64, 1.0));
  EXPECT_THROW((void)register_surfaces(flat, relief), MethodError);
  EXPECT_THROW((void)register_surfaces(crop(relief, 0, 0, 64, 10), relief), InvalidInput);
  HeightField unseen(square_grid(64, 1.0), Continuation::Mirrored);
  for (float& z : unseen.heights_um()) z = std::numeric_limits<float>::quiet_NaN();
  EXPECT_THROW((void)register_surfaces(relief, unseen), MethodError);
  RegistrationOptions options;
  options.largest_rotation = Angle::from_degrees(-1.0);
  EXPECT_THROW((void)register_surfaces(relief, relief, options), InvalidInput);
}

TEST(Registration, GivesTheSameBitsWithAnyNumberOfThreads) {
  const HeightField relief = CosineRelief(13, 10, 40).on(square_grid(128, 1.0));
  const HeightField measured = measure_virtually(relief, askew());
  const Registration many = register_surfaces(relief, measured);
  const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
  const Registration one = register_surfaces(relief, measured);
  EXPECT_EQ(one.shift_x.value, many.shift_x.value);
  EXPECT_EQ(one.rotation.value, many.rotation.value);
  EXPECT_EQ(one.shift_y.standard_error, many.shift_y.standard_error);
  EXPECT_EQ(one.runner_up, many.runner_up);
}

TEST(Registration, ReportsItsProgressAndCanBeStopped) {
  const HeightField relief = CosineRelief(14, 10, 40).on(square_grid(96, 1.0));
  double last = 0.0;
  (void)register_surfaces(relief, relief, {}, [&](const ProgressEvent& event) {
    EXPECT_GE(event.fraction, last);
    last = event.fraction;
  });
  EXPECT_EQ(last, 1.0);
  EXPECT_THROW((void)register_surfaces(relief, relief, {}, [](const ProgressEvent&) { throw Interrupted(); }),
               Interrupted);
}

}  // namespace
}  // namespace mezzotint
