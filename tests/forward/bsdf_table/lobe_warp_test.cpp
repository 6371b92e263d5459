#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "forward/base/random.h"
#include "forward/bsdf_table/lobe_warp.h"
#include "tests/forward/bsdf_table/beckmann_table.h"

namespace mezzotint {
namespace {

using Eigen::Vector2d;
using test::degrees;

struct Pair {
  LobeChart from, to;
};

// Reflection and transmission, from the normal to grazing, across azimuths.
std::vector<Pair> pairs() {
  std::vector<Pair> pairs;
  const DirectionAngles lights[] = {degrees(0, 0), degrees(30, 20), degrees(60, -50), degrees(75, 130)};
  for (const DirectionAngles& a : lights) {
    for (const DirectionAngles& b : lights) {
      const Direction from = to_direction(a), to = to_direction(b);
      pairs.push_back({LobeChart::of_reflection(from), LobeChart::of_reflection(to)});
      pairs.push_back({LobeChart::of_transmission(from, 1.5), LobeChart::of_transmission(to, 1.5)});
    }
  }
  return pairs;
}

Vector2d disc_point(std::uint64_t index, double largest_radius = 1.0) {
  const auto u = RandomStream(1, RandomPurpose::Test).uniform4(index);
  const double radius = largest_radius * std::sqrt(u[0]), angle = 2.0 * std::numbers::pi * u[1];
  return {radius * std::cos(angle), radius * std::sin(angle)};
}

TEST(LobeWarp, MakesTheRoundTrip) {
  for (const Pair& pair : pairs()) {
    const LobeWarp there(pair.from, pair.to), back(pair.to, pair.from);
    for (std::uint64_t k = 0; k < 200; ++k) {
      const Vector2d point = disc_point(k);
      const auto image = there(point);
      const auto again = back(image.point);
      EXPECT_LE(image.point.norm(), 1.0 + 1e-15);
      // The half vector has a root at the rim, which takes half of the digits.
      EXPECT_LT((again.point - point).norm(), 1e-7);
      EXPECT_NEAR(again.jacobian * image.jacobian, 1.0, 1e-5);
    }
  }
}

TEST(LobeWarp, TellsByHowMuchItStretchesAreas) {
  constexpr double step = 1e-6;
  for (const Pair& pair : pairs()) {
    const LobeWarp warp(pair.from, pair.to);
    for (std::uint64_t k = 0; k < 50; ++k) {
      const Vector2d point = disc_point(k, 0.95);
      const Vector2d dx = warp(point + Vector2d(step, 0)).point - warp(point - Vector2d(step, 0)).point;
      const Vector2d dy = warp(point + Vector2d(0, step)).point - warp(point - Vector2d(0, step)).point;
      const double area = (dx.x() * dy.y() - dx.y() * dy.x()) / (4.0 * step * step);
      // Rounding 1e-16 over a step of 1e-6; curvature times the step's square.
      EXPECT_NEAR(warp(point).jacobian / area, 1.0, 2e-3);
    }
  }
}

TEST(LobeWarp, TakesCentreToCentreAndHorizonToHorizon) {
  for (const Pair& pair : pairs()) {
    const LobeWarp warp(pair.from, pair.to);
    EXPECT_LT((warp(pair.from.centre()).point - pair.to.centre()).norm(), 1e-12);
    for (int k = 0; k < 16; ++k) {
      const double angle = 0.1 + 0.4 * k;
      const Vector2d rim(std::cos(angle), std::sin(angle));
      EXPECT_NEAR(warp(rim).point.norm(), 1.0, 1e-12);
      EXPECT_TRUE(std::isfinite(warp(rim).jacobian));
    }
  }
}

// Slopes far below those that send light to the horizon stay what they are, so the half vector does.
TEST(LobeWarp, KeepsTheFacetThatReflects) {
  const Direction from = to_direction(degrees(20, 10)), to = to_direction(degrees(35, 40));
  const LobeWarp warp(LobeChart::of_reflection(from), LobeChart::of_reflection(to));
  const auto slope_of = [](const Direction& light, const Vector2d& point) {
    const Direction half = light + Direction(point.x(), point.y(), std::sqrt(1.0 - point.squaredNorm()));
    return Vector2d(-half.head<2>() / half.z());
  };
  for (int k = 0; k < 16; ++k) {
    const Vector2d offset(0.2 * std::cos(0.4 * k), 0.2 * std::sin(0.4 * k));
    const Vector2d point = -from.head<2>() + offset;
    // Squeezed by half of (slope/reach)²: slopes of .11, and reaches of .52 or more that differ by a third.
    EXPECT_LT((slope_of(to, warp(point).point) - slope_of(from, point)).norm(), 0.03 * 0.11);
  }
}

}  // namespace
}  // namespace mezzotint
