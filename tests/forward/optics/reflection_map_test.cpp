#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "forward/base/error.h"
#include "forward/optics/microfacet.h"
#include "tests/forward/optics/quadrature.h"

namespace mezzotint {
namespace {

DirectionAngles degrees(double theta, double phi) { return {Angle::from_degrees(theta), Angle::from_degrees(phi)}; }

double albedo(const DirectionGrid& grid, const DirectionMap& map) {
  const std::vector<double> areas = projected_solid_angles(grid);
  double sum = 0.0;
  for (std::size_t k = 0; k < map.size(); ++k) sum += areas[k] * map[k];
  return sum;
}

// Single-scatter albedo, height-correlated Smith, F = 1: the project's list of reference values.
constexpr double incidences[] = {0.0, 30.0, 45.0, 60.0, 75.0};
constexpr struct {
  double alpha, albedo[5];
} published[] = {{0.2, {1.0000, .9999, .9969, .9724, .9141}},
                 {0.3, {.9997, .9914, .9672, .9233, .9025}},
                 {0.5, {.9430, .9028, .8746, .8694, .9053}},
                 {0.8, {.6419, .6919, .7490, .8183, .8988}},
                 {1.0, {.4616, .5480, .6509, .7666, .8808}}};
constexpr double published_tolerance = 1e-4;  // stated with the table

TEST(Brdf, HasThePublishedAlbedos) {
  for (const auto& [alpha, row] : published) {
    for (std::size_t i = 0; i < 5; ++i) {
      const Direction light = to_direction(degrees(incidences[i], 0));
      const BeckmannLobe lobe{alpha, alpha, {}};
      const double seen =
          test::integrate_hemisphere(160, [&](const Direction& o) { return brdf(lobe, Mirror{}, light, o); });
      EXPECT_NEAR(seen, row[i], published_tolerance) << alpha << " at " << incidences[i];
    }
  }
}

TEST(ReflectionMap, HasThePublishedAlbedos) {
  const DirectionGrid grid;
  for (const auto& [alpha, row] : published) {
    for (std::size_t i = 0; i < 5; ++i) {
      const DirectionMap map = reflection_map({alpha, alpha, {}}, Mirror{}, degrees(incidences[i], 25), grid);
      EXPECT_NEAR(albedo(grid, map), row[i], published_tolerance) << alpha << " at " << incidences[i];
    }
  }
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
      const double seen = albedo(grid, reflection_map({alpha, alpha, {}}, Mirror{}, light, grid));
      EXPECT_NEAR(seen, albedo_over_slopes(alpha, to_direction(light)), 1e-4) << alpha << " at " << theta;
    }
  }
}

TEST(ReflectionMap, HoldsAllLightAtGrazingIncidence) {
  const DirectionGrid grid;
  for (const double alpha : {0.1, 0.3, 1.0}) {
    for (const double theta : {80.0, 85.0, 88.0}) {
      const DirectionAngles light = degrees(theta, 200);
      const double seen = albedo(grid, reflection_map({alpha, alpha, {}}, Mirror{}, light, grid));
      // Midpoints of the reference lose 1e-4 at the horizon's edge.
      EXPECT_NEAR(seen, albedo_over_slopes(alpha, to_direction(light)), 3e-4) << alpha << " at " << theta;
    }
  }
}

TEST(ReflectionMap, PutsANarrowLobeIntoTheMirrorDirectionsBin) {
  const DirectionGrid grid;
  const Direction light = to_direction(degrees(41, 13));
  const DirectionMap map = reflection_map({1e-4, 1e-4, {}}, Dielectric{1.5}, degrees(41, 13), grid);
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

TEST(ReflectionMap, TurnsWithTheLobeAndTheLight) {
  const DirectionGrid grid{24, 24};
  const DirectionMap map = reflection_map({0.4, 0.1, Angle::from_degrees(20)}, Mirror{}, degrees(35, 50), grid);
  const DirectionMap turned = reflection_map({0.4, 0.1, Angle::from_degrees(110)}, Mirror{}, degrees(35, 140), grid);
  for (std::size_t row = 0; row < 24; ++row) {
    for (std::size_t column = 0; column < 24; ++column) {
      // (x, y) → (−y, x). Both converge on their own, to 1e-6 of a peak of about 10.
      EXPECT_NEAR(turned[column * 24 + (23 - row)], map[row * 24 + column], 1e-4) << column << ' ' << row;
    }
  }
}

TEST(ReflectionMap, SpreadsLightAlongTheSteeperSlopes) {
  const DirectionGrid grid;
  const DirectionMap map = reflection_map({0.3, 0.1, Angle::from_degrees(30)}, Mirror{}, degrees(0, 0), grid);
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
  EXPECT_THROW((void)reflection_map({0.0, 0.3, {}}, Mirror{}, degrees(0, 0), {}), InvalidInput);
  EXPECT_THROW((void)reflection_map(lobe, Mirror{}, degrees(0, 0), {5000, 64}), InvalidInput);
}

}  // namespace
}  // namespace mezzotint
