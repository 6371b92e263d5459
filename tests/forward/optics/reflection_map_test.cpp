#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "forward/base/error.h"
#include "forward/optics/microfacet.h"
#include "tests/forward/optics/quadrature.h"
#include "tests/reference/albedo_table.h"

namespace mezzotint {
namespace {

DirectionAngles degrees(double theta, double phi) { return {Angle::from_degrees(theta), Angle::from_degrees(phi)}; }

double albedo(const DirectionGrid& grid, const DirectionMap& map) {
  const std::vector<double> areas = projected_solid_angles(grid);
  double sum = 0.0;
  for (std::size_t k = 0; k < map.size(); ++k) sum += areas[k] * map[k];
  return sum;
}

template <class Lobe, std::size_t rows>
void expect_published_albedos(const std::array<test::AlbedoRow, rows>& table, double (*seen)(const Lobe&, double)) {
  for (const auto& [alpha, row] : table) {
    for (std::size_t i = 0; i < row.size(); ++i) {
      const double theta_deg = test::albedo_table_thetas_deg[i];
      EXPECT_NEAR(seen(Lobe{alpha, alpha, {}}, theta_deg), row[i], test::albedo_table_tolerance)
          << alpha << " at " << theta_deg;
    }
  }
}

template <class Lobe>
double albedo_by_quadrature(const Lobe& lobe, double theta_deg) {
  const Direction light = to_direction(degrees(theta_deg, 0));
  return test::integrate_hemisphere(160, [&](const Direction& o) { return brdf(lobe, Mirror{}, light, o); });
}

template <class Lobe>
double albedo_of_map(const Lobe& lobe, double theta_deg) {
  return albedo({}, reflection_map(lobe, Mirror{}, degrees(theta_deg, 25), {}));
}

TEST(Brdf, HasThePublishedAlbedos) {
  expect_published_albedos<BeckmannLobe>(test::beckmann_albedos, albedo_by_quadrature);
  expect_published_albedos<GgxLobe>(test::ggx_albedos, albedo_by_quadrature);
}

TEST(ReflectionMap, HasThePublishedAlbedos) {
  expect_published_albedos<BeckmannLobe>(test::beckmann_albedos, albedo_of_map);
  expect_published_albedos<GgxLobe>(test::ggx_albedos, albedo_of_map);
}

TEST(ReflectionMap, HasTheClosedFormOfGgxAtTheNormal) {
  // α = 1 at 0°: ∫ of 1/(1 + Λ_o) over the slopes that send light up is 1 − ln 2. The map is good to 1e-4.
  EXPECT_NEAR(albedo_of_map(GgxLobe{1.0, 1.0, {}}, 0.0), 1.0 - std::numbers::ln2, 1e-4);
  EXPECT_NEAR(albedo_by_quadrature(GgxLobe{1.0, 1.0, {}}, 0.0), 1.0 - std::numbers::ln2, 1e-9);
}

// The albedo over slopes in place of directions: every facet that faces the light sends its share to one
// direction. It resolves a lobe of any width, and the grazing ones.
double albedo_over_slopes(double alpha, const Direction& light) {
  const BeckmannLobe lobe{alpha, alpha, {}};
  constexpr int steps = 300;
  constexpr double reach = 5.0, step = 2.0 * reach / steps;
  const double lambda = smith_lambda(lobe, light);
  double sum = 0.0;
  for (int j = 0; j < steps; ++j) {
    for (int i = 0; i < steps; ++i) {
      const double u = -reach + step * (i + 0.5), v = -reach + step * (j + 0.5);
      const Direction facet = Direction(-alpha * u, -alpha * v, 1.0).normalized();
      const double facing = facet.dot(light);
      const Direction sent = 2.0 * facing * facet - light;
      if (facing <= 0.0 || sent.z() <= 0.0) continue;
      const double visible = 1.0 / (1.0 + lambda + smith_lambda(lobe, sent));
      sum += std::exp(-u * u - v * v) * facing / (facet.z() * light.z()) * visible;
    }
  }
  return sum * step * step / std::numbers::pi;
}

TEST(ReflectionMap, HoldsAllLightOfLobesThatAreNarrowAgainstABin) {
  const DirectionGrid grid;
  for (const double alpha : {1e-4, 1e-3, 0.01, 0.03}) {
    for (const double theta : {0.0, 33.0, 60.0, 80.0, 85.0}) {
      const DirectionAngles light = degrees(theta, 20);
      const double seen = albedo(grid, reflection_map(BeckmannLobe{alpha, alpha, {}}, Mirror{}, light, grid));
      EXPECT_NEAR(seen, albedo_over_slopes(alpha, to_direction(light)), 1e-4) << alpha << " at " << theta;
    }
  }
}

TEST(ReflectionMap, HoldsAllLightAtGrazingIncidence) {
  const DirectionGrid grid;
  for (const double alpha : {0.1, 0.3, 1.0}) {
    for (const double theta : {80.0, 85.0, 88.0}) {
      const DirectionAngles light = degrees(theta, 200);
      const double seen = albedo(grid, reflection_map(BeckmannLobe{alpha, alpha, {}}, Mirror{}, light, grid));
      // Midpoints of the reference lose 1e-4 at the horizon's edge.
      EXPECT_NEAR(seen, albedo_over_slopes(alpha, to_direction(light)), 3e-4) << alpha << " at " << theta;
    }
  }
}

TEST(ReflectionMap, PutsANarrowLobeIntoTheMirrorDirectionsBin) {
  const DirectionGrid grid;
  const Direction light = to_direction(degrees(41, 13));
  const DirectionMap map = reflection_map(BeckmannLobe{1e-4, 1e-4, {}}, Dielectric{1.5}, degrees(41, 13), grid);
  const std::size_t bin = grid.bin_of(-light.x(), -light.y());
  EXPECT_EQ(std::max_element(map.begin(), map.end()) - map.begin(), static_cast<std::ptrdiff_t>(bin));
  // All of it, by Fresnel's share; the lobe's width adds α² times the curvature of Fresnel.
  EXPECT_NEAR(map[bin] * projected_solid_angles(grid)[bin], dielectric_fresnel(light.z(), 1.5).reflectance, 1e-6);
}

TEST(ReflectionMap, IsTheMeanOfTheBrdfOverEveryBin) {
  const BeckmannLobe lobe{0.4, 0.15, Angle::from_degrees(30)};
  for (const DirectionGrid grid : {DirectionGrid{16, 16}, DirectionGrid{15, 9}}) {
    const DirectionAngles angles = degrees(50, 70);
    const Direction light = to_direction(angles);
    const DirectionMap map = reflection_map(lobe, Dielectric{1.5}, angles, grid);
    const DirectionMap sampled = average_over_bins(
        grid, [&](const Direction& viewer) { return brdf(lobe, Dielectric{1.5}, light, viewer); }, 48);
    // 48 midpoints over a bin of up to 1.4 lobe widths: (1.4/48)²/24 times the peak's curvature of about 6.
    const double peak = *std::max_element(map.begin(), map.end());
    for (std::size_t k = 0; k < map.size(); ++k) EXPECT_NEAR(map[k], sampled[k], 2e-3 * peak) << k;
    EXPECT_LT(relative_l2(grid, map, sampled), 5e-4);
  }
}

TEST(ReflectionMap, OfGgxIsTheMeanOfTheBrdfOverEveryBin) {
  const GgxLobe lobe{0.4, 0.15, Angle::from_degrees(30)};
  const DirectionGrid grid{16, 16};
  const DirectionAngles angles = degrees(50, 70);
  const Direction light = to_direction(angles);
  const DirectionMap map = reflection_map(lobe, Dielectric{1.5}, angles, grid);
  const DirectionMap sampled = average_over_bins(
      grid, [&](const Direction& viewer) { return brdf(lobe, Dielectric{1.5}, light, viewer); }, 48);
  // As above; the peak's curvature is twice that of Beckmann's.
  const double peak = *std::max_element(map.begin(), map.end());
  for (std::size_t k = 0; k < map.size(); ++k) EXPECT_NEAR(map[k], sampled[k], 4e-3 * peak) << k;
  EXPECT_LT(relative_l2(grid, map, sampled), 1e-3);
}

TEST(ReflectionMap, OfGgxReachesTheHorizonEvenWhereTheLobeIsNarrow) {
  // Its tails: of a lobe of α = 0.01 straight from above, 1/(1 + r²) of the slopes lie beyond r = 1/α, which send
  // light to the horizon; all others come back but for 1/(1 + Λ_o), Λ of the order α².
  EXPECT_NEAR(albedo_of_map(GgxLobe{0.01, 0.01, {}}, 0.0), 1.0 - 1e-4, 1.5e-4);
}

TEST(ReflectionMap, TurnsWithTheLobeAndTheLight) {
  const DirectionGrid grid{24, 24};
  const DirectionMap map =
      reflection_map(BeckmannLobe{0.4, 0.1, Angle::from_degrees(20)}, Mirror{}, degrees(35, 50), grid);
  const DirectionMap turned =
      reflection_map(BeckmannLobe{0.4, 0.1, Angle::from_degrees(110)}, Mirror{}, degrees(35, 140), grid);
  for (std::size_t row = 0; row < 24; ++row) {
    for (std::size_t column = 0; column < 24; ++column) {
      // (x, y) → (−y, x). Both converge on their own, to 1e-6 of a peak of about 10.
      EXPECT_NEAR(turned[column * 24 + (23 - row)], map[row * 24 + column], 1e-4) << column << ' ' << row;
    }
  }
}

TEST(ReflectionMap, SpreadsLightAlongTheSteeperSlopes) {
  const DirectionGrid grid;
  const DirectionMap map =
      reflection_map(BeckmannLobe{0.3, 0.1, Angle::from_degrees(30)}, Mirror{}, degrees(0, 0), grid);
  const auto at = [&](double phi) {
    const Direction direction = to_direction(degrees(25, phi));
    return map[grid.bin_of(direction.x(), direction.y())];
  };
  EXPECT_GT(at(30), 10.0 * at(-30));
  EXPECT_GT(at(210), 10.0 * at(120));
}

TEST(ReflectionMap, RefusesALightThatIsNotAboveTheHorizon) {
  const BeckmannLobe lobe;
  EXPECT_THROW((void)reflection_map(lobe, Mirror{}, degrees(90, 0), {}), InvalidInput);
  EXPECT_THROW((void)reflection_map(lobe, Mirror{}, degrees(-1, 0), {}), InvalidInput);
  EXPECT_THROW((void)reflection_map(lobe, Mirror{}, degrees(std::nan(""), 0), {}), InvalidInput);
  EXPECT_THROW((void)reflection_map(BeckmannLobe{0.0, 0.3, {}}, Mirror{}, degrees(0, 0), {}), InvalidInput);
  EXPECT_THROW((void)reflection_map(lobe, Mirror{}, degrees(0, 0), {5000, 64}), InvalidInput);
}

}  // namespace
}  // namespace mezzotint
