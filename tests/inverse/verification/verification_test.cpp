#include "inverse/verification/verification.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "forward/base/error.h"
#include "forward/optics/microfacet.h"
#include "forward/pattern/pattern.h"

namespace mezzotint {
namespace {

constexpr DirectionGrid bins{32, 32};
const std::vector<DirectionAngles> oblique = {{20.0_deg, 30.0_deg}};

PrinterProfile without_ground() {
  PrinterProfile printer;
  printer.ground_amplitude = Length{};
  return printer;
}

GrayImage flat_image(std::size_t side, float gray) { return {side, side, std::vector<float>(side * side, gray)}; }

// All light in the bin of the mirror direction.
LobeTarget mirror_goal(const Material& material, const std::vector<DirectionAngles>& incidences) {
  std::vector<DirectionMap> maps;
  for (const DirectionAngles& incidence : incidences) {
    const Direction light = to_direction(incidence);
    maps.emplace_back(bins.size(), 0.0);
    const std::size_t bin = bins.bin_of(-light.x(), -light.y());
    maps.back()[bin] = reflectance(material, light.z()) / projected_solid_angles(bins)[bin];
  }
  return lobe_target(bins, material, incidences, maps, false);
}

// Noise that is drawn anew for every seed, lifted to the top of the layer.
GrayOfSeed noise_of_seed(std::size_t pixels, Length height, const PrinterProfile& printer) {
  return [=](std::uint64_t seed) {
    const PatternInstance instance = draw_instance(Noise{.scale = 60.0_um, .height = height}, seed);
    HeightField heights =
        synthesize(instance.pattern, {pixels, pixels, printer.pixel_pitch, printer.pixel_pitch}, instance.origin);
    for (float& z : heights.heights_um()) z += static_cast<float>((reachable_height(printer) - height).um());
    return expose(heights, printer).image;
  };
}

VerificationOptions quick() { return {.draw = {.subsamples = 4}, .seeds = {11, 12, 13, 14}, .samples = 1U << 15}; }

TEST(Verification, AFlatPrintIsAMirror) {
  for (const Material& material : {Material{Dielectric{1.5}}, Material{Mirror{}}}) {
    const LobeTarget goal = mirror_goal(material, {{20.0_deg, 30.0_deg}, {50.0_deg, -70.0_deg}});
    VerificationOptions options = quick();
    options.draw.surround = Surround::Repeat;
    const Verification found =
        verify_design([](std::uint64_t) { return flat_image(16, 0.7F); }, without_ground(), goal, options);
    for (const LobeJudgement* judgement : {&found.traced, &found.by_slope}) {
      for (const JudgedDistance& judged : judgement->distances) {
        // Light that goes into a flat medium does not come back: the map is exact but for the floats of heights.
        EXPECT_LT(judged.square.value, 1e-9) << root_name_of(judged.distance);
        EXPECT_LT(judged.floor.value, 1e-9) << root_name_of(judged.distance);
      }
    }
    for (std::size_t light = 0; light < 2; ++light) {
      EXPECT_NEAR(found.energy[light].reflected.value, found.wanted_light[light], 1e-6);
      EXPECT_NEAR(found.wanted_light[light], reflectance(material, std::cos(goal.incidences[light].theta.radians())),
                  1e-12);
    }
    for (const SlopeCovariance& draw : found.slope_covariances) EXPECT_LT(draw.xx + draw.yy, 1e-9);
  }
}

// The closed form of what a gentle noise shows: a Beckmann lobe of its own slopes.
TEST(Verification, AGentleNoiseShowsNearlyABeckmannLobeOfItsOwnSlopes) {
  const PrinterProfile printer;
  VerificationOptions options = quick();
  options.samples = 1U << 17;
  const GrayOfSeed noise = noise_of_seed(96, 16.0_um, printer);
  double variance = 0.0;
  for (const std::uint64_t seed : options.seeds) {
    const SlopeCovariance c = slope_covariance(print_draw(noise(seed), printer, options.draw, seed));
    variance += 0.5 * (c.xx + c.yy) / 4.0;
  }
  const double alpha = std::sqrt(2.0 * variance);
  const DirectionMap lobe = reflection_map(BeckmannLobe{alpha, alpha, {}}, Dielectric{1.5}, oblique.front(), bins);
  const LobeTarget goal = lobe_target(bins, Dielectric{1.5}, oblique, {lobe}, false);
  const Verification found = verify_design(noise, printer, goal, options);
  // One octave of noise has a slope kurtosis of 3.4: its lobe is 0.1 from a Beckmann one (docs/physics.md).
  EXPECT_NEAR(found.traced.by(LobeDistance::L2).root.value, 0.10, 0.05);
  EXPECT_LT(found.traced.by(LobeDistance::Wasserstein).root.value, 0.12);
  EXPECT_NEAR(found.energy[0].reflected.value, found.wanted_light[0], 0.03 * found.wanted_light[0]);
  // What tracing changes here is little: most of the difference is the same for both.
  for (const JudgedDistance& judged : found.traced.distances) {
    EXPECT_NEAR(judged.root.value, found.by_slope.by(judged.distance).root.value, 0.03) << name_of(judged.distance);
    EXPECT_GT(judged.floor.value, 0.0);
  }
}

TEST(Verification, AgainstItsOwnSlopesANoiseIsAtTheFloorOfItsDraws) {
  const PrinterProfile printer;
  VerificationOptions options = quick();
  options.samples = 1U << 17;
  const GrayOfSeed noise = noise_of_seed(64, 8.0_um, printer);
  // The goal: the mean lobe by slopes of 24 draws that the verification does not meet.
  LobeTarget goal = mirror_goal(Dielectric{1.5}, oblique);
  DirectionMap& mean = goal.maps.front();
  std::ranges::fill(mean, 0.0);
  for (std::uint64_t seed = 100; seed < 124; ++seed) {
    const DirectionMap map = slope_lobes(print_draw(noise(seed), printer, options.draw, seed), goal).front();
    for (std::size_t k = 0; k < map.size(); ++k) mean[k] += map[k] / 24.0;
  }
  const Verification found = verify_design(noise, printer, goal, options);
  for (const LobeDistance distance : {LobeDistance::L2, LobeDistance::CubeRoot, LobeDistance::Moments}) {
    const JudgedDistance& judged = found.traced.by(distance);
    // The goal has a sixth of the noise itself; 3 degrees of freedom leave the floor's own factor of about 2.
    EXPECT_LT(judged.square.value, 4.0 * judged.floor.value) << name_of(distance);
    EXPECT_GT(judged.square.value, 0.25 * judged.floor.value) << name_of(distance);
  }
}

TEST(Verification, WhiteFurnace) {
  const LobeTarget goal = mirror_goal(Mirror{}, {{0.0_deg, 0.0_deg}, {60.0_deg, 0.0_deg}});
  VerificationOptions options = quick();
  options.draw.surround = Surround::Repeat;
  const GrayOfSeed waves = [](std::uint64_t) {
    GrayImage image = flat_image(32, 0.0F);
    for (std::size_t i = 0; i < image.values.size(); ++i)
      image.values[i] =
          0.55F + 0.4F * static_cast<float>(std::sin(2.0 * std::numbers::pi * static_cast<double>(i % 8) / 8.0));
    return image;
  };
  const Verification found = verify_design(waves, {}, goal, options);
  for (std::size_t light = 0; light < 2; ++light) {
    // A lossless surface sends back all that comes, whatever the relief; to the rays of the bounce cap.
    EXPECT_NEAR(found.energy[light].reflected.value, 1.0, 1e-3);
    EXPECT_NEAR(found.traced.reflected[light].value, 1.0, 1e-3);
  }
  // Slopes alone do not know that light meets the relief again, nor what lies in shadow.
  EXPECT_GT(std::abs(found.by_slope.reflected[1].value - 1.0), 0.01);
}

TEST(Verification, EnergyAddsUp) {
  const Verification found =
      verify_design(noise_of_seed(32, 17.0_um, {}), {}, mirror_goal(Dielectric{1.5}, oblique), quick());
  const EnergyAudit& energy = found.energy.front();
  EXPECT_NEAR(energy.reflected.value + energy.transmitted.value + energy.absorbed.value + energy.left_sideways.value +
                  energy.cut_off.value,
              1.0, 1e-9);
  EXPECT_GT(energy.reflected.standard_error, 0.0);
}

TEST(Verification, GivesTheSameBitsWithAnyNumberOfThreads) {
  const GrayOfSeed noise = noise_of_seed(32, 12.0_um, {});
  const LobeTarget goal = mirror_goal(Dielectric{1.5}, oblique);
  const Verification many = verify_design(noise, {}, goal, quick());
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  const Verification single = verify_design(noise, {}, goal, quick());
  EXPECT_EQ(single.traced.lobes.front().mean, many.traced.lobes.front().mean);
  EXPECT_EQ(single.by_slope.lobes.front().mean, many.by_slope.lobes.front().mean);
}

TEST(Verification, StopsWhenItIsAsked) {
  int calls = 0;
  const Progress stop = [&](const ProgressEvent&) {
    if (++calls == 3) throw Interrupted();
  };
  EXPECT_THROW((void)verify_design([](std::uint64_t) { return flat_image(16, 0.7F); }, {},
                                   mirror_goal(Mirror{}, oblique), quick(), stop),
               Interrupted);
}

TEST(Verification, RefusesFewOrRepeatedSeeds) {
  const GrayOfSeed flat = [](std::uint64_t) { return flat_image(16, 0.7F); };
  VerificationOptions options = quick();
  options.seeds = {1, 2, 3};
  EXPECT_THROW((void)verify_design(flat, {}, mirror_goal(Mirror{}, oblique), options), InvalidInput);
  options.seeds = {1, 2, 3, 1};
  EXPECT_THROW((void)verify_design(flat, {}, mirror_goal(Mirror{}, oblique), options), InvalidInput);
  LobeTarget none = mirror_goal(Mirror{}, oblique);
  none.incidences.clear();
  none.maps.clear();
  EXPECT_THROW((void)verify_design(flat, {}, none, quick()), InvalidInput);
}

}  // namespace
}  // namespace mezzotint
