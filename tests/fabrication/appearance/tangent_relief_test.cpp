#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "fabrication/appearance/tangent_relief.h"
#include "forward/base/error.h"
#include "tests/fabrication/appearance/shapes.h"

namespace mezzotint {
namespace {

using Eigen::Vector3d;

std::shared_ptr<const FieldSurface> with_field(const PartMesh& mesh, const FieldGuide& guide, Length edge) {
  FieldSurface on{refined(smooth_surface(mesh, 40.0_deg), edge, 400000), {}};
  on.field = direction_field(on.surface, guide);
  return std::make_shared<const FieldSurface>(std::move(on));
}

struct Sample {
  double phi, z, height;
};
// Points of a cylinder's wall.
std::vector<Sample> wall_of(const FieldSurface& on, const SurfaceRelief& relief) {
  const ReliefProbe probe = relief.make_probe();
  std::vector<Sample> samples;
  for (std::uint32_t t = 0; t < on.surface.corners.size(); ++t) {
    if (std::abs(on.surface.normals[on.surface.nodes[t][0]].z()) > 0.5) continue;
    for (const Vector3d& w : {Vector3d(1, 1, 1), Vector3d(4, 1, 1), Vector3d(1, 1, 4)}) {
      const Vector3d weights = w / w.sum();
      Vector3d at = Vector3d::Zero();
      for (std::size_t k = 0; k < 3; ++k)
        at += weights[static_cast<Eigen::Index>(k)] * on.surface.vertices_mm[on.surface.corners[t].at(k)];
      samples.push_back({std::atan2(at.y(), at.x()), at.z(), probe({t, weights, at})});
    }
  }
  return samples;
}

// By how much ridges of that wavelength along `place` explain the heights: RMS of what is left over the RMS of the
// ridges, at the best of all phases.
template <class Place>
double misfit(const std::vector<Sample>& samples, double wavelength, double height, const Place& place) {
  double best = 1e9;
  for (int shift = 0; shift < 200; ++shift) {
    double squares = 0.0;
    for (const Sample& sample : samples) {
      const double turns = place(sample) / wavelength + shift / 200.0;
      squares += std::pow(sample.height - height * 2.0 * std::abs(turns - std::round(turns)), 2.0);
    }
    best = std::min(best, squares);
  }
  return std::sqrt(best / static_cast<double>(samples.size())) / (height / std::sqrt(12.0));
}

TEST(TangentRelief, RidgesAroundACylinderHaveTheWantedWavelength) {
  const double radius = 0.4, length = 0.12;
  const Ridges rings{.wavelength = 120.0_um, .height = 16.0_um};
  const auto on = with_field(cylinder(radius, 1.0, 64, 1), {.axis = {0, 0, 1}}, *longest_edge_for(rings));
  const TangentRelief relief = tangent_relief(rings, on);
  EXPECT_LT(relief.waves[0].wavelength_error, 0.05);  // with the caps, where the field has its singularities
  const auto wall = wall_of(*on, relief.relief);
  EXPECT_LT(misfit(wall, length, 16.0, [](const Sample& s) { return s.z; }), 0.02);
  EXPECT_GT(misfit(wall, 1.1 * length, 16.0, [](const Sample& s) { return s.z; }), 0.5);
}

// Flutes along a cylinder: a whole number of them goes around it, the nearest to the wanted wavelength.
TEST(TangentRelief, FlutesCloseAroundACylinder) {
  const double radius = 0.4;
  const Ridges flutes{.wavelength = 120.0_um, .direction = 90.0_deg, .height = 16.0_um};
  const auto on = with_field(cylinder(radius, 0.6, 128, 1), {.axis = {0, 0, 1}}, *longest_edge_for(flutes));
  const TangentRelief relief = tangent_relief(flutes, on);
  const double around = 2.0 * std::numbers::pi * radius;
  const double count = std::round(around / 0.12);
  const auto wall = wall_of(*on, relief.relief);
  EXPECT_LT(misfit(wall, around / count, 16.0, [&](const Sample& s) { return radius * s.phi; }), 0.05);
}

TEST(TangentRelief, ASphereTakesRidgesWithFewDefects) {
  const Ridges ridges{.wavelength = 60.0_um};
  const auto on = with_field(sphere(0.6, 3), {.axis = {0, 0, 1}, .smoothing = 0.1_mm}, *longest_edge_for(ridges));
  // Rings from pole to pole fit without defects, but for the poles.
  const PhaseFigures rings = tangent_relief(ridges, on).waves[0];
  EXPECT_LT(rings.wavelength_error, 0.03);
  EXPECT_LT(rings.defects, 10U);
  // Meridians grow apart: a new one begins wherever there is room for it, some 2πr/λ = 63 on either half.
  Ridges meridians = ridges;
  meridians.direction = 90.0_deg;
  const PhaseFigures apart = tangent_relief(meridians, on).waves[0];
  EXPECT_NEAR(static_cast<double>(apart.defects), 126.0, 18.0);
  EXPECT_LT(apart.wavelength_error, 0.2);
}

// Around half a turn a line cannot point the same way at all three corners.
bool turns_about(const FieldSurface& on, std::uint32_t triangle) {
  return std::ranges::any_of(on.field.singularities, [&](const auto& one) { return one.triangle == triangle; });
}

TEST(TangentRelief, IsTheSameFromBothSidesOfAnEdge) {
  const auto on = with_field(sphere(0.3, 3), {.kind = FieldGuide::Kind::None}, 100.0_um);
  const std::vector<Pattern> patterns = {Ridges{.wavelength = 60.0_um}, Sinusoid{80.0_um, 80.0_um},
                                         Noise{.scale = 40.0_um, .stretch = 3.0},
                                         LineIntegralConvolution{.scale = 20.0_um, .length = 100.0_um}};
  for (const Pattern& pattern : patterns) {
    const ReliefProbe probe = tangent_relief(pattern, on).relief.make_probe();
    double most = 0.0;
    for (std::uint32_t t = 0; t < on->surface.corners.size(); ++t) {
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t owner = on->surface.edges[on->surface.sides[t].at(k)].owner;
        if (owner == t || turns_about(*on, t) || turns_about(*on, owner)) continue;
        Vector3d here = Vector3d::Zero(), there = Vector3d::Zero(), at = Vector3d::Zero();
        for (const std::size_t i : {k, (k + 1) % 3}) {
          const std::uint32_t vertex = on->surface.corners[t].at(i);
          const double weight = i == k ? 0.3 : 0.7;
          here[static_cast<Eigen::Index>(i)] = weight;
          at += weight * on->surface.vertices_mm[vertex];
          for (std::size_t j = 0; j < 3; ++j)
            if (on->surface.corners[owner].at(j) == vertex) there[static_cast<Eigen::Index>(j)] = weight;
        }
        most = std::max(most, std::abs(probe({t, here, at}) - probe({owner, there, at})));
      }
    }
    EXPECT_LT(most, 0.02) << kind_name(pattern);  // µm
  }
}

// Hair along the axis of a cylinder: heights hardly change along it.
TEST(TangentRelief, HairRunsAlongTheField) {
  const Pattern hair =
      LineIntegralConvolution{.scale = 30.0_um, .length = 300.0_um, .direction = 90.0_deg, .height = 16.0_um};
  const auto on = with_field(cylinder(0.4, 1.0, 64, 1), {.axis = {0, 0, 1}}, 200.0_um);
  const ReliefProbe probe = tangent_relief(hair, on).relief.make_probe();
  double along = 0.0, across = 0.0;
  for (std::uint32_t t = 0; t < on->surface.corners.size(); ++t) {
    if (std::abs(on->surface.normals[on->surface.nodes[t][0]].z()) > 0.5) continue;
    const Vector3d weights(0.4, 0.3, 0.3);
    Vector3d at = Vector3d::Zero();
    for (std::size_t k = 0; k < 3; ++k)
      at += weights[static_cast<Eigen::Index>(k)] * on->surface.vertices_mm[on->surface.corners[t].at(k)];
    const Vector3d tangent = Vector3d(-at.y(), at.x(), 0.0).normalized();
    const double here = probe({t, weights, at});
    along += std::pow(probe({t, weights, at + 0.003 * Vector3d::UnitZ()}) - here, 2.0);
    across += std::pow(probe({t, weights, at + 0.003 * tangent}) - here, 2.0);
  }
  EXPECT_LT(25.0 * along, across);
}

TEST(TangentRelief, RefusesWhatASurfaceCannotHave) {
  const auto on = with_field(sphere(0.3, 2), {}, 200.0_um);
  EXPECT_THROW((void)tangent_relief(Ridges{.skew = 0.3}, on), InvalidInput);
  EXPECT_THROW((void)tangent_relief(PatternSum{{{Ridges{}}, {Noise{}}}}, on), InvalidInput);
  EXPECT_THROW((void)tangent_relief(LineIntegralConvolution{.singularities = {{}}}, on), InvalidInput);
}

}  // namespace
}  // namespace mezzotint
