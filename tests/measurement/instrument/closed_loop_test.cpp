#include <cmath>
#include <filesystem>

#include <gtest/gtest.h>

#include "measurement/correction/fill.h"
#include "measurement/correction/gaussian_filter.h"
#include "measurement/correction/outliers.h"
#include "measurement/correction/plane.h"
#include "measurement/formats/surface_output.h"
#include "measurement/instrument/virtual_profilometer.h"
#include "measurement/texture/roughness.h"
#include "measurement/texture/spatial_parameters.h"
#include "tests/measurement/relief.h"

namespace mezzotint {
namespace {

/// Gaussian heights of Sq = 1 µm, as smooth as a Gaussian of 12 µm cut-off leaves them, on 256 × 256 µm.
HeightField smooth_relief() {
  const Grid grid{512, 512, Length::from_um(0.5), Length::from_um(0.5)};
  const HeightField white = test::white_noise(grid, 7);
  HeightField relief(grid, Continuation::Periodic, {white.heights_um().begin(), white.heights_um().end()});
  relief = s_filter(relief, 12.0_um);
  const auto scale = static_cast<float>(1.0 / area_roughness(relief).Sq.value);
  for (float& z : relief.heights_um()) z *= scale;
  return relief;
}

/// An instrument with all that instruments do.
VirtualProfilometer imperfect() {
  VirtualProfilometer instrument;
  instrument.pitch = 0.5_um;
  instrument.bandwidth = 4.0_um;
  instrument.aperture = 0.8;
  instrument.tilt_x = 0.01;
  instrument.tilt_y = -0.02;
  instrument.offset = 76.0123_mm;
  instrument.noise = 10.0_nm;
  instrument.missing_share = 0.005;
  instrument.hole_share = 0.01;
  instrument.hole_diameter = 4.0_um;
  instrument.outlier_share = 0.002;
  instrument.outlier_size = 20.0_um;
  return instrument;
}

SurfaceFile written_and_read(const HeightField& field) {
  const std::filesystem::path file = std::filesystem::path(testing::TempDir()) / "closed_loop.al3d";
  write_al3d(field, file);
  SurfaceFile read = read_surface(file);
  std::filesystem::remove(file);
  return read;
}

double mean_um(const HeightField& field) {
  double sum = 0.0, count = 0.0;
  for (const float z : field.heights_um()) {
    if (std::isnan(z)) continue;
    sum += static_cast<double>(z);
    count += 1.0;
  }
  return field.datum().um() + sum / count;
}

TEST(ClosedLoop, KeepsTheHeightOfTheStageThroughAFile) {
  const HeightField measured = measure_virtually(smooth_relief(), imperfect());
  const HeightField read = written_and_read(measured).field;
  ASSERT_EQ(read.grid(), measured.grid());
  EXPECT_EQ(read.missing_count(), measured.missing_count());
  // Heights within ±25 µm are floats of metres in the file and of micrometres here: 3e-6 µm at most, at 76 mm.
  for (std::size_t k = 0; k < read.grid().size(); ++k) {
    if (std::isnan(measured.heights_um()[k])) continue;
    const double there = measured.datum().um() + static_cast<double>(measured.heights_um()[k]);
    const double back = read.datum().um() + static_cast<double>(read.heights_um()[k]);
    EXPECT_NEAR(back, there, 5e-6);
  }
  EXPECT_NEAR(mean_um(read), mean_um(measured), 1e-6);
}

TEST(ClosedLoop, FindsTheRoughnessThatTheInstrumentCouldSee) {
  const HeightField relief = smooth_relief();
  const VirtualProfilometer instrument = imperfect();
  const HeightField scan = written_and_read(measure_virtually(relief, instrument)).field;
  const AreaRoughness raw = area_roughness(level(scan));
  const HeightField corrected = level(fill_missing(mask_local_outliers(scan, 12.0).field));
  const AreaRoughness found = area_roughness(corrected);
  const AreaRoughness truth = area_roughness(s_filter(relief, instrument.bandwidth));
  // Spikes of ±20 µm on a relief of 1 µm: without the correction Sq is a third too large, and Sdq eight times.
  EXPECT_GT(raw.Sq.value, 1.2 * truth.Sq.value);
  EXPECT_GT(raw.Sdq.value, 6.0 * truth.Sdq.value);
  // What is missing is filled smoothly, and steep flanks are missing more often: half of a per cent of Sq.
  EXPECT_NEAR(found.Sq.value, truth.Sq.value, 5e-3 * truth.Sq.value);
  EXPECT_NEAR(found.Sa.value, truth.Sa.value, 5e-3 * truth.Sa.value);
  EXPECT_NEAR(found.Sku.value, truth.Sku.value, 0.02);
  // White noise of σ at a spacing p adds slopes of √2 σ/p along each axis. The rest as above.
  const double expected_slope = std::hypot(truth.Sdq.value, 2.0 * instrument.noise / instrument.pitch);
  EXPECT_NEAR(found.Sdq.value, expected_slope, 5e-3 * expected_slope);
  const double sal = spatial_parameters(s_filter(relief, instrument.bandwidth)).Sal.value;
  EXPECT_NEAR(spatial_parameters(corrected).Sal.value, sal, 5e-3 * sal);
}

}  // namespace
}  // namespace mezzotint
