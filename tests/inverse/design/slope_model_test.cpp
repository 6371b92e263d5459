#include "inverse/design/slope_model.h"

#include <cmath>

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "forward/base/error.h"
#include "inverse/target/target.h"

namespace mezzotint {
namespace {

const std::vector<DirectionAngles> lights = {{20.0_deg, 0.0_deg}, {20.0_deg, 90.0_deg}};

LobeTarget any_target(const DirectionGrid& bins) {
  std::vector<DirectionMap> maps;
  for (const auto& light : lights)
    maps.push_back(reflection_map(BeckmannLobe{0.2, 0.1, {}}, Dielectric{1.5}, light, bins));
  return lobe_target(bins, Dielectric{1.5}, lights, maps, false);
}

// The draws' own reliefs by the printer's full path, on ground that is really there.
TEST(SlopeModel, HasTheCovarianceOfFinelySampledPrintsOnTheirGround) {
  const PrinterProfile printer;
  const std::vector<std::uint64_t> seeds = {1, 2, 3, 4};
  const Pattern pattern = Sinusoid{.wavelength_u = 80.0_um, .wavelength_v = 140.0_um, .direction = 30.0_deg};
  const SlopeCovariance model =
      SlopeModel(printer, {.pixels = 96, .subsamples = 3}, seeds, {}).shown(pattern).covariance;
  const PrintedTexture texture(printer, {.pixels = 96, .subsamples = 12}, seeds);
  const SlopeCovariance printed = mean_of(texture.slope_covariances(pattern, GrayLevels::Continuous)).mean;
  // Differences of heights 0.63 µm apart, and a ground of four draws: 1 % of the variance, 3e-5 of the slopes'.
  EXPECT_NEAR(model.xx, printed.xx, 0.01 * printed.xx);
  EXPECT_NEAR(model.yy, printed.yy, 0.01 * printed.yy);
  EXPECT_NEAR(model.xy, printed.xy, 0.01 * printed.xx);
}

TEST(SlopeModel, ShowsTheLightOfAFlatSurfaceWhateverThePattern) {
  const PrinterProfile printer;
  const LobeTarget target = any_target({48, 48});
  const SlopeModel model(printer, {.pixels = 64, .subsamples = 3}, {1, 2}, target);
  const auto shown = model.shown(Noise{.scale = 120.0_um});
  ASSERT_EQ(shown.maps.size(), 2U);
  for (std::size_t light = 0; light < 2; ++light) {
    double sum = 0.0;
    for (std::size_t k = 0; k < shown.maps[light].size(); ++k) sum += shown.maps[light][k] * target.grid.areas()[k];
    // Fresnel is flat near 20°: gentle slopes change the light by their square.
    EXPECT_NEAR(sum, reflectance(target.material, std::cos(lights[light].theta.radians())), 0.002);
  }
}

TEST(SlopeModel, GivesTheSameBitsWithOneThreadAndWithTwo) {
  const LobeTarget target = any_target({32, 32});
  std::vector<SlopeModel::Shown> shown;
  for (const int threads : {1, 2}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    shown.push_back(SlopeModel(PrinterProfile{}, {.pixels = 48, .subsamples = 2}, {1, 2, 3}, target).shown(Noise{}));
  }
  EXPECT_EQ(shown[0].covariance.xx, shown[1].covariance.xx);
  EXPECT_EQ(shown[0].maps, shown[1].maps);
}

TEST(SlopeModel, RefusesToHaveNoDraws) { EXPECT_THROW(SlopeModel(PrinterProfile{}, {}, {}, {}), InvalidInput); }

}  // namespace
}  // namespace mezzotint
