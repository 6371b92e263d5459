#include "forward/process/depth_cure.h"

#include <cmath>

#include <gtest/gtest.h>

#include "forward/base/error.h"
#include "forward/base/random.h"
#include "forward/process/printed_relief.h"
#include "forward/process/stack_process.h"

namespace mezzotint {
namespace {

// print_layer's: float light, and a logarithm to 1e-7.
constexpr double height_tolerance_um = 2e-5;

std::vector<float> random_grays(std::size_t count, std::uint64_t seed, double low = 0.0, double high = 1.0) {
  std::vector<float> values;
  const RandomStream stream(seed, RandomPurpose::Test);
  for (std::size_t i = 0; i < count; ++i)
    values.push_back(static_cast<float>(low + (high - low) * stream.uniform4(i)[0]));
  return values;
}

PrinterProfile sharp_profile() {
  PrinterProfile profile;
  profile.spread.width = Length{};
  return profile;
}

// One column of a stack, lowest layer first, by the definition: doses of all layers above summed at many depths.
// Height of the solid in each layer, counted in `steps` slabs of it.
std::vector<double> counted_thickness_um(const CureCurve& cure, const std::vector<StackLayer>& layers,
                                         const std::vector<float>& grays, int steps) {
  std::vector<double> tops_um, thickness_um;
  double face_um = 0.0;
  for (const StackLayer& layer : layers) tops_um.push_back(face_um += layer.thickness.um());
  const double critical = std::exp(-(cure.alpha / cure.beta));
  for (std::size_t j = 0; j < layers.size(); ++j) {
    const double step_um = layers[j].thickness.um() / steps;
    int solid = 0;
    for (int s = 0; s < steps; ++s) {
      const double z_um = tops_um[j] - (s + 0.5) * step_um;
      double dose = 0.0;
      for (std::size_t k = j; k < layers.size(); ++k)
        dose += layers[k].exposure * (double(grays[k]) - cure.gamma) * std::exp((z_um - tops_um[k]) / cure.beta.um());
      solid += dose >= critical ? 1 : 0;
    }
    thickness_um.push_back(solid * step_um);
  }
  return thickness_um;
}

std::vector<float> column_thickness_um(const CureCurve& cure, const std::vector<StackLayer>& layers,
                                       const std::vector<float>& grays) {
  DepthDose dose(cure, 1);
  std::vector<float> cured(layers.size());
  for (std::size_t i = layers.size(); i-- > 0;) {
    dose.descend(layers[i], {&grays[i], 1});
    dose.cured_um({&cured[i], 1});
  }
  return cured;
}

TEST(DepthCure, IsThePatchsModelForOneLayer) {
  const PrinterProfile profile;
  const GrayImage image{24, 18, random_grays(24 * 18, 1)};
  const ProcessOptions options{3, Surround::Dark};
  const HeightField relief = print_layer(image, profile, options);
  const StackProcess process(24, 18, profile, options);
  const std::vector<LitLayer> stack{{image, {profile.layer, 1.0}}};
  const auto cured_um = process.print(stack);
  ASSERT_EQ(cured_um[0].size(), relief.grid().size());
  for (std::size_t i = 0; i < cured_um[0].size(); ++i) EXPECT_EQ(cured_um[0][i], relief.heights_um()[i]) << i;
  const CureCurve cure;
  for (float gray = 0.0F; gray <= 1.0F; gray += 1.0F / 64.0F) {
    const double expected = std::min(18.0, gray_to_height(cure, static_cast<double>(gray)).um());
    EXPECT_NEAR(column_thickness_um(cure, {{18.0_um, 1.0}}, {gray})[0], expected, height_tolerance_um);
  }
}

TEST(DepthCure, PassesTheSlidesShareThroughALayer) {
  EXPECT_NEAR(passing_share(18.0_um, {}), 0.172, 5e-4);  // e^(−18/10.24), 17 % in the project's notes
}

TEST(DepthCure, AddsTheDosesOfTwoFullLayers) {
  const CureCurve cure;
  DepthDose dose(cure, 1);
  const float full = 1.0F;
  dose.descend({18.0_um, 1.0}, {&full, 1});
  EXPECT_FLOAT_EQ(dose.dose()[0], 1.01F);
  dose.descend({18.0_um, 1.0}, {&full, 1});
  EXPECT_NEAR(dose.dose()[0], 1.01 * (1.0 + std::exp(-18.0 / 10.24)), 1e-6);
  float reach = 0.0F;
  dose.reach_um({&reach, 1});
  EXPECT_NEAR(reach, 17.71 + 10.24 * std::log(1.01 * (1.0 + std::exp(-18.0 / 10.24))), height_tolerance_um);
  float cured = 0.0F;
  dose.cured_um({&cured, 1});
  EXPECT_EQ(cured, 18.0F);  // alone it would be 17.81
}

// Without stray light an overhang of n full layers over dark ones is α + β ln((1 − q^n)/(1 − q)) thicker than its
// lowest layer's upper face is high: the geometric sum of the doses there, cured down through every border.
TEST(DepthCure, GrowsDownBelowAnOverhangByTheLogOfTheSummedDose) {
  CureCurve cure;
  cure.gamma = 0.0;
  cure.alpha = 22.0_um;  // full gray cures through its layer
  const double q = std::exp(-18.0 / 10.24);
  for (const int above : {1, 2, 5}) {
    std::vector<StackLayer> layers(6 + above, {18.0_um, 1.0});
    std::vector<float> grays(6 + above, 0.0F);
    std::fill(grays.begin() + 6, grays.end(), 1.0F);
    const auto cured = column_thickness_um(cure, layers, grays);
    const auto solid = solid_intervals(layers, cured);
    const double depth = 22.0 + 10.24 * std::log((1.0 - std::pow(q, above)) / (1.0 - q));
    const double upper_of_lowest = 18.0 * 7.0;
    ASSERT_EQ(solid.size(), 1U) << above;
    EXPECT_NEAR(solid[0].lower.um(), upper_of_lowest - depth, 2e-4) << above;
    EXPECT_NEAR(solid[0].upper.um(), 18.0 * (6 + above), 1e-9) << above;
  }
}

TEST(DepthCure, AgreesWithDosesCountedSlabBySlab) {
  CureCurve cure;
  cure.gamma = -0.02;
  const std::vector<StackLayer> layers{{18.0_um, 1.0}, {9.0_um, 0.7}, {25.0_um, 1.0}, {18.0_um, 1.4}, {18.0_um, 1.0}};
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    const std::vector<float> grays = random_grays(layers.size(), seed);
    const auto counted = counted_thickness_um(cure, layers, grays, 4000);
    const auto cured = column_thickness_um(cure, layers, grays);
    // A slab of 25/4000 µm more or less.
    for (std::size_t j = 0; j < layers.size(); ++j) EXPECT_NEAR(cured[j], counted[j], 0.007) << seed << " " << j;
  }
}

// The dose absorbed between two depths is β times its difference; all of it adds up to what every layer sent in, less
// what passes the platform.
TEST(DepthCure, KeepsTheEnergyOfTheDose) {
  const CureCurve cure;
  const std::vector<StackLayer> layers{{18.0_um, 1.0}, {9.0_um, 2.0}, {18.0_um, 1.0}, {30.0_um, 0.5}};
  const std::vector<float> grays = random_grays(layers.size(), 9);
  DepthDose dose(cure, 1);
  double absorbed = 0.0, sent = 0.0, face_um = 75.0;
  for (std::size_t i = layers.size(); i-- > 0;) {
    dose.descend(layers[i], {&grays[i], 1});
    absorbed += double(dose.dose()[0]) * (1.0 - std::exp(-(layers[i].thickness / cure.beta)));
    sent += layers[i].exposure * (double(grays[i]) - cure.gamma) * (1.0 - std::exp(-face_um / cure.beta.um()));
    face_um -= layers[i].thickness.um();
  }
  EXPECT_NEAR(absorbed, sent, 1e-6);
}

TEST(DepthCure, CuresMoreForMoreLightAnywhereAbove) {
  const CureCurve cure;
  const std::vector<StackLayer> layers(5, {18.0_um, 1.0});
  const std::vector<float> grays = random_grays(5, 4, 0.0, 0.6);
  const auto before = column_thickness_um(cure, layers, grays);
  for (std::size_t k = 0; k < layers.size(); ++k) {
    std::vector<float> more = grays;
    more[k] += 0.3F;
    const auto after = column_thickness_um(cure, layers, more);
    for (std::size_t j = 0; j < layers.size(); ++j) {
      if (j <= k)
        EXPECT_GE(after[j], before[j]) << j << " " << k;
      else
        EXPECT_EQ(after[j], before[j]) << j << " " << k;  // nothing goes up
    }
  }
}

TEST(DepthCure, CuresWhatManyLayersBelowTheThresholdAddUpTo) {
  const CureCurve cure;  // 40/255 + .01 = .1669 of the critical .1774; with the layer above it 1.17 times that
  const float gray = 40.0F / 255.0F;
  const auto one = column_thickness_um(cure, {{18.0_um, 1.0}}, {gray});
  EXPECT_EQ(one[0], 0.0F);
  const auto two = column_thickness_um(cure, {{18.0_um, 1.0}, {18.0_um, 1.0}}, {gray, gray});
  EXPECT_NEAR(two[0], 17.71 + 10.24 * std::log((40.0 / 255.0 + 0.01) * (1.0 + std::exp(-18.0 / 10.24))),
              height_tolerance_um);
  EXPECT_EQ(two[1], 0.0F);
}

TEST(DepthCure, TellsClosedVoidsInAColumn) {
  const std::vector<StackLayer> layers(3, {10.0_um, 1.0});
  const std::vector<float> cured{10.0F, 4.0F, 10.0F};
  const auto solid = solid_intervals(layers, cured);
  ASSERT_EQ(solid.size(), 2U);
  EXPECT_DOUBLE_EQ(solid[0].upper.um(), 10.0);
  EXPECT_DOUBLE_EQ(solid[1].lower.um(), 16.0);
  EXPECT_DOUBLE_EQ(solid[1].upper.um(), 30.0);
  const std::vector<float> none(3, 0.0F), thick{10.0F, 11.0F, 0.0F};
  EXPECT_TRUE(solid_intervals(layers, none).empty());
  EXPECT_THROW((void)solid_intervals(layers, thick), InvalidInput);
}

TEST(DepthCure, RefusesWhatNoLayerIs) {
  DepthDose dose({}, 2);
  const std::vector<float> light(2, 0.5F), short_light(1, 0.5F);
  EXPECT_THROW(dose.descend({Length{}, 1.0}, light), InvalidInput);
  EXPECT_THROW(dose.descend({18.0_um, 0.0}, light), InvalidInput);
  EXPECT_THROW(dose.descend({18.0_um, 1.0}, short_light), InvalidInput);
  const StackProcess process(4, 4, {}, {});
  const std::vector<LitLayer> other{{GrayImage{3, 4, std::vector<float>(12)}, {18.0_um, 1.0}}};
  EXPECT_THROW((void)process.print(other), InvalidInput);
}

// J = Σ slope · thickness over a stack with blur, toward random directions of its gray values.
TEST(StackProcess, TellsTheSlopesTowardTheGrayValuesOfEveryLayer) {
  constexpr std::size_t columns = 7, rows = 6, count = 4;
  PrinterProfile profile;
  const ProcessOptions options{2, Surround::Mirror};
  const StackProcess process(columns, rows, profile, options);
  // Grays whose sums neither fill a layer nor stay below the threshold, so that J is smooth.
  std::vector<LitLayer> layers;
  std::vector<std::vector<float>> slopes, direction;
  for (std::size_t j = 0; j < count; ++j) {
    layers.push_back({{columns, rows, random_grays(columns * rows, 20 + j, 0.25, 0.6)}, {18.0_um, j == 2 ? 1.2 : 1.0}});
    slopes.push_back(random_grays(process.samples(), 30 + j, -1.0, 1.0));
    direction.push_back(random_grays(columns * rows, 40 + j, -1.0, 1.0));
  }
  const auto value = [&](double step) {
    std::vector<LitLayer> moved = layers;
    for (std::size_t j = 0; j < count; ++j) {
      for (std::size_t i = 0; i < columns * rows; ++i)
        moved[j].image.values[i] += static_cast<float>(step * double(direction[j][i]));
    }
    double sum = 0.0;
    const auto cured = process.print(moved);
    for (std::size_t j = 0; j < count; ++j) {
      for (std::size_t i = 0; i < cured[j].size(); ++i) sum += double(slopes[j][i]) * double(cured[j][i]);
    }
    return sum;
  };
  const auto gradient = process.gray_slopes(layers, slopes);
  double expected = 0.0;
  for (std::size_t j = 0; j < count; ++j) {
    for (std::size_t i = 0; i < columns * rows; ++i) expected += double(gradient[j][i]) * double(direction[j][i]);
  }
  // Richardson: central differences over h and h/2, error of order (h/.25)⁴; float heights over h: 1e-4 of it.
  const double h = 0.02;
  const double wide = (value(h) - value(-h)) / (2.0 * h), narrow = (value(h / 2) - value(-h / 2)) / h;
  EXPECT_NEAR(expected / ((4.0 * narrow - wide) / 3.0), 1.0, 2e-3);
}

TEST(StackProcess, AsksForOneLayerAtATime) {
  const PrinterProfile profile = sharp_profile();
  const StackProcess process(3, 3, profile, {1, Surround::Dark});
  std::vector<std::size_t> asked;
  process.print(
      4,
      [&](std::size_t i) {
        asked.push_back(i);
        return LitLayer{{3, 3, std::vector<float>(9, 1.0F)}, {18.0_um, 1.0}};
      },
      [&](std::size_t i, std::span<const float> cured_um) {
        EXPECT_EQ(i, asked.back());
        EXPECT_NEAR(cured_um[4], i == 3 ? 17.8119 : 18.0, 1e-4);
      });
  EXPECT_EQ(asked, (std::vector<std::size_t>{3, 2, 1, 0}));
}

}  // namespace
}  // namespace mezzotint
