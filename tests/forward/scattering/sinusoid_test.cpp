#include <gtest/gtest.h>
#include <algorithm>
#include <cmath>
#include <vector>

#include "forward/scattering/path_tracing.h"
#include "tests/forward/scattering/reliefs.h"

namespace mezzotint {
namespace {

// z = A sin kx along x, S = A·k; one period over 512 cells.
constexpr std::size_t columns = 512;

HeightField sinusoid(double steepest) {
  const double k = 2.0 * std::numbers::pi / static_cast<double>(columns);
  return test::relief(columns, 8, Continuation::Periodic,
                      [&](double c, double) { return steepest / k * std::sin(k * c); });
}

Bsdf normal_incidence(double steepest, NormalKind normals) {
  PathTracingOptions options;
  options.material = Mirror{};
  options.normals = normals;
  options.samples = 1U << 18;
  return trace_bsdf(sinusoid(steepest), options);
}

// Shares of the light in the columns of a map; the relief scatters along x only.
std::vector<double> column_shares(const Bsdf& bsdf) {
  const auto areas = projected_solid_angles(bsdf.grid);
  std::vector<double> shares(bsdf.grid.width);
  for (std::size_t k = 0; k < areas.size(); ++k) shares[k % bsdf.grid.width] += bsdf.reflection.mean[k] * areas[k];
  return shares;
}

// P(slope < q) of slopes with density 1/(π√(S² − q²)), and the slope that sends light to x = sin 2·atan q.
double slope_probability(double q, double steepest) {
  return 1.0 - std::acos(std::clamp(q / steepest, -1.0, 1.0)) / std::numbers::pi;
}
double slope_towards(double x) { return std::tan(0.5 * std::asin(x)); }

TEST(Sinusoid, SpreadsLightByItsSlopeDensity) {
  for (const double steepest : {0.1, 0.3}) {  // light meets it once
    const std::vector<double> shares = column_shares(normal_incidence(steepest, NormalKind::Interpolated));
    for (std::size_t column = 0; column < shares.size(); ++column) {
      const double left = 2.0 * static_cast<double>(column) / static_cast<double>(shares.size()) - 1.0;
      const double right = left + 2.0 / static_cast<double>(shares.size());
      const double expected =
          slope_probability(slope_towards(right), steepest) - slope_probability(slope_towards(left), steepest);
      // The ends of a bin fall anywhere in one of 128 strata along x, twice a period: an error of one stratum's
      // share at most, and jitter (÷ √12) in 32 batches of 64 rows of strata leaves 1e-4 of it. The rest is
      // the interpolation of normals between 512 samples, one part in 512 of a bin.
      EXPECT_NEAR(shares[column], expected, 1e-3) << "column " << column << ", S = " << steepest;
    }
  }
}

TEST(Sinusoid, HasItsCausticsAtTwiceTheSteepestAngle) {
  const double steepest = 0.3;
  for (const NormalKind normals : {NormalKind::Geometric, NormalKind::Interpolated}) {
    const Bsdf bsdf = normal_incidence(steepest, normals);
    const std::vector<double> shares = column_shares(bsdf);
    const double edge = std::sin(2.0 * std::atan(steepest));
    const std::size_t right = bsdf.grid.bin_of(edge, 0.0) % bsdf.grid.width;
    const std::size_t left = bsdf.grid.bin_of(-edge, 0.0) % bsdf.grid.width;
    for (std::size_t column = 0; column < shares.size(); ++column) {
      if (column < left || column > right) {
        EXPECT_EQ(shares[column], 0.0) << column;
      }
    }
    // A square-root singularity: the last bins hold the most light, within one bin.
    const auto brightest = static_cast<std::size_t>(std::max_element(shares.begin(), shares.end()) - shares.begin());
    EXPECT_LE(std::min(brightest - left, right - brightest), std::size_t{1});
  }
}

// Second moments of the map's directions; the axis of the greatest spread.
double spread_axis_deg(const Bsdf& bsdf) {
  const auto areas = projected_solid_angles(bsdf.grid);
  double xx = 0.0, yy = 0.0, xy = 0.0;
  for (std::size_t k = 0; k < areas.size(); ++k) {
    const double weight = bsdf.reflection.mean[k] * areas[k];
    const double x = (static_cast<double>(k % bsdf.grid.width) + 0.5) * 2.0 / static_cast<double>(bsdf.grid.width) - 1;
    const double y = (static_cast<double>(k / bsdf.grid.width) + 0.5) * 2.0 / static_cast<double>(bsdf.grid.height) - 1;
    xx += weight * x * x;
    yy += weight * y * y;
    xy += weight * x * y;
  }
  return 0.5 * std::atan2(2.0 * xy, xx - yy) * 180.0 / std::numbers::pi;
}

TEST(Sinusoid, WithItsWaveVectorAt30DegreesSpreadsLightAlong30Degrees) {
  // One period over 128 cells in x and over 64 cells of √3·2 in y: k_y/k_x = 1/√3. The patch that is no tile ends
  // anywhere; copies of it would add a lobe at −30°, if rays began there.
  const double pitch_y_um = 2.0 * std::sqrt(3.0), k = 2.0 * std::numbers::pi / 128.0;
  const auto wave = [&](double c, double r) {
    return 0.3 / k * std::cos(30.0 * std::numbers::pi / 180.0) * std::sin(k * (c + 2.0 * r));
  };
  const HeightField tile = test::relief(128, 64, Continuation::Periodic, wave, pitch_y_um);
  const HeightField patch = test::relief(150, 91, Continuation::Mirrored, wave, pitch_y_um);
  for (const HeightField* field : {&tile, &patch}) {
    for (const double phi_deg : {0.0, 75.0}) {
      PathTracingOptions options;
      options.incidence = {Angle{}, Angle::from_degrees(phi_deg)};
      options.material = Mirror{};
      options.samples = 1U << 16;
      // Bins of 1/32 over a lobe of ±0.55 turn the axis by some tenths of a degree.
      EXPECT_NEAR(spread_axis_deg(trace_bsdf(*field, options)), 30.0, 1.0);
    }
  }
}

}  // namespace
}  // namespace mezzotint
