#include "inverse/verification/judge_draws.h"

#include <cmath>

#include <gtest/gtest.h>

#include "forward/base/error.h"
#include "forward/base/random.h"

namespace mezzotint {
namespace {

constexpr DirectionGrid bins{16, 16};

DirectionMap bump(double x0, double width) {
  return average_over_bins(
      bins,
      [=](const Direction& d) {
        return 0.01 + std::exp(-0.5 * (std::pow(d.x() - x0, 2) + d.y() * d.y()) / (width * width));
      },
      4);
}

LobeTarget goal_of(const DirectionMap& soft) {
  LobeTarget goal = lobe_target(bins, Mirror{}, {{}}, {DirectionMap(bins.size(), 1.0)}, false);
  goal.maps.front() = soft;
  return goal;
}

using Draws = std::vector<std::vector<DirectionMap>>;

// Draws of a lobe: each bin with noise of its own, and all together a little wider or narrower.
Draws noisy_draws(const DirectionMap& lobe, std::size_t count, double noise, std::uint64_t seed) {
  Draws draws;
  for (std::size_t draw = 0; draw < count; ++draw) {
    DirectionMap map = lobe;
    for (std::size_t k = 0; k < map.size(); ++k) {
      const double normal = RandomStream(seed, RandomPurpose::Test).normal4(k, static_cast<std::uint32_t>(draw))[0];
      map[k] = lobe[k] * std::max(0.0, 1.0 + noise * normal);
    }
    draws.push_back({map});
  }
  return draws;
}

double mean_of(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

// Against the truth: the distance of the mean of fresh draws from the lobe that they scatter about.
TEST(JudgeDraws, TheFloorIsWhatNoiseAloneGives) {
  const DirectionMap lobe = bump(0.1, 0.3);
  const LobeTarget goal = goal_of(lobe);
  constexpr std::size_t replicates = 40;
  for (const std::size_t count : {4U, 5U, 8U}) {
    for (const LobeDistance distance : all_lobe_distances) {
      std::vector<double> floors, values, errors;
      for (std::size_t r = 0; r < replicates; ++r) {
        const LobeJudgement judged = judge_draws(noisy_draws(lobe, count, 0.2, 1000 * count + r), goal);
        floors.push_back(judged.by(distance).floor.value);
        values.push_back(judged.by(distance).square.value);
        errors.push_back(judged.by(distance).floor.standard_error);
      }
      // Means of 40 with a scatter of some 12 % (200 bins; of moments, which have 6 degrees of freedom, of 80 %). The
      // Wasserstein distance is no quadratic one: its floor is 9 % high.
      const double slack = distance == LobeDistance::Moments       ? 0.5
                           : distance == LobeDistance::Wasserstein ? 0.15
                                                                   : 0.08;
      EXPECT_NEAR(mean_of(floors) / mean_of(values), 1.0, slack) << name_of(distance) << " of " << count;
      EXPECT_GT(mean_of(errors), 0.0);
    }
  }
}

// As many rays as a small mean lets expect, by inversion.
double poisson(double mean, double uniform) {
  double chance = std::exp(-mean), sum = chance, hits = 0.0;
  while (uniform > sum && hits < 1000.0) {
    hits += 1.0;
    chance *= mean / hits;
    sum += chance;
  }
  return hits;
}

// Flanks that a ray hits now and then: there a cube root is no quadratic distance, and neither is a logarithm.
TEST(JudgeDraws, TheFloorHoldsWhereBinsHaveFewHits) {
  DirectionMap lobe = bump(0.0, 0.15);
  for (double& value : lobe) value = std::max(0.0, value - 0.01);
  const LobeTarget goal = goal_of(lobe);
  for (const LobeDistance distance : all_lobe_distances) {
    std::vector<double> floors, values;
    for (std::size_t r = 0; r < 40; ++r) {
      Draws draws(4, {DirectionMap(bins.size())});
      for (std::size_t k = 0; k < bins.size(); ++k) {
        const auto uniform = RandomStream(300 + r, RandomPurpose::Test).uniform4(k);
        for (std::size_t draw = 0; draw < 4; ++draw)
          draws[draw][0][k] = poisson(200.0 * lobe[k], uniform[draw]) / 200.0;
      }
      const LobeJudgement judged = judge_draws(draws, goal);
      floors.push_back(judged.by(distance).floor.value);
      values.push_back(judged.by(distance).square.value);
    }
    // Found: 0.91, 0.71, 1.01, 0.97, 0.93.
    EXPECT_NEAR(mean_of(floors) / mean_of(values), 1.0, 0.4) << name_of(distance);
  }
}

TEST(JudgeDraws, StandardErrorsAreTheScatterOfRepeats) {
  const DirectionMap lobe = bump(0.0, 0.3);
  const LobeTarget goal = goal_of(bump(0.15, 0.25));
  for (const LobeDistance distance : all_lobe_distances) {
    std::vector<double> values, roots, squared_errors, squared_root_errors;
    for (std::size_t r = 0; r < 60; ++r) {
      const LobeJudgement judged = judge_draws(noisy_draws(lobe, 6, 0.3, 7000 + r), goal);
      const JudgedDistance& found = judged.by(distance);
      values.push_back(found.square.value);
      roots.push_back(found.root.value);
      squared_errors.push_back(std::pow(found.square.standard_error, 2));
      squared_root_errors.push_back(std::pow(found.root.standard_error, 2));
      EXPECT_NEAR(found.root.value, std::sqrt(found.square.value), 1e-12);
    }
    const auto variance = [](const std::vector<double>& v) {
      double sum = 0.0;
      for (const double value : v) sum += std::pow(value - mean_of(v), 2);
      return sum / static_cast<double>(v.size() - 1);
    };
    // A variance of 60 values is known to 18 %, its jackknife with 5 degrees of freedom each to 7 %: 3 σ of both.
    EXPECT_NEAR(mean_of(squared_errors) / variance(values), 1.0, 0.55) << name_of(distance);
    EXPECT_NEAR(mean_of(squared_root_errors) / variance(roots), 1.0, 0.55) << name_of(distance);
  }
}

TEST(JudgeDraws, EqualDrawsHaveNoNoise) {
  const DirectionMap lobe = bump(0.0, 0.3), wanted = bump(0.2, 0.2);
  const LobeJudgement judged = judge_draws(Draws(4, {lobe}), goal_of(wanted));
  const SmoothGrid grid(bins);
  for (const JudgedDistance& found : judged.distances) {
    EXPECT_NEAR(found.square.value, lobe_distance(found.distance, grid, lobe, wanted).value, 1e-12);
    EXPECT_LT(found.square.standard_error + found.floor.value, 1e-12);
  }
  EXPECT_LT(judged.reflected.front().standard_error, 1e-12);
}

TEST(JudgeDraws, MeansOverDirectionsOfTheLight) {
  const DirectionMap lobe = bump(0.0, 0.3);
  LobeTarget goal = goal_of(lobe);
  goal.incidences.push_back({});
  goal.maps.push_back(bump(0.2, 0.2));
  const SmoothGrid grid(bins);
  const LobeJudgement judged = judge_draws(Draws(4, {lobe, lobe}), goal);
  EXPECT_NEAR(judged.by(LobeDistance::L2).square.value,
              0.5 * lobe_distance(LobeDistance::L2, grid, lobe, goal.maps.back()).value, 1e-12);
}

TEST(JudgeDraws, RefusesFewDrawsAndMapsThatDoNotFit) {
  const DirectionMap lobe = bump(0.0, 0.3);
  const LobeTarget goal = goal_of(lobe);
  EXPECT_THROW((void)judge_draws(Draws(3, {lobe}), goal), InvalidInput);
  EXPECT_THROW((void)judge_draws(Draws(4, {lobe, lobe}), goal), InvalidInput);
  EXPECT_THROW((void)judge_draws(Draws(4, {DirectionMap(4, 1.0)}), goal), InvalidInput);
}

}  // namespace
}  // namespace mezzotint
